//! Steps of a size that follows from tolerances, by the rules of L. F. Shampine and M. W. Reichelt, *The MATLAB ODE
//! Suite*, SIAM J. Sci. Comput. 18 (1997).

use core::ops::ControlFlow;

use super::explicit::Explicit;
use super::interval::Interval;
use super::tableau::Tableau;
use super::tolerance::Tolerances;
use super::{IntegrationError, Ode, Solution, Step};
use crate::{Real, Vector};

/// A new step aims at an error of 0.8⁵ of the tolerance, so that it rarely has to be tried again.
const SAFETY: f64 = 0.8;
/// The largest factor between the sizes of two steps.
const LARGEST_GROWTH: f64 = 5.0;
/// The smallest factor after the first failure of a step. A second failure says that the estimate cannot be trusted;
/// from then on the size is halved.
const SMALLEST_SHRINKAGE: f64 = 0.1;
/// A step that would end so near to the end is stretched to it, rather than followed by a tiny one.
const STRETCH: f64 = 1.1;

/// What the steps are chosen by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Options<'a, S> {
    pub tolerances: Tolerances<'a, S>,
    pub initial_step: Option<S>,
    pub max_step: Option<S>,
    pub max_steps: u64,
}

impl<S: Real> Options<'_, S> {
    fn check(&self, len: usize) -> Result<(), IntegrationError<S>> {
        self.tolerances.check(len)?;
        check_step("initial step", self.initial_step)?;
        check_step("maximum step", self.max_step)
    }
}

/// Checks a step size, if it is given.
pub(super) fn check_step<S: Real>(option: &'static str, size: Option<S>) -> Result<(), IntegrationError<S>> {
    match size {
        Some(value) if !(value > S::zero() && value.is_finite()) => Err(IntegrationError::BadStep { option, value }),
        _ => Ok(()),
    }
}

/// Integrates with steps whose estimated errors are within the tolerances.
pub(super) fn integrate<S: Real, Y: Vector<S>, const STAGES: usize>(
    tableau: &Tableau<STAGES>,
    options: &Options<'_, S>,
    ode: &mut (impl Ode<S, Y> + ?Sized),
    interval: Interval<S>,
    start: Y,
    mut on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
) -> Result<Solution<S, Y>, IntegrationError<S>> {
    options.check(start.as_ref().len())?;
    let rtol = options.tolerances.relative;
    let exponent = S::one() / S::from_f64(f64::from(tableau.error_order + 1));
    let largest = options.max_step.unwrap_or(S::from_f64(0.1) * interval.length());

    let mut state = Explicit::new(tableau, ode, interval.from, start)?;
    let mut size = options.initial_step.unwrap_or_else(|| {
        // A first-order step of this size would change the state by 0.8 rtol^exponent of itself.
        let rate = options.tolerances.norm(state.derivative(), &state.y, &state.y);
        S::from_f64(SAFETY) * rtol.powf(exponent) / rate
    });
    let (mut steps, mut rejected) = (0, 0);
    loop {
        let smallest = interval.smallest_step(state.t);
        size = size.minimum(largest).maximum(smallest);
        let mut failed = false;
        let error = loop {
            if steps + rejected >= options.max_steps {
                return Err(IntegrationError::TooManySteps { t: state.t, limit: options.max_steps });
            }
            let rest = (interval.to - state.t).abs();
            let last = S::from_f64(STRETCH) * size >= rest;
            let t = if last { interval.to } else { interval.advance(state.t, size) };
            if last {
                size = rest;
            }
            if t == state.t {
                return Err(IntegrationError::StepTooSmall { t, step: size });
            }
            let (error, fault) = match state.attempt(ode, t) {
                Ok(()) => (state.error(&options.tolerances), IntegrationError::StepTooSmall { t: state.t, step: size }),
                Err(fault) => (S::from_f64(f64::INFINITY), fault),
            };
            if error <= rtol {
                break error;
            }
            if size <= smallest {
                return Err(fault);
            }
            rejected += 1;
            let shrinkage = if failed {
                S::from_f64(0.5)
            } else {
                (S::from_f64(SAFETY) * (rtol / error).powf(exponent)).maximum(S::from_f64(SMALLEST_SHRINKAGE))
            };
            size = smallest.maximum(shrinkage * size);
            failed = true;
        };
        steps += 1;
        state.finish(ode)?;
        let flow = on_step(&state.step());
        state.accept();
        if flow.is_break() || state.t == interval.to {
            let statistics = state.statistics(steps, rejected);
            return Ok(Solution { t: state.t, y: state.y, statistics });
        }
        state.renew(ode)?;
        if !failed {
            let growth = S::from_f64(SAFETY) * (rtol / error).powf(exponent);
            size = growth.minimum(S::from_f64(LARGEST_GROWTH)) * size;
        }
    }
}
