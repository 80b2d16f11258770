//! The past of a solution in backward differences of constant step size.

use super::coefficients::{HIGHEST_ORDER, newton_polynomial};
use crate::integrate::integration::zeros;
use crate::{Real, Vector};

/// ∇y_n, …, ∇^k y_n of order k and, for the choice of the order, two more.
#[derive(Clone, Debug)]
pub struct Differences<S, Y> {
    /// Column j − 1 is ∇^j y. During a step those from k on are ∇^{k+1} y_{n+1} and ∇^{k+2} y_{n+1} already.
    columns: [Y; HIGHEST_ORDER + 2],
    order: usize,
    /// The distance in time of what was subtracted, negative if time runs backward.
    size: S,
    /// How many steps of this order and size were taken.
    steps: usize,
}

impl<S: Real, Y: Vector<S>> Differences<S, Y> {
    /// The line with slope `rate`: ∇y for steps of size 1.
    pub fn new(rate: &Y) -> Self {
        let columns = core::array::from_fn(|_| zeros(rate));
        let mut this = Self { columns, order: 1, size: S::one(), steps: 0 };
        this.restart(rate);
        this
    }

    /// The differences of `order` of states that are known, `past(back)` being the one `back` steps of `size` ago.
    #[cfg(test)]
    pub fn from_past(order: usize, size: S, past: impl Fn(usize) -> Y) -> Self {
        let mut this = Self { order, size, ..Self::new(&past(0)) };
        for (j, column) in (1..).zip(&mut this.columns) {
            column.as_mut().fill(S::zero());
            for back in 0..=j {
                add(column, newton_polynomial(back, -S::from_f64(j as f64)), &past(back));
            }
        }
        this
    }

    /// Forgets everything but the slope `rate`.
    pub fn restart(&mut self, rate: &Y) {
        let [first, ..] = &mut self.columns;
        first.clone_from(rate);
        (self.order, self.size, self.steps) = (1, S::one(), 0);
    }

    /// k.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The size of the steps, with its sign.
    pub fn size(&self) -> S {
        self.size
    }

    /// How many steps of this order and size were taken.
    pub fn steps(&self) -> usize {
        self.steps
    }

    /// ∇^j y for j = 1, 2, …
    pub fn all(&self) -> &[Y] {
        &self.columns
    }

    /// ∇^j y; `None` if it is not kept.
    pub fn get(&self, j: usize) -> Option<&Y> {
        self.columns.get(j.checked_sub(1)?)
    }

    /// Sets the order of the next step.
    pub fn set_order(&mut self, order: usize) {
        if order != self.order {
            self.order = order;
            self.steps = 0;
        }
    }

    /// Goes on with steps of another size, where it differs by more than `rounding`. The new differences are those of
    /// the polynomial through the old points: ∇*^r = Σ_j ∇^j (R U)_jr with R_jq = w_j(−q ρ), U_qr = w_q(−r) = (−1)^q
    /// C(r, q), where ρ is the ratio of the sizes and w_j is [`newton_polynomial`] (section 2.1 of the paper, "The
    /// quasi-constant step size"). (R U)_jr vanishes for j < r, since differences annihilate polynomials of lower
    /// degree, so that each column can be replaced once those before it are.
    pub fn resize(&mut self, size: S, rounding: S) {
        if (size - self.size).abs() <= rounding {
            return;
        }
        let ratio = size / self.size;
        let mut rest = self.columns.get_mut(..self.order).unwrap_or_default();
        for r in 1..=self.order {
            let Some((column, higher)) = core::mem::take(&mut rest).split_first_mut() else { break };
            let own = resized(r, r, ratio);
            column.as_mut().iter_mut().for_each(|value| *value = own * *value);
            for (j, other) in (r + 1..).zip(&*higher) {
                add(column, resized(j, r, ratio), other);
            }
            rest = higher;
        }
        (self.size, self.steps) = (size, 0);
    }

