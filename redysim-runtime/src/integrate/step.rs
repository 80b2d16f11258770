//! The solution within one step.

use crate::{Real, Vector};

/// An accepted step, and the solution at every time within.
///
/// The solution between the ends (dense output) is the continuous extension: for [`Ode5`](crate::Ode5) and
/// [`Ode45`](crate::Ode45) a polynomial of degree 4 in time, accurate to order 4, for [`Dop853`](crate::Dop853) one of
/// degree 7 and order 7, for [`Ode4`](crate::Ode4) the cubic through values and derivatives at both ends; for
/// [`Gauss4`](crate::Gauss4) and [`Gauss6`](crate::Gauss6) one of degree 7, and for [`Radau5`](crate::Radau5) one of
/// degree 6, as accurate as the ends of the steps (of `Radau5` where the equation is not stiff); for
/// [`Ode15s`](crate::Ode15s) the polynomial through the ends of the last steps. It agrees with the neighbouring steps
/// in value and, for the explicit methods and those of Gauss, in derivative (where
/// [`Ode::accepted`](crate::Ode::accepted) has corrected the end, up to that correction). It costs no evaluations but
/// with `Dop853`, the methods of Gauss and `Radau5`: for each step that is observed within three, ten, and those of
/// three shorter steps.
pub struct Step<'a, S, Y> {
    t: S,
    y: &'a Y,
    t_new: S,
    y_new: &'a Y,
    /// The length of the step in which the polynomials count time.
    size: S,
    scale: S,
    stages: &'a [Y],
    dense: &'a [&'static [f64]],
}

impl<'a, S: Real, Y: Vector<S>> Step<'a, S, Y> {
    /// A step from `start` to `end`, each a time and the state there, within which the solution is
    /// y(t + θ h) = y + `scale` · Σ p_k(θ) `stages`_k. The polynomials p_k have the coefficients `dense`, of θ, θ², …
    pub fn new(
        (t, y): (S, &'a Y),
        (t_new, y_new): (S, &'a Y),
        scale: S,
        stages: &'a [Y],
        dense: &'a [&'static [f64]],
    ) -> Self {
        Self { t, y, t_new, y_new, size: t_new - t, scale, stages, dense }
    }

    /// The same step, ended at `t_new` within it, where the state is `y_new`.
    pub(super) fn until(self, (t_new, y_new): (S, &'a Y)) -> Self {
        Step { t_new, y_new, ..self }
    }

    /// Time and state at which the step began.
    pub fn start(&self) -> (S, &Y) {
        (self.t, self.y)
    }

    /// Time and state at which the step ended.
    pub fn end(&self) -> (S, &Y) {
        (self.t_new, self.y_new)
    }

    /// The solution at `t`, which should lie within the step: outside, the polynomial soon goes astray.
    pub fn at(&self, t: S) -> Y {
        let mut y = self.y.clone();
        self.write_at(t, &mut y);
        y
    }

    /// Writes the solution at `t` to `y`, which has the length of the state. At the ends of the step it is exactly the
    /// state there.
    pub fn write_at(&self, t: S, y: &mut Y) {
        if t == self.t_new {
            return y.clone_from(self.y_new);
        }
        let theta = (t - self.t) / self.size;
        let weights = self.dense.iter().map(|polynomial| without_constant(polynomial, theta));
        weighted_sum(weights, self.stages, y);
        for (value, &start) in y.as_mut().iter_mut().zip(self.y.as_ref()) {
            *value = start + self.scale * *value;
        }
    }
}

/// c₁ x + c₂ x² + …
pub(super) fn without_constant<S: Real>(coefficients: &[f64], x: S) -> S {
    coefficients.iter().rfold(S::zero(), |sum, &coefficient| x * (S::from_f64(coefficient) + sum))
}

/// sum = Σ weight_k · stage_k, over as many stages as there are weights.
pub(super) fn weighted_sum<S: Real, Y: Vector<S>>(weights: impl Iterator<Item = S>, stages: &[Y], sum: &mut Y) {
    sum.as_mut().fill(S::zero());
    for (weight, stage) in weights.zip(stages) {
        // Many coefficients are zero; a stage that has no weight must not cost time.
        if weight != S::zero() {
            for (sum, &value) in sum.as_mut().iter_mut().zip(stage.as_ref()) {
                *sum += weight * value;
            }
        }
    }
}
