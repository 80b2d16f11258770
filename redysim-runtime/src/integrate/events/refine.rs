//! The time of an event and the state there, as exact as the steps are.

use super::crossings::Crossing;
use super::finite;
use crate::integrate::algorithm::Formula;
use crate::integrate::observer::ObservedStep;
use crate::integrate::{IntegrationError, Ode, Step};
use crate::{Real, Vector};

/// Steps of the method for one event at most.
const STEPS: u32 = 6;
/// How far from the crossing the slope is taken, as a part of the step.
const DISTANCE: f64 = 1e-3;
/// What may be left of the change of the value over that distance: where more is, the value jumps.
const REST: f64 = 0.1;

/// Time and state of a crossing that the continuous extension has.
///
/// An extension may be of lower order than the step it belongs to: that of the pair of orders 5 and 4 errs by h⁵ where
/// the step errs by h⁶. So a method that says so takes steps of its own from the start of the step to the event, whose
/// time follows by Newton's rule, with the slope of the extension and then that between two such steps: two or three of
/// them. The function has then reached or passed zero, so that who starts again from there does not meet the same
/// crossing. Where the function jumps over zero, Newton's rule leads astray, and the crossing of the extension stands.
///
/// # Errors
/// If a derivative or a value of the event is infinite or not a number.
pub fn refine<S: Real, Y: Vector<S>, F: Formula<S, Y>, O: Ode<S, Y> + ?Sized>(
    value: &dyn Fn(S, &Y) -> S,
    event: usize,
    crossing: &Crossing<S>,
    observed: &mut ObservedStep<'_, '_, S, Y, F, O>,
) -> Result<(S, Y), IntegrationError<S>> {
    let step = observed.step();
    let (from, to) = (step.start().0, step.end().0);
    // Positive before the crossing.
    let sign = if crossing.rising { -S::one() } else { S::one() };
    let (change, distance) = change_within(value, crossing.t, &step);
    let mut slope = sign * change / distance;
    let mut t = crossing.t;
    // Aiming a few roundings of time beyond zero, so that it is passed.
    let beyond = S::from_f64(4.0) * S::EPSILON * from.abs().maximum(to.abs());
    let beyond = if to > from { beyond } else { -beyond };
    let mut previous: Option<(S, S)> = None;
    let mut best: Option<Iterate<S, Y>> = None;
    for _ in 0..STEPS {
        if t == to {
            break;
        }
        let Some(y) = observed.state_by_step(t)? else { break };
        let error = finite(sign * value(t, &y), event, t)?;
        if let Some((t_previous, previous)) = previous
            && t != t_previous
            && (error - previous).abs() > S::from_f64(0.1) * previous.abs()
        {
            slope = (error - previous) / (t - t_previous);
        }
        previous = Some((t, error));
        let iterate = Iterate { t, y, error };
        if best.as_ref().is_none_or(|best| iterate.is_better_than(best)) {
            best = Some(iterate);
        }
        let correction = -error / slope;
        if !correction.is_finite() || (error <= S::zero() && correction.abs() <= beyond.abs() + beyond.abs()) {
            break;
        }
        t = clamped(t + correction + beyond, from, to);
    }
    Ok(match best {
        Some(Iterate { t, y, error }) if error.abs() <= S::from_f64(REST) * change.abs() => (t, y),
        _ => (crossing.t, observed.step().at(crossing.t)),
    })
}

/// An iterate of Newton's rule: a step of the method to where the event might be.
struct Iterate<S, Y> {
    t: S,
    y: Y,
    /// The value of the event, positive before the crossing.
    error: S,
}

impl<S: Real, Y> Iterate<S, Y> {
    /// Whether this one has passed zero and the other has not, or is nearer to zero.
    fn is_better_than(&self, other: &Self) -> bool {
        let passed = self.error <= S::zero();
        if passed == (other.error <= S::zero()) { self.error.abs() <= other.error.abs() } else { passed }
    }
}

/// How the value changes about a crossing of the extension, and over what time.
fn change_within<S: Real, Y: Vector<S>>(value: &dyn Fn(S, &Y) -> S, t: S, step: &Step<'_, S, Y>) -> (S, S) {
    let (from, to) = (step.start().0, step.end().0);
    let distance = S::from_f64(DISTANCE) * (to - from);
    let (before, after) = (clamped(t - distance, from, to), clamped(t + distance, from, to));
    (value(after, &step.at(after)) - value(before, &step.at(before)), after - before)
}

fn clamped<S: Real>(t: S, from: S, to: S) -> S {
    t.maximum(from.minimum(to)).minimum(from.maximum(to))
}
