//! The solution at given times.

use core::ops::ControlFlow;

use super::algorithm::Formula;
use super::interval::Interval;
use super::observer::ObservedStep;
use super::{IntegrationError, Observer, Ode, Step};
use crate::{Real, Vector};

/// The remaining times. Each is checked when the iterator yields it.
pub(super) struct SaveAt<I, S, Y, F> {
    times: I,
    next: Option<S>,
    interval: Interval<S>,
    /// The state at a time.
    y: Y,
    output: F,
    fault: Option<IntegrationError<S>>,
}

impl<S: Real, Y: Vector<S>, I: Iterator<Item = S>, F: FnMut(S, &Y)> SaveAt<I, S, Y, F> {
    pub fn new(times: I, interval: Interval<S>, y: Y, output: F) -> Result<Self, IntegrationError<S>> {
        let mut saver = Self { times, next: None, interval, y, output, fault: None };
        saver.pull(interval.from)?;
        Ok(saver)
    }

    /// The error of the time that is invalid, if there is one.
    pub fn fault(self) -> Option<IntegrationError<S>> {
        self.fault
    }

    /// The next time up to `end`, the end of a step.
    fn next_until(&self, end: S) -> Option<S> {
        self.next.filter(|&t| self.interval.reaches(end, t))
    }

    /// Calls `output` with the state at `t`, which `y` holds, and proceeds to the next time.
    fn answer(&mut self, t: S) -> ControlFlow<()> {
        (self.output)(t, &self.y);
        match self.pull(t) {
            Ok(()) => ControlFlow::Continue(()),
            Err(fault) => {
                self.fault = Some(fault);
                ControlFlow::Break(())
            }
        }
    }

    fn pull(&mut self, previous: S) -> Result<(), IntegrationError<S>> {
        self.next = self.times.next();
        match self.next {
            Some(t) if !self.interval.contains(t) => {
                Err(IntegrationError::SaveTimeOutside { t, from: self.interval.from, to: self.interval.to })
            }
            Some(t) if !self.interval.reaches(t, previous) => {
                Err(IntegrationError::SaveTimesOutOfOrder { t, previous })
            }
            _ => Ok(()),
        }
    }
}

impl<S: Real, Y: Vector<S>, I: Iterator<Item = S>, F: FnMut(S, &Y)> Observer<S, Y> for SaveAt<I, S, Y, F> {
    /// A time that follows the next one within the step counts as within, too.
    fn needs_dense_output(&self, _from: S, to: S) -> bool {
        self.next.is_some_and(|t| t != to && self.interval.reaches(to, t))
    }

    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()> {
        while let Some(t) = self.next_until(step.end().0) {
            step.write_at(t, &mut self.y);
            self.answer(t)?;
        }
        ControlFlow::Continue(())
    }

    fn observe<G: Formula<S, Y>, O: Ode<S, Y> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, S, Y, G, O>,
    ) -> Result<ControlFlow<()>, IntegrationError<S>> {
        let end = observed.integration.progress.t_new;
        while let Some(t) = self.next_until(end) {
            observed.write_state_at(t, &mut self.y)?;
            if self.answer(t).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }
}
