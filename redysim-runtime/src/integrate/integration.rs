//! An integration in progress: the data of its driver, independent of the formula.

use core::mem::swap;

use super::{Accepted, IntegrationError, Ode, Statistics, Step, Tolerances};
use crate::{Real, Vector};

/// An integration in progress: the equation, the tolerances, and the state that is reached.
pub struct Integration<'a, S, Y, O: ?Sized> {
    /// The equation.
    pub ode: &'a mut O,
    /// The tolerances.
    pub tolerances: Tolerances<'a, S>,
    /// Time, state and statistics.
    pub progress: Progress<S, Y>,
}

impl<'a, S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized> Integration<'a, S, Y, O> {
    /// Starts from `y` at `t`.
    ///
    /// # Errors
    /// If `y` or a vector of the equation has a wrong length, or a component of `y` is infinite or not a number.
    pub fn new(ode: &'a mut O, tolerances: Tolerances<'a, S>, t: S, y: Y) -> Result<Self, IntegrationError<S>> {
        ode.check_lengths(t, &y).map_err(IntegrationError::WrongLength)?;
        Ok(Self { ode, tolerances, progress: Progress::new(t, y)? })
    }

    /// The size of `error`, a small difference of states at `y_new`, as the equation weighs it with the tolerances:
    /// as large as rtol where it just meets them. Infinite if any part of it is not a finite number.
    pub fn error_norm(&self, error: &Y) -> S {
        let Progress { y, y_new, .. } = &self.progress;
        self.ode.error_norm(&self.tolerances, error, y, y_new)
    }

    /// [`error_norm`](Self::error_norm) of a difference of states at the state that is reached.
    pub(super) fn norm_at_state(&self, error: &Y) -> S {
        let y = &self.progress.y;
        self.ode.error_norm(&self.tolerances, error, y, y)
    }

    /// Writes the derivative at `y_new` and `t` to `rate`.
    ///
    /// # Errors
    /// If a component of the state or of its derivative is infinite or not a number.
    pub fn evaluate(&mut self, t: S, rate: &mut Y) -> Result<(), IntegrationError<S>> {
        let progress = &mut self.progress;
        progress.check_state(t)?;
        progress.statistics.evaluations += 1;
        self.ode.derivative(t, &progress.y_new, rate);
        match first_lacking(rate, progress.y.as_ref().len()) {
            None => Ok(()),
            Some(component) => Err(IntegrationError::NonFiniteDerivative { t, component }),
        }
    }

    /// Writes the derivative at the state that is reached to `rate`. `y_new` becomes a copy of that state.
    ///
    /// # Errors
    /// As [`evaluate`](Self::evaluate).
    pub fn evaluate_at_state(&mut self, rate: &mut Y) -> Result<(), IntegrationError<S>> {
        self.progress.y_new.clone_from(&self.progress.y);
        self.evaluate(self.progress.t, rate)
    }

