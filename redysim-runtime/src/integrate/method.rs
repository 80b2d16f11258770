//! What a method has to say for itself: the drivers for steps of one size and for steps from tolerances do the rest.

use super::progress::Progress;
use super::tolerance::Tolerances;
use super::{IntegrationError, Ode, Step};
use crate::{Real, Vector};

/// The largest factor between the sizes of two steps.
const LARGEST_GROWTH: f64 = 5.0;
/// The smallest factor after the first failure of a step. A second failure says that the estimate cannot be trusted;
/// from then on the size is halved.
const SMALLEST_SHRINKAGE: f64 = 0.1;
/// A new step aims at an error of 0.8^order of the tolerance, so that it rarely has to be tried again.
const SAFETY: f64 = 0.8;

/// A method of integration: how it begins. With [`FixedStep`](super::FixedStep) it is an integrator with steps of one
/// size, with [`Adaptive`](super::Adaptive), if it [`EstimatesErrors`], one that chooses them.
pub trait Method {
    /// What takes its steps.
    type Stepper<S: Real, Y: Vector<S>>: Stepper<S, Y>;

    /// Takes the start, evaluates what the first step needs, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the state or its derivative is infinite or not a number.
    fn start<S: Real, Y: Vector<S>>(
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self::Stepper<S, Y>, IntegrationError<S>>;
}

/// A method that estimates the errors of its steps, so that [`Adaptive`](super::Adaptive) can choose them.
pub trait EstimatesErrors: Method {}

/// Takes the steps of a [`Method`].
///
/// A driver calls [`attempt`](Self::attempt) and [`error`](Self::error) until a step is good, then
/// [`look_within`](Self::look_within) if somebody will, then [`step`](Self::step) to show it,
/// [`accept`](Self::accept), and [`renew`](Self::renew) if it goes on.
pub trait Stepper<S: Real, Y: Vector<S>> {
    /// How far it is.
    fn progress(&self) -> &Progress<S, Y>;

    /// The same, to be changed by the driver.
    fn progress_mut(&mut self) -> &mut Progress<S, Y>;

    /// The derivative at the state; after the first step only where the method needs it.
    fn rate(&self) -> &Y;

    /// The size of a first step that the tolerances will probably allow; `reach`, with its sign, is the largest that
    /// may be. The default is the one with which a first-order step would change the state by 0.8 rtol^(1/exponent) of
    /// itself.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn first_size(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        reach: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<S, IntegrationError<S>> {
        let _ = (ode, reach);
        let y = &self.progress().y;
        let rate = tolerances.norm(self.rate(), y, y);
        Ok(S::from_f64(SAFETY) * tolerances.relative().powf(root(self.error_exponent())) / rate)
    }

    /// Computes a step to `t_new`. What is solved by iteration is solved well within the tolerances.
    ///
    /// # Errors
    /// If the step cannot be taken. A driver that may choose takes a smaller one.
    fn attempt(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t_new: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>>;

    /// The estimated error of the attempted step, as the tolerances measure it; zero where nothing estimates it.
    fn error(&mut self, tolerances: &Tolerances<'_, S>) -> S;

    /// The power of the step size that the estimated error goes with.
    fn error_exponent(&self) -> u32;

    /// Evaluates what the solution within the step needs beyond what the step itself did.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn look_within(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        let _ = (ode, tolerances);
        Ok(())
    }

    /// Whether the continuous extension of the attempted step is as accurate as the method provides within steps. The
    /// default is `true`.
    fn extension_suffices(&self) -> bool {
        true
    }

    /// Writes to `y` the solution at `t`, within the attempted step or at its end: that of the continuous extension or,
    /// where it [does not suffice](Self::extension_suffices), that of [`state_at`](Self::state_at).
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn write_state_at(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        tolerances: &Tolerances<'_, S>,
        y: &mut Y,
    ) -> Result<(), IntegrationError<S>> {
        if t != self.progress().t_new
            && !self.extension_suffices()
            && let Some(state) = self.state_at(ode, t, tolerances)?
        {
            y.clone_from(&state);
        } else {
            self.step().write_at(t, y);
        }
        Ok(())
    }

    /// h |λ| for the largest eigenvalue λ of the Jacobian, as far as the attempted step shows it, and how large it may
    /// be for a damped motion, λ < 0; `None`, the default, if nothing limits it or the method cannot tell.
    fn stability(&mut self, tolerances: &Tolerances<'_, S>) -> Option<(S, S)> {
        let _ = tolerances;
        None
    }

    /// The state at which a step of the method from the start of the attempted one to `t`, within it, arrives; `None`
    /// if it cannot be computed or if the continuous extension is as good. The default is `None`. The attempted step
    /// stays what it is.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn state_at(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<Option<Y>, IntegrationError<S>> {
        let _ = (ode, t, tolerances);
        Ok(None)
    }

    /// The attempted step.
    fn step(&self) -> Step<'_, S, Y>;

    /// Makes the end of the step the state.
    fn accept(&mut self);

    /// Makes ready for another step; after a [correction](Progress::take_correction) of the state, too.
    ///
    /// # Errors
    /// If the derivative of the corrected state is infinite or not a number.
    fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>>;

    /// The factor to the size of a step whose error was 1/`ratio` times the tolerance, after `failures` earlier
    /// failures of the same step.
    fn shrinkage(&mut self, ratio: S, failures: u32) -> S {
        usual_shrinkage(ratio, failures, self.error_exponent())
    }

    /// The factor from the size of an accepted step, whose error was 1/`ratio` times the tolerance, to the next.
    fn growth(&mut self, ratio: S) -> S {
        (S::from_f64(SAFETY) * ratio.powf(root(self.error_exponent()))).minimum(S::from_f64(LARGEST_GROWTH))
    }
}

/// What [`Stepper::state_at`] is for methods whose continuous extension is of lower order than their steps.
///
/// # Errors
/// If a derivative is infinite or not a number.
pub(super) fn step_aside<S: Real, Y: Vector<S>>(
    stepper: &mut (impl Stepper<S, Y> + Clone),
    ode: &mut (impl Ode<S, Y> + ?Sized),
    t: S,
    tolerances: &Tolerances<'_, S>,
) -> Result<Option<Y>, IntegrationError<S>> {
    let mut aside = stepper.clone();
    let outcome = aside.attempt(ode, t, tolerances);
    stepper.progress_mut().statistics = aside.progress().statistics;
    match outcome {
        Ok(()) => Ok(Some(aside.progress().y_new.clone())),
        Err(IntegrationError::NotConverged { .. }) => Ok(None),
        Err(fault) => Err(fault),
    }
}

/// The default of [`Stepper::shrinkage`].
pub(super) fn usual_shrinkage<S: Real>(ratio: S, failures: u32, error_exponent: u32) -> S {
    if failures > 0 {
        return S::from_f64(0.5);
    }
    (S::from_f64(SAFETY) * ratio.powf(root(error_exponent))).maximum(S::from_f64(SMALLEST_SHRINKAGE))
}

/// 1/`exponent`.
pub(super) fn root<S: Real>(exponent: u32) -> S {
    S::one() / S::from_f64(f64::from(exponent))
}
