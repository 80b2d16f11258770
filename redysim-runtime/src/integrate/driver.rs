//! The common part of steps of one size and steps from tolerances: an integration, the formula that takes its steps,
//! and their observer.

use core::ops::ControlFlow;

use super::algorithm::{Algorithm, Formula};
use super::integration::{Integration, Progress};
use super::interval::Interval;
use super::observer::ObservedStep;
use super::tolerance::Tolerances;
use super::{IntegrationError, Observer, Ode, Solution};
use crate::{Real, Vector};

/// An integration on its way from one end of an interval to the other.
pub(super) struct Driver<'a, S, Y, O: ?Sized, F, Ob> {
    pub integration: Integration<'a, S, Y, O>,
    pub formula: F,
    observer: &'a mut Ob,
    interval: Interval<S>,
}

impl<'a, S, Y, O, F, Ob> Driver<'a, S, Y, O, F, Ob>
where
    S: Real,
    Y: Vector<S>,
    O: Ode<S, Y> + ?Sized,
    F: Formula<S, Y>,
    Ob: Observer<S, Y>,
{
    /// Starts at the first time of the interval.
    pub fn start<A: Algorithm<Formula<S, Y> = F>>(
        ode: &'a mut O,
        interval: Interval<S>,
        y: Y,
        tolerances: Tolerances<'a, S>,
        observer: &'a mut Ob,
    ) -> Result<Self, IntegrationError<S>> {
        let mut integration = Integration::new(ode, tolerances, interval.from, y)?;
        let formula = A::start(&mut integration)?;
        Ok(Self { integration, formula, observer, interval })
    }

    pub fn progress(&self) -> &Progress<S, Y> {
        &self.integration.progress
    }

    /// Computes a step to `t`.
    pub fn attempt(&mut self, t: S) -> Result<(), IntegrationError<S>> {
        self.integration.progress.t_new = t;
        self.formula.attempt(&mut self.integration)
    }

    /// Accepts the attempted step: the equation may correct its end, the observer sees it, and its end becomes the
    /// state. Unless the integration ends there, prepares for another step.
    pub fn accept(&mut self) -> Result<ControlFlow<()>, IntegrationError<S>> {
        let Self { integration, formula, observer, interval } = self;
        if observer.needs_dense_output(integration.progress.t, integration.progress.t_new) {
            formula.prepare_dense_output(integration)?;
        }
        let corrected = integration.finish()?;
        let flow = observer.observe(&mut ObservedStep {
            integration: &mut *integration,
            formula: &mut *formula,
            end: None,
        })?;
        integration.progress.accept();
        if flow.is_break() || integration.progress.t == interval.to {
            return Ok(ControlFlow::Break(()));
        }
        formula.advance(integration, corrected)?;
        Ok(ControlFlow::Continue(()))
    }

    /// The time and the state that are reached, and the statistics.
    pub fn solution(self) -> Solution<S, Y> {
        let Progress { t, y, statistics, .. } = self.integration.progress;
        Solution { t, y, statistics }
    }
}
