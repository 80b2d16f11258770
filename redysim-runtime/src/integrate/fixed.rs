//! Steps of one size.

use core::ops::ControlFlow;

use super::explicit::Explicit;
use super::interval::Interval;
use super::tableau::Tableau;
use super::{IntegrationError, Ode, Solution, Step};
use crate::{Real, Vector};

/// Integrates with steps of size `size`, of which the last ends exactly at the end of the interval.
pub(super) fn integrate<S: Real, Y: Vector<S>, const STAGES: usize>(
    tableau: &Tableau<STAGES>,
    size: S,
    max_steps: u64,
    ode: &mut (impl Ode<S, Y> + ?Sized),
    interval: Interval<S>,
    start: Y,
    mut on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
) -> Result<Solution<S, Y>, IntegrationError<S>> {
    let count = count(interval, size);
    if count > max_steps {
        return Err(IntegrationError::TooManySteps { t: interval.from, limit: max_steps });
    }
    let mut state = Explicit::new(tableau, ode, interval.from, start)?;
    let mut steps = 0;
    while steps < count {
        let t = if steps + 1 == count { interval.to } else { time_after(steps + 1, interval, size) };
        if t == state.t {
            return Err(IntegrationError::StepTooSmall { t, step: size });
        }
        state.attempt(ode, t)?;
        steps += 1;
        state.finish(ode)?;
        let flow = on_step(&state.step());
        state.accept();
        if flow.is_break() {
            break;
        }
        if steps < count {
            state.renew(ode)?;
        }
    }
    let statistics = state.statistics(steps, 0);
    Ok(Solution { t: state.t, y: state.y, statistics })
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