    /// Takes note of the correction ∇^{k+1} y_{n+1} of a step. If the step is not accepted, another size or order
    /// follows, with which the columns that are lost here would have no meaning.
    pub fn correct(&mut self, correction: &Y) {
        if let Some([next, after, ..]) = self.columns.get_mut(self.order..) {
            for ((after, next), &d) in after.as_mut().iter_mut().zip(next.as_mut()).zip(correction.as_ref()) {
                *after = d - *next;
                *next = d;
            }
        }
    }

    /// Makes the corrected step the last one: ∇^j y_{n+1} = ∇^j y_n + ∇^{j+1} y_{n+1}, for j = k to 1.
    pub fn advance(&mut self) {
        let mut rest = self.columns.get_mut(..=self.order).unwrap_or_default();
        while let Some((last, lower)) = core::mem::take(&mut rest).split_last_mut() {
            if let Some(column) = lower.last_mut() {
                add(column, S::one(), last);
            }
            rest = lower;
        }
        self.steps += 1;
    }
}

/// (R U)_jr.
fn resized<S: Real>(j: usize, r: usize, ratio: S) -> S {
    let number = |q: usize| S::from_f64(q as f64);
    (1..=r)
        .fold(S::zero(), |sum, q| sum + newton_polynomial(j, -(number(q) * ratio)) * newton_polynomial(q, -number(r)))
}

/// Adds factor · y to the sum.
pub fn add<S: Real, Y: Vector<S>>(sum: &mut Y, factor: S, y: &Y) {
    for (sum, &value) in sum.as_mut().iter_mut().zip(y.as_ref()) {
        *sum += factor * value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// t⁵ − 2 t³ + t, for which differences of order 5 know everything.
    fn quintic(t: f64) -> f64 {
        t * (1.0 + t * t * (t * t - 2.0))
    }

    fn of_quintic(t: f64, size: f64) -> Differences<f64, [f64; 1]> {
        Differences::from_past(5, size, |back| [quintic(t - back as f64 * size)])
    }

    fn assert_near(found: &Differences<f64, [f64; 1]>, expected: &Differences<f64, [f64; 1]>) {
        for (j, (found, expected)) in (1..).zip(found.columns.iter().zip(&expected.columns)).take(5) {
            // Values of the quintic reach 200 within five of the largest steps.
            assert!((found[0] - expected[0]).abs() < 1e-11, "∇^{j}: {found:?} instead of {expected:?}");
        }
    }

    #[test]
    fn differences_of_another_size_are_those_of_the_same_polynomial() {
        for ratio in [0.1, 0.5, 1.0 + 1e-9, 2.0, 3.7, -1.0] {
            let mut differences = of_quintic(0.7, 0.2);
            differences.resize(0.2 * ratio, 0.0);
            assert_near(&differences, &of_quintic(0.7, 0.2 * ratio));
            assert_eq!(differences.steps(), 0);
        }
    }

    #[test]
    fn a_size_that_differs_by_rounding_changes_nothing() {
        let mut differences = of_quintic(0.7, 0.2);
        differences.steps = 9;
        let before = differences.clone();
        differences.resize(0.2 + 1e-16, 2e-16);
        assert_eq!((differences.columns, differences.steps), (before.columns, before.steps));
    }

    #[test]
    fn a_step_makes_the_differences_those_at_its_end() {
        let mut differences = of_quintic(0.7, 0.2);
        // The extrapolation of a quintic by order 5 needs no correction.
        differences.correct(&[0.0]);
        differences.advance();
        assert_near(&differences, &of_quintic(0.9, 0.2));
        assert_eq!(differences.steps(), 1);

        // At order 3 the correction is ∇⁴, and ∇⁵ is left for the choice of the order.
        let mut differences = of_quintic(0.7, 0.2);
        differences.set_order(3);
        differences.correct(&of_quintic(0.9, 0.2).columns[3]);
        differences.advance();
        assert_near(&differences, &of_quintic(0.9, 0.2));
        assert_eq!(differences.steps(), 1);
    }

    #[test]
    fn a_start_knows_the_slope_alone_whatever_the_size_of_the_first_step() {
        let mut differences = Differences::new(&[3.0]);
        differences.resize(-0.25, 0.0);
        assert_eq!((differences.all()[0], differences.order()), ([-0.75], 1));
    }
}
