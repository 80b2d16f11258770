//! What a method of integration is.
//!
//! Its formula takes one trial step; a [step control](super::step_control), if it has one,
//! chooses the sizes. Times, states, tolerances, corrections and observers belong to the drivers for steps of one size
//! and for steps from tolerances.

use super::integration::{Integration, Progress};
use super::{IntegrationError, Ode, Step};
use crate::{Real, Vector};

/// A method of integration: how it begins. With [`FixedStep`](super::FixedStep) it is an integrator with steps of one
/// size, with [`Adaptive`](super::Adaptive), if it [estimates errors](super::step_control::EstimatesErrors), one that
/// chooses them.
pub trait Algorithm {
    /// What takes its steps.
    type Formula<S: Real, Y: Vector<S>>: Formula<S, Y>;

    /// Evaluates what the first step needs, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the derivative is infinite or not a number.
    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>>;
}

/// The formula of a method with its cache, the data that it keeps from step to step. It takes one trial step of the
/// integration that a driver owns.
///
/// A driver sets the end of the step in the integration and calls [`attempt`](Self::attempt), with a step control also
/// [`error`](Self::error), until a step is good; then [`prepare_dense_output`](Self::prepare_dense_output) if the
/// solution within is needed, [`step`](Self::step) for the observer, and [`advance`](Self::advance) before the next.
pub trait Formula<S: Real, Y: Vector<S>> {
    /// Computes the attempted step. Equations are solved by iteration to well within the tolerances.
    ///
    /// # Errors
    /// If the step cannot be taken. A driver that may choose takes a smaller one.
    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>>;

    /// The attempted step.
    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y>;

    /// Prepares for another step from the state that is reached. If `corrected`, the equation has changed that state
    /// after the last step: derivatives, differences and other data of that step then belong to another state. `y_new`
    /// of the progress is the state before the step.
    ///
    /// # Errors
    /// If the derivative at the state is infinite or not a number.
    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        corrected: bool,
    ) -> Result<(), IntegrationError<S>>;

    /// The derivative at the state; after the first step only where the method needs it.
    fn rate(&self) -> &Y;

    /// The [size](Integration::error_norm) of the estimated error of the attempted step; zero, the default, where nothing
    /// estimates it.
    fn error<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> S {
        let _ = integration;
        S::zero()
    }

    /// h |λ| for the largest eigenvalue λ of the Jacobian, as far as the attempted step shows it, and how large it may
    /// be for a damped motion, λ < 0; `None`, the default, if nothing limits it or the method cannot tell.
    fn stability<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &Integration<'_, S, Y, O>,
    ) -> Option<StabilityEstimate<S>> {
        let _ = integration;
        None
    }

    /// Evaluates what the solution within the attempted step needs beyond what the step itself did.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    fn prepare_dense_output<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        let _ = integration;
        Ok(())
    }

    /// Whether the dense output of the attempted step is as accurate as the method provides within steps. The default
    /// is `true`.
    fn dense_output_suffices(&self) -> bool {
        true
    }

    /// A copy to take a step of the method to a time within the attempted one; `None`, the default, if the dense output
    /// is as accurate as the ends of steps.
    fn aside(&self) -> Option<Self>
    where
        Self: Sized,
    {
        None
    }
}

/// How near a step is to the limit of stability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityEstimate<S> {
    /// h |λ| for the largest eigenvalue λ.
    pub size: S,
    /// How large it may be for a damped motion.
    pub limit: S,
}
