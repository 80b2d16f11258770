//! Steps of a size that follows from tolerances, by the rules of L. F. Shampine and M. W. Reichelt, *The MATLAB ODE
//! Suite*, SIAM J. Sci. Comput. 18 (1997).

use core::marker::PhantomData;

use super::algorithm::Formula;
use super::driver::Driver;
use super::interval::Interval;
use super::step_control::{EstimatesErrors, StepControl, Trial};
use super::stiffness::StiffnessTest;
use super::tolerance::{Absolute, Tolerances};
use super::{IntegrationError, Integrator, Observer, Ode, Solution};
use crate::{Real, Vector};

/// A step that would end so near to the end is stretched to it, rather than followed by a tiny one.
const STRETCH: f64 = 1.1;

/// A method with steps chosen from tolerances, as MATLAB chooses them: see [`Ode45`](super::Ode45) and its like.
///
/// A step is accepted when its estimated error e satisfies, for every component i,
/// |e_i| ≤ max(rtol max(|y_i|, |y_new,i|), atol_i). Errors of orientations in quaternions, and of the positions of free
/// joints, are weighed as [rotations and translations](Ode::error_norm). Errors of steps add up, and the equation may
/// amplify them: ask for less than is allowed at the end. First step, step control and defaults are those of the MATLAB
/// ODE suite.
///
/// A derivative that is infinite or not a number at an attempted step makes the step smaller; only where that does not
/// help, it is an error.
///
/// Only methods that estimate their errors can choose their steps:
///
/// ```compile_fail
/// use redysim_runtime::Integrator;
/// use redysim_runtime::integrate::{Adaptive, RungeKutta4};
///
/// let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
/// let end = Adaptive::<f64, RungeKutta4>::new().integrate(&mut decay, (0.0, 1.0), [1.0]);
/// ```
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S: serde::Serialize", deserialize = "S: serde::Deserialize<'de>"))
)]
pub struct Adaptive<'a, S, A> {
    tolerances: Tolerances<'a, S>,
    initial_step: Option<S>,
    max_step: Option<S>,
    max_steps: u64,
    stiffness_limit: Option<u64>,
    #[cfg_attr(feature = "serde", serde(skip, default = "no_stops"))]
    stops: &'a [S],
    #[cfg_attr(feature = "serde", serde(skip))]
    method: PhantomData<A>,
}

impl<'a, S: Real, A> Adaptive<'a, S, A> {
    /// The method with MATLAB's defaults: rtol 10⁻³, atol 10⁻⁶, steps of at most a tenth of the interval.
    pub fn new() -> Self {
        Self {
            tolerances: Tolerances::new(S::from_f64(1e-3), S::from_f64(1e-6)),
            initial_step: None,
            max_step: None,
            max_steps: 100_000_000,
            stiffness_limit: Some(100_000),
            stops: &[],
            method: PhantomData,
        }
    }

    /// Sets the relative tolerance, at least 100 roundoff units (2.2·10⁻¹⁴ for `f64`, 1.2·10⁻⁵ for `f32`): no step
    /// could keep a smaller one, so it is an error where MATLAB warns and takes the smallest.
    pub fn rtol(mut self, tolerance: S) -> Self {
        self.tolerances.relative = tolerance;
        self
    }

    /// Sets one absolute tolerance for all components, > 0, in the units of the state.
    pub fn atol(mut self, tolerance: S) -> Self {
        self.tolerances.absolute = Absolute::All(tolerance);
        self
    }

    /// Sets one absolute tolerance, > 0, for each component.
    pub fn atol_each(mut self, tolerances: &'a [S]) -> Self {
        self.tolerances.absolute = Absolute::Each(tolerances);
        self
    }

    /// Sets the size of the first step to try, > 0. By default it follows from the derivatives at the start.
    pub fn initial_step(mut self, size: S) -> Self {
        self.initial_step = Some(size);
        self
    }

    /// Sets the largest size of a step, > 0. The default is a tenth of the interval. The last step may be a tenth
    /// longer, so that it ends at the end.
    pub fn max_step(mut self, size: S) -> Self {
        self.max_step = Some(size);
        self
    }

    /// Sets the times at which a step must end (`tstops` in OrdinaryDiffEq.jl), in ascending order.
    /// The default is an empty list. Times outside the interval are ignored.
    ///
    /// A step evaluates the equation at a few times only, so that it can miss a short change between them. Set the times at
    /// which the equation changes suddenly: where the motion that it follows begins and ends, or a force sets in.
    ///
    /// ```
    /// use redysim_runtime::{Integrator, Ode45};
    ///
    /// // A push of 1 m/s² on a body at rest, for 10 ms.
    /// let mut pushed = |t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| {
    ///     *dydt = [y[1], if (5.0..5.01).contains(&t) { 1.0 } else { 0.0 }];
    /// };
    /// let unseen = Ode45::new().integrate(&mut pushed, (0.0, 10.0), [0.0; 2])?;
    /// assert_eq!(unseen.y, [0.0, 0.0]);
    ///
    /// let seen = Ode45::new().stops(&[5.0, 5.01]).integrate(&mut pushed, (0.0, 10.0), [0.0; 2])?;
    /// assert!((seen.y[1] - 0.01).abs() < 1e-4);
    /// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
    /// ```
    pub fn stops(mut self, times: &'a [S]) -> Self {
        self.stops = times;
        self
    }

