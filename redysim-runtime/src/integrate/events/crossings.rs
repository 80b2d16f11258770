//! Crossings of zero of a smooth function within one step.

use super::root::root;
use crate::Real;

/// Parts into which a step is divided to look for changes of sign. Steps of the methods follow the solution, so that
/// one is a small part of its swings.
const PARTS: usize = 8;
/// Where a parabola through three nodes falls below this part of the smallest value, its minimum is looked for: the
/// function might reach zero there and come back.
const NEAR: f64 = 0.5;
/// Evaluations for a minimum: after them it is known to 10⁻⁵ of a part.
const SEARCH: u32 = 26;
/// The golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// A crossing of zero.
#[derive(Clone, Copy, Debug)]
pub struct Crossing<S> {
    pub t: S,
    pub rising: bool,
}

/// Times within a step, in the direction of integration, and the values there, between which there is at most one
/// crossing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nodes<S> {
    nodes: [(S, S); PARTS + 1],
    /// The node from which the next crossing is looked for.
    cursor: usize,
}

impl<S: Real> Nodes<S> {
    /// Samples the function `at` between two times.
    ///
    /// # Errors
    /// What `at` says.
    pub fn new<E>(from: S, to: S, at: &mut impl FnMut(S) -> Result<S, E>) -> Result<Self, E> {
        let mut this = Self::default();
        let part = (to - from) / S::from_f64(PARTS as f64);
        for (k, node) in this.nodes.iter_mut().enumerate() {
            let t = if k == PARTS { to } else { from + S::from_f64(k as f64) * part };
            *node = (t, at(t)?);
            if node.1 == S::zero() && k < PARTS {
                // A zero has no sign: the one beside it tells where the function goes. From the start of the step it
                // may cross on its way back; elsewhere this is a crossing, if it came from the other side.
                let t = t + S::from_f64(1.0 / 64.0) * part;
                *node = (t, at(t)?);
            }
        }
        for k in 1..PARTS {
            this.look_for_dip(k, at)?;
        }
        Ok(this)
    }

    /// Moves node `k` to a place between its neighbours at which the sign is another, if there might be one.
    fn look_for_dip<E>(&mut self, k: usize, at: &mut impl FnMut(S) -> Result<S, E>) -> Result<(), E> {
        let Some(&[before, node, after]) = self.nodes.get(k - 1..k + 2) else { return Ok(()) };
        let sign = if node.1 < S::zero() { -S::one() } else { S::one() };
        let [a, b, c] = [before, node, after].map(|(_, value)| sign * value);
        if !(a > S::zero() && b > S::zero() && c > S::zero()) {
            return Ok(());
        }
        let (slope, bend) = (c - a, c - b - b + a);
        // The vertex is at −slope / (2 bend) parts from the node, and counts up to a little beyond the neighbours.
        if bend <= S::zero() || slope.abs() > S::from_f64(2.5) * bend {
            return Ok(());
        }
        let vertex = b - slope * slope / (S::from_f64(8.0) * bend);
        if vertex > S::from_f64(NEAR) * a.minimum(b).minimum(c) {
            return Ok(());
        }
        let (mut left, mut right) = (before.0, after.0);
        let inner = |from: S, to: S| from + S::from_f64(GOLDEN) * (to - from);
        let (mut x, mut y) = (inner(left, right), inner(right, left));
        let (mut at_x, mut at_y) = (sign * at(x)?, sign * at(y)?);
        for _ in 0..SEARCH {
            let (t, value) = if at_x < at_y { (x, at_x) } else { (y, at_y) };
            if value <= S::zero() {
                if let Some(node) = self.nodes.get_mut(k) {
                    *node = (t, sign * value);
                }
                return Ok(());
            }
            if at_x < at_y {
                (right, y, at_y) = (y, x, at_x);
                x = inner(left, right);
                at_x = sign * at(x)?;
            } else {
                (left, x, at_x) = (x, y, at_y);
                y = inner(right, left);
                at_y = sign * at(y)?;
            }
        }
        Ok(())
    }

    /// The next crossing of zero, each once.
    ///
    /// # Errors
    /// What `at` says.
    pub fn next_crossing<E>(&mut self, at: &mut impl FnMut(S) -> Result<S, E>) -> Result<Option<Crossing<S>>, E> {
        while let Some(&[before, after]) = self.nodes.get(self.cursor..self.cursor + 2) {
            self.cursor += 1;
            let (a, b) = (before.1, after.1);
            let rising = a < S::zero() && b >= S::zero();
            let falling = a > S::zero() && b <= S::zero();
            if rising || falling {
                return Ok(Some(Crossing { t: root(before, after, at)?, rising }));
            }
        }
        Ok(None)
    }
}
