//! The predictive control of Gustafsson.

use super::{StepControl, Trial, first_size, root, shrinkage};
use crate::integrate::algorithm::Formula;
use crate::integrate::collocation::radau::{LARGEST_TURN, Radau};
use crate::integrate::integration::Integration;
use crate::integrate::{IntegrationError, Ode};
use crate::{Real, Vector};

/// A new step aims at 0.9^exponent of the tolerance, less where the iteration took many turns.
const SAFETY: f64 = 0.9;
const SMALLEST_GROWTH: f64 = 0.2;
const LARGEST_GROWTH: f64 = 8.0;
/// A step that could be a little longer keeps its size, and with it the decompositions.
const WORTH_A_CHANGE: f64 = 1.2;
/// The largest ratio of tolerance to error in a prediction; a larger one counts as this.
const LARGEST_RATIO: f64 = 1000.0;

/// Predictive control of step sizes.
///
/// A step has the smaller of the size that follows from the error of the last step and the size that the errors of the
/// last two predict if their change continues (K. Gustafsson, *Control-theoretic techniques for stepsize selection in implicit
/// Runge-Kutta methods*, ACM Trans. Math. Softw. 20 (1994)). A step does not grow after one that had to be tried again.
#[derive(Clone, Copy, Debug)]
pub struct Predictive<S> {
    error_exponent: u32,
    /// The last accepted step.
    last: Option<Trial<S>>,
}

impl<S> Predictive<S> {
    /// The control of a method whose estimated error is proportional to this power of the step size.
    pub fn new(error_exponent: u32) -> Self {
        Self { error_exponent, last: None }
    }
}

impl<S: Real, Y: Vector<S>> StepControl<S, Y, Radau<S, Y>> for Predictive<S> {
    fn first_size<O: Ode<S, Y> + ?Sized>(
        &self,
        formula: &mut Radau<S, Y>,
        integration: &mut Integration<'_, S, Y, O>,
        _reach: S,
    ) -> Result<S, IntegrationError<S>> {
        Ok(first_size(formula.rate(), integration, self.error_exponent))
    }

    /// After an iteration that failed, the factor is the one that its rate of convergence calls for.
    fn shrink(&mut self, formula: &mut Radau<S, Y>, trial: Trial<S>) -> S {
        formula.take_retreat().unwrap_or_else(|| shrinkage(trial, self.error_exponent))
    }

    fn grow(&mut self, formula: &mut Radau<S, Y>, trial: Trial<S>) -> S {
        let before = self.last.replace(trial);
        if trial.rejections > 0 {
            return S::one();
        }
        let power = |ratio: S| ratio.powf(root(self.error_exponent));
        let Trial { ratio, size, .. } = trial;
        let turns = S::from_f64(f64::from(2 * LARGEST_TURN + 1) / f64::from(2 * LARGEST_TURN + formula.turns()));
        let mut growth = S::from_f64(SAFETY) * turns.minimum(S::one()) * power(ratio);
        if let Some(before) = before {
            let trend = power(ratio * (ratio / before.ratio.minimum(S::from_f64(LARGEST_RATIO))));
            growth = growth.minimum(S::from_f64(SAFETY) * (size / before.size) * trend);
        }
        let worth_a_change = growth < S::one() || growth > S::from_f64(WORTH_A_CHANGE);
        if formula.keeps_its_jacobian() && !worth_a_change {
            return S::one();
        }
        growth.maximum(S::from_f64(SMALLEST_GROWTH)).minimum(S::from_f64(LARGEST_GROWTH))
    }
}
