//! One step of an explicit Runge-Kutta method.

use core::mem::swap;

use super::step::{Step, weighted_sum};
use super::tableau::Tableau;
use super::tolerance::Tolerances;
use super::{Accepted, IntegrationError, Ode, Statistics};
use crate::{Real, Vector};

/// The state of an integration, and one attempted step from it.
pub(super) struct Explicit<'a, S, Y, const STAGES: usize> {
    tableau: &'a Tableau<STAGES>,
    pub t: S,
    pub y: Y,
    pub t_new: S,
    pub y_new: Y,
    /// The first is the derivative at `t`, the last that at `t_new`.
    stages: [Y; STAGES],
    increment: Y,
    /// What rounding has so far left out of `y`.
    carry: Y,
    error: Y,
    pub evaluations: u64,
    pub corrections: u64,
    /// Whether the last stage is not the derivative at `y_new`.
    corrected: bool,
}

impl<'a, S: Real, Y: Vector<S>, const STAGES: usize> Explicit<'a, S, Y, STAGES> {
    /// Takes the start, evaluates the derivative there, and makes all room that the steps will need.
    pub fn new(
        tableau: &'a Tableau<STAGES>,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self, IntegrationError<S>> {
        if let Some(component) = first_non_finite(&y) {
            return Err(IntegrationError::NonFiniteState { t, component });
        }
        let mut zero = y.clone();
        zero.as_mut().fill(S::zero());
        let mut this = Self {
            tableau,
            t,
            t_new: t,
            y_new: y.clone(),
            stages: core::array::from_fn(|_| zero.clone()),
            increment: zero.clone(),
            carry: zero.clone(),
            error: zero,
            evaluations: 0,
            corrections: 0,
            corrected: false,
            y,
        };
        this.evaluate(ode, 0, t)?;
        Ok(this)
    }

    /// The derivative at `t`.
    pub fn derivative(&self) -> &Y {
        &self.stages[0]
    }

    /// Computes a step to `t_new`, to be looked at and then accepted or tried again.
    pub fn attempt(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized), t_new: S) -> Result<(), IntegrationError<S>> {
        let h = t_new - self.t;
        self.t_new = t_new;
        for stage in 1..STAGES {
            let row = self.tableau.rows[stage].iter().map(|&a| S::from_f64(a));
            weighted_sum(row, &self.stages, &mut self.increment);
            let increments = self.increment.as_mut().iter_mut().zip(self.carry.as_ref());
            let states = self.y_new.as_mut().iter_mut().zip(self.y.as_ref());
            for ((new, &old), (increment, &carry)) in states.zip(increments) {
                *increment = h * *increment + carry;
                *new = old + *increment;
            }
            let node = self.tableau.nodes[stage];
            // t + h may differ from t_new by a rounding error, and must not lie beyond the interval.
            let t = if node == 1.0 { t_new } else { self.t + h * S::from_f64(node) };
            if let Some(component) = first_non_finite(&self.y_new) {
                return Err(IntegrationError::NonFiniteState { t, component });
            }
            self.evaluate(ode, stage, t)?;
        }
        Ok(())
    }

    /// The estimated error of the attempted step, as the tolerances measure it.
    pub fn error(&mut self, tolerances: &Tolerances<'_, S>) -> S {
        let h = self.t_new - self.t;
        let weights = self.tableau.error.iter().map(|&d| h * S::from_f64(d));
        weighted_sum(weights, &self.stages, &mut self.error);
        tolerances.norm(&self.error, &self.y, &self.y_new)
    }

    /// Takes the attempted step as good, and lets the equation correct its end.
    pub fn finish(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        let states = self.y_new.as_ref().iter().zip(self.y.as_ref());
        let increments = self.increment.as_ref().iter().zip(self.carry.as_mut());
        for ((&new, &old), (&increment, carry)) in states.zip(increments) {
            // Compensated summation (Kahan): the difference is what `old + increment` has rounded away. A correction
            // that follows moves the rounded state and leaves the difference as it is.
            *carry = increment - (new - old);
        }
        let accepted = ode.accepted(self.t_new, (self.t_new - self.t).abs(), &mut self.y_new);
        self.corrected = accepted == Accepted::Corrected;
        match accepted {
            Accepted::AsItIs => Ok(()),
            Accepted::Refused => Err(IntegrationError::Refused { t: self.t_new }),
            Accepted::Corrected => {
                self.corrections += 1;
                match first_non_finite(&self.y_new) {
                    None => Ok(()),
                    Some(component) => Err(IntegrationError::NonFiniteState { t: self.t_new, component }),
                }
            }
        }
    }

    /// The finished step.
    pub fn step(&self) -> Step<'_, S, Y> {
        Step {
            t: self.t,
            y: &self.y,
            t_new: self.t_new,
            y_new: &self.y_new,
            stages: &self.stages,
            dense: &self.tableau.dense,
        }
    }

    /// Makes the end of the finished step the state.
    pub fn accept(&mut self) {
        self.t = self.t_new;
        swap(&mut self.y, &mut self.y_new);
        self.stages.swap(0, STAGES - 1);
    }

    /// Makes sure, before another step, that the derivative is that of the state, which a correction has changed.
    pub fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        if !self.corrected {
            return Ok(());
        }
        self.y_new.clone_from(&self.y);
        self.evaluate(ode, 0, self.t)
    }

    /// What it took so far, in `steps` accepted and `rejected` attempts.
    pub fn statistics(&self, steps: u64, rejected: u64) -> Statistics {
        Statistics { steps, rejected, evaluations: self.evaluations, corrections: self.corrections }
    }

    fn evaluate(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized), stage: usize, t: S) -> Result<(), IntegrationError<S>> {
        self.evaluations += 1;
        ode.derivative(t, &self.y_new, &mut self.stages[stage]);
        match first_non_finite(&self.stages[stage]) {
            None => Ok(()),
            Some(component) => Err(IntegrationError::NonFiniteDerivative { t, component }),
        }
    }
}

fn first_non_finite<S: Real, Y: Vector<S>>(y: &Y) -> Option<usize> {
    y.as_ref().iter().position(|value| !value.is_finite())
}