    /// Does `work` on a copy of this integration. Of the copy, only the statistics are kept.
    pub fn aside<R>(&mut self, work: impl FnOnce(&mut Integration<'_, S, Y, O>) -> R) -> R {
        let mut aside =
            Integration { ode: &mut *self.ode, tolerances: self.tolerances, progress: self.progress.clone() };
        let outcome = work(&mut aside);
        self.progress.statistics = aside.progress.statistics;
        outcome
    }

    /// Finishes the attempted step: the equation may correct its end. Returns whether it did. What `y + increment` has
    /// rounded away is kept for the steps to come.
    ///
    /// # Errors
    /// If the equation refuses the end, or a component of it is infinite or not a number.
    pub(super) fn finish(&mut self) -> Result<bool, IntegrationError<S>> {
        let progress = &mut self.progress;
        progress.keep_what_rounding_leaves_out();
        let accepted = self.ode.accepted(progress.t_new, progress.step_size().abs(), &mut progress.y_new);
        match accepted {
            Accepted::Unchanged => {}
            Accepted::Refused => return Err(IntegrationError::Refused { t: progress.t_new }),
            Accepted::Corrected => progress.statistics.corrections += 1,
        }
        progress.check_state(progress.t_new)?;
        Ok(accepted == Accepted::Corrected)
    }
}

/// Time and state of an integration, those at the end of the step that is attempted, and what it took.
#[derive(Clone, Debug)]
pub struct Progress<S, Y> {
    /// The time that is reached.
    pub t: S,
    /// The state at `t`.
    pub y: Y,
    /// The end of the attempted step.
    pub t_new: S,
    /// The state at `t_new`; until the step is done, at any of its stages.
    pub y_new: Y,
    /// What the step adds to `y`.
    pub increment: Y,
    /// What rounding has so far left out of `y`.
    carry: Y,
    /// What it took so far.
    pub statistics: Statistics,
    /// How often the attempted step was rejected, each time with a larger size.
    pub rejections: u32,
}

impl<S: Real, Y: Vector<S>> Progress<S, Y> {
    /// Starts from `y` at `t`.
    ///
    /// # Errors
    /// If a component of `y` is infinite or not a number.
    pub fn new(t: S, y: Y) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&y);
        let this = Self {
            t,
            t_new: t,
            y_new: y.clone(),
            increment: zero.clone(),
            carry: zero,
            statistics: Statistics::default(),
            rejections: 0,
            y,
        };
        this.check_state(t)?;
        Ok(this)
    }

    /// The attempted step, with the solution within it as [`Step::new`] has it.
    pub fn step<'a>(&'a self, scale: S, stages: &'a [Y], dense: &'a [&'static [f64]]) -> Step<'a, S, Y> {
        Step::new((self.t, &self.y), (self.t_new, &self.y_new), scale, stages, dense)
    }

    /// The size of the attempted step, with its sign.
    pub fn step_size(&self) -> S {
        self.t_new - self.t
    }

    /// The time `node` steps after the start of the attempted step.
    pub fn time_at(&self, node: f64) -> S {
        // t + h may differ from t_new by a rounding error, and must not lie beyond the interval.
        if node == 1.0 { self.t_new } else { self.t + self.step_size() * S::from_f64(node) }
    }

    /// Writes y + h · `increment` to `y_new`, and what was added to `increment`.
    pub fn advance_by_increment(&mut self) {
        let h = self.step_size();
        for increment in self.increment.as_mut() {
            *increment = h * *increment;
        }
        self.add_increment();
    }

    /// Writes y + `addition` to `y_new`, and what was added to `increment`.
    pub fn advance_by(&mut self, addition: &Y) {
        self.increment.clone_from(addition);
        self.add_increment();
    }

    /// Writes y + `increment` to `y_new`, and what was added to `increment`.
    pub fn add_increment(&mut self) {
        let increments = self.increment.as_mut().iter_mut().zip(self.carry.as_ref());
        let states = self.y_new.as_mut().iter_mut().zip(self.y.as_ref());
        for ((new, &old), (increment, &carry)) in states.zip(increments) {
            *increment += carry;
            *new = old + *increment;
        }
    }

    /// Compensated summation (Kahan): keeps what `y + increment` has rounded away. A later correction moves the rounded
    /// state and leaves this difference unchanged.
    fn keep_what_rounding_leaves_out(&mut self) {
        let states = self.y_new.as_ref().iter().zip(self.y.as_ref());
        let increments = self.increment.as_ref().iter().zip(self.carry.as_mut());
        for ((&new, &old), (&increment, carry)) in states.zip(increments) {
            *carry = increment - (new - old);
        }
    }

    /// Makes the end of the finished step the state.
    pub(super) fn accept(&mut self) {
        self.statistics.steps += 1;
        self.rejections = 0;
        self.t = self.t_new;
        swap(&mut self.y, &mut self.y_new);
    }

    /// Rejects the attempted step.
    pub(super) fn reject(&mut self) {
        self.statistics.rejected += 1;
        self.rejections += 1;
    }

    /// Checks `y_new`, the state at `t`.
    fn check_state(&self, t: S) -> Result<(), IntegrationError<S>> {
        self.check(t, &self.y_new)
    }

    /// Checks `state`, a state at `t`.
    ///
    /// # Errors
    /// If a component of it is infinite or not a number.
    pub(super) fn check(&self, t: S, state: &Y) -> Result<(), IntegrationError<S>> {
        match first_lacking(state, self.y.as_ref().len()) {
            None => Ok(()),
            Some(component) => Err(IntegrationError::NonFiniteState { t, component }),
        }
    }
}

/// A vector of the length of `like`, of zeros.
pub(super) fn zeros<S: Real, Y: Vector<S>>(like: &Y) -> Y {
    let mut zero = like.clone();
    zero.as_mut().fill(S::zero());
    zero
}

/// The first of `len` components that is infinite or not a number; what a `Vec` lacks is not a number.
fn first_lacking<S: Real, Y: Vector<S>>(y: &Y, len: usize) -> Option<usize> {
    let y = y.as_ref();
    y.iter().position(|value| !value.is_finite()).or((y.len() < len).then_some(y.len()))
}
