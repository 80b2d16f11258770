//! One step of an explicit Runge-Kutta method.

use core::mem::swap;

use super::algorithm::{Formula, StabilityEstimate};
use super::integration::{Integration, Progress, zeros};
use super::step::{Step, weighted_sum};
use super::tableau::{ErrorEstimate, Tableau};
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// Takes the steps of an explicit Runge-Kutta method.
#[derive(Clone, Debug)]
pub struct Explicit<Y, const STAGES: usize> {
    tableau: &'static Tableau<STAGES>,
    /// The first is the derivative at the start of the step, number `tableau.main − 1` that at its end.
    stages: [Y; STAGES],
    scratch: Y,
}

impl<Y, const STAGES: usize> Explicit<Y, STAGES> {
    /// Evaluates the derivative at the start, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the derivative is infinite or not a number.
    pub fn new<S: Real, O: Ode<S, Y> + ?Sized>(
        tableau: &'static Tableau<STAGES>,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self, IntegrationError<S>>
    where
        Y: Vector<S>,
    {
        let zero = zeros(&integration.progress.y);
        let mut this = Self { tableau, stages: core::array::from_fn(|_| zero.clone()), scratch: zero };
        integration.evaluate(integration.progress.t, &mut this.stages[0])?;
        Ok(this)
    }

    /// Evaluates stage `stage` and leaves its state in `y_new`.
    fn evaluate<S: Real, O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        stage: usize,
    ) -> Result<(), IntegrationError<S>>
    where
        Y: Vector<S>,
    {
        if let Some(row) = self.tableau.rows.get(stage) {
            let row = row.iter().map(|&a| S::from_f64(a));
            weighted_sum(row, &self.stages, &mut integration.progress.increment);
            integration.progress.advance_by_increment();
        }
        let (Some(&node), Some(rate)) = (self.tableau.nodes.get(stage), self.stages.get_mut(stage)) else {
            return Ok(());
        };
        integration.evaluate(integration.progress.time_at(node), rate)
    }

    /// h Σ d_k f_k as the tolerances measure it.
    fn norm<S: Real, O: Ode<S, Y> + ?Sized>(&mut self, d: &[f64; STAGES], integration: &Integration<'_, S, Y, O>) -> S
    where
        Y: Vector<S>,
    {
        let h = integration.progress.step_size();
        weighted_sum(d.iter().map(|&d| h * S::from_f64(d)), &self.stages, &mut self.scratch);
        integration.error_norm(&self.scratch)
    }
}

impl<S: Real, Y: Vector<S>, const STAGES: usize> Formula<S, Y> for Explicit<Y, STAGES> {
    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        for stage in 1..self.tableau.main {
            self.evaluate(integration, stage)?;
        }
        Ok(())
    }

    fn rate(&self) -> &Y {
        &self.stages[0]
    }

    fn error<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> S {
        let tableau = self.tableau;
        match &tableau.error {
            ErrorEstimate::Embedded(d) => self.norm(d, integration),
            ErrorEstimate::Stretched { higher, lower } => {
                let [higher, lower] = [higher, lower].map(|d| self.norm(d, integration));
                let size = (higher * higher + S::from_f64(0.01) * lower * lower).sqrt();
                if size > S::zero() { higher * (higher / size) } else { size }
            }
        }
    }

    fn prepare_dense_output<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        if self.tableau.main == STAGES {
            return Ok(());
        }
        // The end of the step waits aside while the stages within are evaluated.
        self.scratch.clone_from(&integration.progress.y_new);
        let increment = integration.progress.increment.clone();
        for stage in self.tableau.main..STAGES {
            self.evaluate(integration, stage)?;
        }
        integration.progress.increment = increment;
        integration.progress.y_new.clone_from(&self.scratch);
        Ok(())
    }

    fn aside(&self) -> Option<Self> {
        Some(self.clone())
    }

    fn stability<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &Integration<'_, S, Y, O>,
    ) -> Option<StabilityEstimate<S>> {
        let tableau = self.tableau;
        let last = tableau.main.checked_sub(1)?;
        let before = last.checked_sub(1)?;
        let (row, row_before) = (tableau.rows.get(last)?, tableau.rows.get(before)?);
        if *tableau.nodes.get(before)? != 1.0 {
            return None;
        }
        let h = integration.progress.step_size();
        let weights = row.iter().enumerate().map(|(k, a)| a - row_before.get(k).copied().unwrap_or(0.0));
        weighted_sum(weights.map(|a| h * S::from_f64(a)), &self.stages, &mut self.scratch);
        let apart = integration.error_norm(&self.scratch);
        let rates = self.stages.get(last)?.as_ref().iter().zip(self.stages.get(before)?.as_ref());
        for (difference, (&after, &before)) in self.scratch.as_mut().iter_mut().zip(rates) {
            *difference = h * (after - before);
        }
        // States that differ by rounding alone say nothing.
        let says = apart > S::from_f64(100.0) * S::EPSILON;
        let estimate = if says { integration.error_norm(&self.scratch) / apart } else { S::zero() };
        Some(StabilityEstimate { size: estimate, limit: S::from_f64(tableau.stable_to) })
    }

    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y> {
        progress.step(progress.step_size(), &self.stages, &self.tableau.dense)
    }

    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        corrected: bool,
    ) -> Result<(), IntegrationError<S>> {
        if corrected {
            return integration.evaluate_at_state(&mut self.stages[0]);
        }
        if let [first, others @ ..] = self.stages.as_mut_slice()
            && let Some(last) = others.get_mut(self.tableau.main.wrapping_sub(2))
        {
            swap(first, last);
        }
        Ok(())
    }
}
