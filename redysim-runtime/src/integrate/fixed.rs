//! Steps of one size.

use core::marker::PhantomData;

use super::adaptive::check_step;
use super::algorithm::Algorithm;
use super::driver::Driver;
use super::interval::Interval;
use super::tolerance::Tolerances;
use super::{IntegrationError, Integrator, Observer, Ode, Solution};
use crate::{Real, Vector};

/// A method with steps of one given size: see [`Ode5`](super::Ode5) and its like.
///
/// Step k ends at t₀ + k h, computed by one product, so that times do not drift. Where the interval is no multiple of
/// h, the last step is shorter, so that the end is hit exactly; a rest of rounding size lengthens the last step
/// instead. Nothing estimates the error: halve the step and compare.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S: serde::Serialize", deserialize = "S: serde::Deserialize<'de>"))
)]
pub struct FixedStep<S, A> {
    step: S,
    max_steps: u64,
    #[cfg_attr(feature = "serde", serde(skip))]
    method: PhantomData<A>,
}

impl<S: Real, A> FixedStep<S, A> {
    /// The method with steps of size `step` > 0, in units of time, whichever the direction of integration.
    pub fn new(step: S) -> Self {
        Self { step, max_steps: 1_000_000_000, method: PhantomData }
    }

    /// The size of the steps.
    pub fn step(&self) -> S {
        self.step
    }

    /// Refuses, before it begins, what would take more than `max_steps` steps. The default is 10⁹.
    pub fn max_steps(self, max_steps: u64) -> Self {
        Self { max_steps, ..self }
    }
}

impl<S: Real, A: Algorithm> Integrator<S> for FixedStep<S, A> {
    fn run<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        observer: &mut impl Observer<S, Y>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        check_step("step", Some(self.step))?;
        let interval = Interval::new(interval)?;
        let count = count(interval, self.step);
        if count > self.max_steps {
            return Err(IntegrationError::TooManySteps { t: interval.from, limit: self.max_steps });
        }
        let mut driver = Driver::start::<A>(ode, interval, start, Tolerances::roundoff(), observer)?;
        for step in 1..=count {
            let t = if step == count { interval.to } else { time_after(step, interval, self.step) };
            if t == driver.progress().t {
                return Err(IntegrationError::StepTooSmall { t, step: self.step });
            }
            driver.attempt(t)?;
            if driver.accept()?.is_break() {
                break;
            }
        }
        Ok(driver.solution())
    }
}

/// The time after `steps` steps: one product, so that no error grows from step to step, and in `f64`, so that also an
/// `f32` counts past 2²⁴.
fn time_after<S: Real>(steps: u64, interval: Interval<S>, size: S) -> S {
    let exact = Interval { from: interval.from.to_f64(), to: interval.to.to_f64() };
    S::from_f64(exact.advance(exact.from, steps as f64 * size.to_f64()))
}

/// How many steps reach the end. A rest too small to be a step by itself is left to the last one.
fn count<S: Real>(interval: Interval<S>, size: S) -> u64 {
    let latest = interval.from.abs().maximum(interval.to.abs());
    let rest = interval.smallest_step(latest);
    let whole = libm::ceil((interval.length() - rest).to_f64() / size.to_f64());
    (whole as u64).max(1)
}
