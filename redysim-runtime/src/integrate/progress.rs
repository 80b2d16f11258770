//! How far an integration is: what every method keeps, whatever its steps are made of.

use core::mem::swap;

use super::{Accepted, IntegrationError, Ode, Statistics};
use crate::{Real, Vector};

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
    /// Whether the end of the last step was corrected, so that the derivative there is another.
    corrected: bool,
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
            corrected: false,
            y,
        };
        this.check_state(t)?;
        Ok(this)
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

    /// Writes the derivative at `y_new` and `t` to `rate`.
    ///
    /// # Errors
    /// If a component of the state or of its derivative is infinite or not a number.
    pub fn evaluate(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        rate: &mut Y,
    ) -> Result<(), IntegrationError<S>> {
        self.check_state(t)?;
        self.statistics.evaluations += 1;
        ode.derivative(t, &self.y_new, rate);
        match first_lacking(rate, self.y.as_ref().len()) {
            None => Ok(()),
            Some(component) => Err(IntegrationError::NonFiniteDerivative { t, component }),
        }
    }

    /// Takes the attempted step as good, and lets the equation correct its end. What `y + increment` has rounded away
    /// is kept for the steps to come.
    ///
    /// # Errors
    /// If the equation refuses the end, or a component of it is infinite or not a number.
    pub(super) fn finish(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        let states = self.y_new.as_ref().iter().zip(self.y.as_ref());
        let increments = self.increment.as_ref().iter().zip(self.carry.as_mut());
        for ((&new, &old), (&increment, carry)) in states.zip(increments) {
            // Compensated summation (Kahan): the difference is what `old + increment` has rounded away. A correction
            // that follows moves the rounded state and leaves the difference as it is.
            *carry = increment - (new - old);
        }
        let accepted = ode.accepted(self.t_new, self.step_size().abs(), &mut self.y_new);
        self.corrected = accepted == Accepted::Corrected;
        match accepted {
            Accepted::AsItIs => {}
            Accepted::Refused => return Err(IntegrationError::Refused { t: self.t_new }),
            Accepted::Corrected => self.statistics.corrections += 1,
        }
        self.check_state(self.t_new)
    }

    /// Makes the end of the finished step the state; tells whether it was corrected.
    pub fn accept(&mut self) {
        self.statistics.steps += 1;
        self.t = self.t_new;
        swap(&mut self.y, &mut self.y_new);
    }

    /// Whether the state is not the one the last step arrived at, but a correction of it: derivatives, differences and
    /// whatever else a method has kept from that step then belong to another state. `y_new` is then `y`, too.
    pub fn take_correction(&mut self) -> bool {
        if self.corrected {
            self.y_new.clone_from(&self.y);
        }
        core::mem::take(&mut self.corrected)
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
