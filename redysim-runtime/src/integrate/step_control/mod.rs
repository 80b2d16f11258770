//! The choice of step sizes. This folder has every rule that makes a step smaller or larger because of its error;
//! [`Adaptive`](super::Adaptive) keeps the sizes within the interval and the given limits.
//!
//! | control | depends on | used by |
//! |---|---|---|
//! | [`Elementary`] | the error of the last step | `Ode45`, `Dop853` |
//! | [`Predictive`] | the errors of the last two steps, and turns of the iteration | `Radau5` |
//! | [`VariableOrder`] | the errors of three orders | `Ode15s` |

mod predictive;
mod variable_order;

pub use predictive::Predictive;
pub use variable_order::VariableOrder;

use super::algorithm::{Algorithm, Formula};
use super::integration::Integration;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The largest factor between the sizes of two steps.
const LARGEST_GROWTH: f64 = 5.0;
/// The smallest factor after the first rejection of a step.
const SMALLEST_SHRINKAGE: f64 = 0.1;
/// The factor after further rejections, which show that the estimate is unreliable.
const SHRINKAGE_WITHOUT_ESTIMATE: f64 = 0.5;
/// A new step aims at an error of 0.8^order of the tolerance, so that it rarely has to be tried again.
const SAFETY: f64 = 0.8;

/// The size and the error of an attempted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial<S> {
    /// The size, with its sign.
    pub size: S,
    /// The tolerance over the estimated error; 0 where the step could not be taken.
    pub ratio: S,
    /// How often the same step was rejected before, with larger sizes.
    pub rejections: u32,
}

/// A method that estimates the errors of its steps, so that [`Adaptive`](super::Adaptive) can choose them.
pub trait EstimatesErrors: Algorithm {
    /// What chooses the sizes of its steps.
    type Control<S: Real, Y: Vector<S>>: StepControl<S, Y, Self::Formula<S, Y>>;

    /// The step control at the start.
    fn control<S: Real, Y: Vector<S>>() -> Self::Control<S, Y>;
}

/// Chooses the sizes of the steps of a formula `F` from their errors.
pub trait StepControl<S: Real, Y: Vector<S>, F: Formula<S, Y>> {
    /// The size of a first step that the tolerances will probably allow. `reach`, with its sign, is the largest that is
    /// allowed.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn first_size<O: Ode<S, Y> + ?Sized>(
        &self,
        formula: &mut F,
        integration: &mut Integration<'_, S, Y, O>,
        reach: S,
    ) -> Result<S, IntegrationError<S>>;

    /// The factor to the size of a step that is rejected.
    fn shrink(&mut self, formula: &mut F, trial: Trial<S>) -> S;

    /// The factor from the size of an accepted step to the next.
    fn grow(&mut self, formula: &mut F, trial: Trial<S>) -> S;
}

/// The elementary control: sizes from the error of the last step, as the MATLAB ODE suite chooses them. A step does not
/// grow after one that had to be tried again.
#[derive(Clone, Copy, Debug)]
pub struct Elementary {
    /// The power of the step size that the estimated error goes with.
    pub error_exponent: u32,
}

impl<S: Real, Y: Vector<S>, F: Formula<S, Y>> StepControl<S, Y, F> for Elementary {
    fn first_size<O: Ode<S, Y> + ?Sized>(
        &self,
        formula: &mut F,
        integration: &mut Integration<'_, S, Y, O>,
        _reach: S,
    ) -> Result<S, IntegrationError<S>> {
        Ok(first_size(formula.rate(), integration, self.error_exponent))
    }

    fn shrink(&mut self, _formula: &mut F, trial: Trial<S>) -> S {
        shrinkage(trial, self.error_exponent)
    }

    fn grow(&mut self, _formula: &mut F, trial: Trial<S>) -> S {
        if trial.rejections > 0 {
            return S::one();
        }
        (S::from_f64(SAFETY) * trial.ratio.powf(root(self.error_exponent))).minimum(S::from_f64(LARGEST_GROWTH))
    }
}

/// The size with which a first-order step would change the state that is reached by 0.8 rtol^(1/exponent) of itself.
fn first_size<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
    rate: &Y,
    integration: &Integration<'_, S, Y, O>,
    error_exponent: u32,
) -> S {
    let rtol = integration.tolerances.relative();
    S::from_f64(SAFETY) * rtol.powf(root(error_exponent)) / integration.norm_at_state(rate)
}

/// The factor to the size of a rejected step.
fn shrinkage<S: Real>(trial: Trial<S>, error_exponent: u32) -> S {
    if trial.rejections > 0 {
        return S::from_f64(SHRINKAGE_WITHOUT_ESTIMATE);
    }
    (S::from_f64(SAFETY) * trial.ratio.powf(root(error_exponent))).maximum(S::from_f64(SMALLEST_SHRINKAGE))
}

/// 1/`exponent`.
fn root<S: Real>(exponent: u32) -> S {
    S::one() / S::from_f64(f64::from(exponent))
}
