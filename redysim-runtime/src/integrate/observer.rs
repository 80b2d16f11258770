//! Who looks at the steps of an integration.

use core::ops::ControlFlow;

use super::method::Stepper;
use super::{IntegrationError, Ode, Step, Tolerances};
use crate::{Real, Vector};

/// Is shown every accepted step of an integration.
pub trait Observer<S, Y> {
    /// Whether the solution will be asked for strictly between `from` and `to`, the ends of a step that will be shown.
    /// Some methods must evaluate more for that; an observer who needs the ends only saves it.
    fn looks_within(&self, from: S, to: S) -> bool {
        let _ = (from, to);
        true
    }

    /// Looks at a step. [`ControlFlow::Break`] ends the integration after it.
    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()>;

    /// Is called for every accepted step; the default calls [`step`](Self::step). An observer that needs states within
    /// the step more accurately than the continuous extension has them [takes steps](Stepper::state_at) to them here.
    ///
    /// # Errors
    /// If a state within cannot be computed.
    fn look(
        &mut self,
        stepper: &mut impl Stepper<S, Y>,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        tolerances: &Tolerances<'_, S>,
    ) -> Result<ControlFlow<()>, IntegrationError<S>>
    where
        S: Real,
        Y: Vector<S>,
    {
        let _ = (ode, tolerances);
        Ok(self.step(&stepper.step()))
    }
}

/// Asks for nothing: only the end of the integration counts.
pub(super) struct Ends;

impl<S, Y> Observer<S, Y> for Ends {
    fn looks_within(&self, _from: S, _to: S) -> bool {
        false
    }

    fn step(&mut self, _step: &Step<'_, S, Y>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Hands every step to a closure.
pub(super) struct EveryStep<F>(pub F);

impl<S, Y, F: FnMut(&Step<'_, S, Y>) -> ControlFlow<()>> Observer<S, Y> for EveryStep<F> {
    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()> {
        (self.0)(step)
    }
}
