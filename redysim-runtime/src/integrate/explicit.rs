//! One step of an explicit Runge-Kutta method.

use core::mem::swap;

use super::method::{Stepper, step_aside};
use super::progress::{Progress, zeros};
use super::step::{Step, weighted_sum};
use super::tableau::{ErrorEstimate, Tableau};
use super::tolerance::Tolerances;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// Takes the steps of an explicit Runge-Kutta method.
#[derive(Clone, Debug)]
pub struct Explicit<S, Y, const STAGES: usize> {
    tableau: &'static Tableau<STAGES>,
    progress: Progress<S, Y>,
    /// The first is the derivative at the start of the step, number `tableau.main − 1` that at its end.
    stages: [Y; STAGES],
    scratch: Y,
}

impl<S: Real, Y: Vector<S>, const STAGES: usize> Explicit<S, Y, STAGES> {
    /// Takes the start, evaluates the derivative there, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the state or its derivative is infinite or not a number.
    pub fn new(
        tableau: &'static Tableau<STAGES>,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&y);
        let mut this = Self {
            tableau,
            progress: Progress::new(t, y)?,
            stages: core::array::from_fn(|_| zero.clone()),
            scratch: zero,
        };
        this.progress.evaluate(ode, t, &mut this.stages[0])?;
        Ok(this)
    }

    /// Moves `y_new` to where stage `stage` is evaluated.
    fn move_to(&mut self, stage: usize) {
        let Some(row) = self.tableau.rows.get(stage) else { return };
        let row = row.iter().map(|&a| S::from_f64(a));
        weighted_sum(row, &self.stages, &mut self.progress.increment);
        self.progress.advance_by_increment();
    }

    fn evaluate(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized), stage: usize) -> Result<(), IntegrationError<S>> {
        let (Some(&node), Some(rate)) = (self.tableau.nodes.get(stage), self.stages.get_mut(stage)) else {
            return Ok(());
        };
        let t = self.progress.time_at(node);
        self.progress.evaluate(ode, t, rate)
    }

    /// h Σ d_k f_k as the tolerances measure it.
    fn norm(&mut self, d: &[f64; STAGES], tolerances: &Tolerances<'_, S>) -> S {
        let h = self.progress.step_size();
        weighted_sum(d.iter().map(|&d| h * S::from_f64(d)), &self.stages, &mut self.scratch);
        tolerances.norm(&self.scratch, &self.progress.y, &self.progress.y_new)
    }
}

impl<S: Real, Y: Vector<S>, const STAGES: usize> Stepper<S, Y> for Explicit<S, Y, STAGES> {
    fn progress(&self) -> &Progress<S, Y> {
        &self.progress
    }

    fn progress_mut(&mut self) -> &mut Progress<S, Y> {
        &mut self.progress
    }

    fn rate(&self) -> &Y {
        &self.stages[0]
    }

    fn attempt(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t_new: S,
        _tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        self.progress.t_new = t_new;
        for stage in 1..self.tableau.main {
            self.move_to(stage);
            self.evaluate(ode, stage)?;
        }
        Ok(())
    }

    fn error(&mut self, tolerances: &Tolerances<'_, S>) -> S {
        let tableau = self.tableau;
        match &tableau.error {
            ErrorEstimate::Embedded(d) => self.norm(d, tolerances),
            ErrorEstimate::Stretched { higher, lower } => {
                let (higher, lower) = (self.norm(higher, tolerances), self.norm(lower, tolerances));
                let size = (higher * higher + S::from_f64(0.01) * lower * lower).sqrt();
                if size > S::zero() { higher * (higher / size) } else { size }
            }
        }
    }

    fn error_exponent(&self) -> u32 {
        self.tableau.error_exponent
    }

    fn look_within(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        _tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        if self.tableau.main == STAGES {
            return Ok(());
        }
        // The end of the step waits aside while the stages within are evaluated.
        self.scratch.clone_from(&self.progress.y_new);
        let increment = self.progress.increment.clone();
        for stage in self.tableau.main..STAGES {
            self.move_to(stage);
            self.evaluate(ode, stage)?;
        }
        self.progress.increment = increment;
        self.progress.y_new.clone_from(&self.scratch);
        Ok(())
    }

    fn state_at(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<Option<Y>, IntegrationError<S>> {
        step_aside(self, ode, t, tolerances)
    }

    fn stability(&mut self, tolerances: &Tolerances<'_, S>) -> Option<(S, S)> {
        let tableau = self.tableau;
        let last = tableau.main.checked_sub(1)?;
        let before = last.checked_sub(1)?;
        let (row, row_before) = (tableau.rows.get(last)?, tableau.rows.get(before)?);
        if *tableau.nodes.get(before)? != 1.0 {
            return None;
        }
        let h = self.progress.step_size();
        let weights = row.iter().enumerate().map(|(k, a)| a - row_before.get(k).copied().unwrap_or(0.0));
        weighted_sum(weights.map(|a| h * S::from_f64(a)), &self.stages, &mut self.scratch);
        let Progress { y, y_new, .. } = &self.progress;
        let apart = tolerances.norm(&self.scratch, y, y_new);
        let rates = self.stages.get(last)?.as_ref().iter().zip(self.stages.get(before)?.as_ref());
        for (difference, (&after, &before)) in self.scratch.as_mut().iter_mut().zip(rates) {
            *difference = h * (after - before);
        }
        // States that differ by rounding alone say nothing.
        let says = apart > S::from_f64(100.0) * S::EPSILON;
        let estimate = if says { tolerances.norm(&self.scratch, y, y_new) / apart } else { S::zero() };
        Some((estimate, S::from_f64(tableau.stable_to)))
    }

    fn step(&self) -> Step<'_, S, Y> {
        let Progress { t, y, t_new, y_new, .. } = &self.progress;
        Step::new((*t, y), (*t_new, y_new), *t_new - *t, &self.stages, &self.tableau.dense)
    }

    fn accept(&mut self) {
        self.progress.accept();
        if let [first, others @ ..] = self.stages.as_mut_slice()
            && let Some(last) = others.get_mut(self.tableau.main.wrapping_sub(2))
        {
            swap(first, last);
        }
    }

    fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        if self.progress.take_correction() {
            self.progress.evaluate(ode, self.progress.t, &mut self.stages[0])?;
        }
        Ok(())
    }
}