    /// Gives up after `max_steps` steps, accepted or rejected. The default is 10⁸. Where a derivative jumps to and fro,
    /// as with friction by the sign of a velocity, steps stay as small as the tolerances, so that runs may be that
    /// long: a smaller limit ends them soon.
    pub fn max_steps(mut self, max_steps: u64) -> Self {
        self.max_steps = max_steps;
        self
    }

    /// Sets how many steps may lie ahead of an explicit method whose steps are small for stability, not for accuracy;
    /// with more of them to the end it gives up with [`IntegrationError::Stiff`]. The default is 10⁵; `None` lets it
    /// crawl. Implicit methods do not ask.
    pub fn stiffness_limit(mut self, steps: Option<u64>) -> Self {
        self.stiffness_limit = steps;
        self
    }

    /// The next time after `t` at which a step must end: a stop, or the end of the interval.
    fn next_stop(&self, interval: &Interval<S>, t: S) -> S {
        let next = if interval.to > interval.from {
            self.stops.get(self.stops.partition_point(|&stop| stop <= t))
        } else {
            self.stops.get(..self.stops.partition_point(|&stop| stop < t)).and_then(<[S]>::last)
        };
        let rest = Interval { from: t, to: interval.to };
        // Stops that are not in order may lie behind.
        next.copied().filter(|&stop| stop != t && rest.contains(stop)).unwrap_or(interval.to)
    }

    fn check(&self, len: usize) -> Result<(), IntegrationError<S>> {
        self.tolerances.check(len)?;
        check_step("initial step", self.initial_step)?;
        check_step("maximum step", self.max_step)
    }
}

impl<S: Real, A> Default for Adaptive<'_, S, A> {
    fn default() -> Self {
        Self::new()
    }
}

/// The default of [`Adaptive::stops`].
#[cfg(feature = "serde")]
fn no_stops<'a, S>() -> &'a [S] {
    &[]
}

/// Checks a step size, if it is given.
pub(super) fn check_step<S: Real>(option: &'static str, size: Option<S>) -> Result<(), IntegrationError<S>> {
    match size {
        Some(value) if !(value > S::zero() && value.is_finite()) => {
            Err(IntegrationError::InvalidStep { option, value })
        }
        _ => Ok(()),
    }
}

impl<S: Real, A: EstimatesErrors> Integrator<S> for Adaptive<'_, S, A> {
    fn run<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        observer: &mut impl Observer<S, Y>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        let interval = Interval::new(interval)?;
        self.check(start.as_ref().len())?;
        let rtol = self.tolerances.relative;
        let largest = self.max_step.unwrap_or(S::from_f64(0.1) * interval.length());

        let mut driver = Driver::start::<A>(ode, interval, start, self.tolerances, observer)?;
        let mut control = A::control();
        let mut size = match self.initial_step {
            Some(size) => size,
            None => {
                let first = (self.next_stop(&interval, interval.from) - interval.from).abs();
                let reach = interval.advance(S::zero(), largest.minimum(first));
                control.first_size(&mut driver.formula, &mut driver.integration, reach)?
            }
        };
        let mut stiffness = StiffnessTest::new(self.stiffness_limit);
        loop {
            let from = driver.progress().t;
            let stop = self.next_stop(&interval, from);
            let smallest = interval.smallest_step(from);
            size = size.minimum(largest).maximum(smallest);
            let trial = loop {
                let statistics = driver.progress().statistics;
                if statistics.steps + statistics.rejected >= self.max_steps {
                    return Err(IntegrationError::TooManySteps { t: from, limit: self.max_steps });
                }
                let rest = (stop - from).abs();
                let stops = S::from_f64(STRETCH) * size >= rest;
                let t = if stops { stop } else { interval.advance(from, size) };
                if stops {
                    size = rest;
                }
                if t == from {
                    return Err(IntegrationError::StepTooSmall { t, step: size });
                }
                let (error, fault) = match driver.attempt(t) {
                    Ok(()) => {
                        let error = driver.formula.error(&driver.integration);
                        (error, IntegrationError::StepTooSmall { t: from, step: size })
                    }
                    Err(fault) => (S::from_f64(f64::INFINITY), fault),
                };
                let progress = driver.progress();
                let trial = Trial { size: progress.step_size(), ratio: rtol / error, rejections: progress.rejections };
                if error <= rtol {
                    break trial;
                }
                if size <= smallest {
                    return Err(fault);
                }
                driver.integration.progress.reject();
                size = smallest.maximum(control.shrink(&mut driver.formula, trial) * size);
            };
            let rest = (interval.to - driver.progress().t_new).abs();
            let suspected = stiffness.suspects(&mut driver.formula, &driver.integration, rest);
            if driver.accept()?.is_break() {
                return Ok(driver.solution());
            }
            if let Some(stability_limit) = suspected {
                stiffness.confirm(&mut driver.integration, driver.formula.rate(), stability_limit, rest)?;
            }
            size = control.grow(&mut driver.formula, trial) * size;
        }
    }
}
