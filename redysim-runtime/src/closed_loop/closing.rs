//! Newton's method for the closure, on the branch of its guess.

use super::linear::{largest, norm};
use super::linearised::{Linearised, Metric};
use super::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{LoopClosure, MassMatrix, Mechanism, Real, Vector};

/// The farthest that a coordinate moves in one iteration, rad or m: far below the distance of assembly modes.
const LARGEST_STEP: f64 = 0.2;
/// How often a step that widens the gap is halved.
const HALVINGS: usize = 20;
/// An iteration after which the residual is not below this part of the one before is slow.
const SHRINKING: f64 = 0.999;
/// After so many slow iterations in a row, the gap is as small as it gets.
const SLOW_ITERATIONS: usize = 10;

/// Where a search ended.
pub(super) struct Closing<S: Real, M: Mechanism<S>, C: LoopClosure<S, M>> {
    pub q: M::Coordinates,
    /// The loops there.
    pub at: Linearised<S, M, C>,
    /// The largest component of the residual there.
    pub gap: S,
    /// Its row.
    pub row: usize,
    pub ending: Ending,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Ending {
    /// The residual is zero to rounding.
    Closed,
    /// No step makes the residual much smaller.
    Stalled,
    /// The iterations are used up.
    Exhausted,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// Moves the coordinates that are not held, by steps that are shortest in the given metric, until the loops are
    /// closed to 10⁻¹⁴ of the mechanism's size (45 roundoff units) or the residual shrinks no more.
    pub(super) fn close<S: Real>(
        &self,
        metric: Metric,
        mut q: M::Coordinates,
        held: &[usize],
        iterations: usize,
    ) -> Result<Closing<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let mut residual = self.closure.loop_residual(&q);
        let (mut count, mut slow) = (0, 0);
        loop {
            let (gap, row) = largest(residual.as_ref().iter().copied());
            if !gap.is_finite() {
                return Err(LoopError::NotFinite);
            }
            let at = self.linearise_in(metric, &q, held)?;
            if gap <= S::from_f64(45.0) * S::EPSILON * at.scale() {
                return Ok(Closing { q, at, gap, row, ending: Ending::Closed });
            }
            if count == iterations {
                return Ok(Closing { q, at, gap, row, ending: Ending::Exhausted });
            }
            let next = self.step(&q, &residual, &at);
            let Some((next, residual_there)) = next.filter(|_| slow < SLOW_ITERATIONS) else {
                return Ok(Closing { q, at, gap, row, ending: Ending::Stalled });
            };
            let shrinks = norm(residual_there.as_ref()) < S::from_f64(SHRINKING) * norm(residual.as_ref());
            slow = if shrinks { 0 } else { slow + 1 };
            (q, residual) = (next, residual_there);
            count += 1;
        }
    }

    /// A step that makes the residual smaller, and the residual after it.
    fn step<S: Real>(
        &self,
        q: &M::Coordinates,
        residual: &C::Rows,
        at: &Linearised<S, M, C>,
    ) -> Option<(M::Coordinates, C::Rows)>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let way = self.mechanism.coordinate_rates(q, &at.shortest(residual));
        let (farthest, _) = largest(way.as_ref().iter().copied());
        let mut part = (S::from_f64(LARGEST_STEP) / farthest).minimum(S::one());
        let before = norm(residual.as_ref());
        for _ in 0..HALVINGS {
            let moved = M::Coordinates::from_fn(self.mechanism.nq(), |i| entry(q, i) - part * entry(&way, i));
            let residual = self.closure.loop_residual(&moved);
            if norm(residual.as_ref()) < before {
                return Some((moved, residual));
            }
            part = S::from_f64(0.5) * part;
        }
        None
    }
}
