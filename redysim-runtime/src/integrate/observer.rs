//! Who looks at the steps of an integration.

use core::ops::ControlFlow;

use super::algorithm::Formula;
use super::integration::Integration;
use super::{IntegrationError, Ode, Step};
use crate::{Real, Vector};

/// Is shown every accepted step of an integration.
pub trait Observer<S, Y> {
    /// Whether the solution will be asked for strictly between `from` and `to`, the ends of a step that will be shown.
    /// Some methods must evaluate more for that; an observer who needs the ends only saves it.
    fn needs_dense_output(&self, from: S, to: S) -> bool {
        let _ = (from, to);
        true
    }

    /// Looks at a step. [`ControlFlow::Break`] ends the integration after it.
    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()>;

    /// Is called for every accepted step; the default calls [`step`](Self::step). An observer that needs states within
    /// the step more accurately than the dense output provides takes steps to them here, by
    /// [`ObservedStep::write_state_at`].
    ///
    /// # Errors
    /// If a state within cannot be computed.
    fn observe<F: Formula<S, Y>, O: Ode<S, Y> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, S, Y, F, O>,
    ) -> Result<ControlFlow<()>, IntegrationError<S>>
    where
        S: Real,
        Y: Vector<S>,
    {
        Ok(self.step(&observed.step()))
    }
}

/// An accepted step with the formula that took it, which also takes steps to times within.
pub struct ObservedStep<'a, 'i, S, Y, F, O: ?Sized> {
    pub(super) integration: &'a mut Integration<'i, S, Y, O>,
    pub(super) formula: &'a mut F,
    /// Time and state at which an event ends it, if one does.
    pub(super) end: Option<(S, &'a Y)>,
}

impl<'i, S: Real, Y: Vector<S>, F: Formula<S, Y>, O: Ode<S, Y> + ?Sized> ObservedStep<'_, 'i, S, Y, F, O> {
    /// The step.
    pub fn step(&self) -> Step<'_, S, Y> {
        let step = self.formula.step(&self.integration.progress);
        match self.end {
            Some(end) => step.until(end),
            None => step,
        }
    }

    /// The same step, ended at a time within it and the state there.
    pub(super) fn until<'b>(&'b mut self, end: (S, &'b Y)) -> ObservedStep<'b, 'i, S, Y, F, O> {
        ObservedStep { integration: &mut *self.integration, formula: &mut *self.formula, end: Some(end) }
    }

    /// Writes to `y` the solution at `t`, within the step or at its end: that of the dense output or, where it is less
    /// accurate than the method provides within steps, that of [`state_by_step`](Self::state_by_step); within the step as
    /// the equation [corrects it](Ode::interpolated).
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    pub fn write_state_at(&mut self, t: S, y: &mut Y) -> Result<(), IntegrationError<S>> {
        if t != self.step().end().0
            && !self.formula.dense_output_suffices()
            && let Some(state) = self.state_by_step(t)?
        {
            y.clone_from(&state);
        } else {
            self.step().write_at(t, y);
        }
        self.correct(t, y);
        Ok(())
    }

    /// Lets the equation correct a state at `t`, if that is within the step.
    pub(super) fn correct(&mut self, t: S, y: &mut Y) {
        let progress = &self.integration.progress;
        if t != progress.t_new && t != progress.t {
            self.integration.ode.interpolated(t, y);
        }
    }

    /// The state at which a step of the method from the start of this one to `t`, within it, arrives; `None` if it
    /// cannot be computed or if the dense output is as accurate.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number.
    pub fn state_by_step(&mut self, t: S) -> Result<Option<Y>, IntegrationError<S>> {
        let Some(mut formula) = self.formula.aside() else { return Ok(None) };
        self.integration.aside(|aside| {
            aside.progress.t_new = t;
            match formula.attempt(aside) {
                Ok(()) => Ok(Some(aside.progress.y_new.clone())),
                Err(IntegrationError::NotConverged { .. }) => Ok(None),
                Err(fault) => Err(fault),
            }
        })
    }
}

/// Asks for nothing: only the end of the integration counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ends;

impl<S, Y> Observer<S, Y> for Ends {
    fn needs_dense_output(&self, _from: S, _to: S) -> bool {
        false
    }

    fn step(&mut self, _step: &Step<'_, S, Y>) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Hands every step to a closure.
#[derive(Clone, Copy, Debug)]
pub struct EveryStep<F>(pub F);

impl<S, Y, F: FnMut(&Step<'_, S, Y>) -> ControlFlow<()>> Observer<S, Y> for EveryStep<F> {
    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()> {
        (self.0)(step)
    }
}
