//! Events: the times at which a function of time and state reaches zero.

mod crossings;
mod refine;
mod root;

use core::ops::ControlFlow;

use super::algorithm::Formula;
use super::observer::ObservedStep;
use super::{Accepted, IntegrationError, Observer, Ode, Step};
use crate::{Real, Vector};
use crossings::{Crossing, Nodes};

/// Which crossings of zero count, seen in the direction of integration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Direction {
    /// From negative to positive values.
    Rising,
    /// From positive to negative values.
    Falling,
    /// Both.
    Any,
}

/// A function of time and state whose crossings of zero are looked for: see
/// [`Integrator::solve_with_events`](super::Integrator::solve_with_events).
///
/// A crossing is where the function, which was not zero, reaches zero or changes its sign. So a function that is zero
/// at the start, as after an impact, is not reported before it has been somewhere else, and a zero at the very end of a
/// step is reported once. Where the function only touches zero, it may or may not be reported: do not rely on it. The
/// function should be smooth; where it jumps over zero, time and state are those of the solution within the step (see
/// [`Step`]).
#[derive(Clone)]
pub struct Event<'e, S, Y> {
    value: &'e dyn Fn(S, &Y) -> S,
    direction: Direction,
    nodes: Nodes<S>,
    next: Option<Crossing<S>>,
}

impl<'e, S: Real, Y: Vector<S>> Event<'e, S, Y> {
    /// The crossings of `value` in one `direction`.
    pub fn new(direction: Direction, value: &'e dyn Fn(S, &Y) -> S) -> Self {
        Self { value, direction, nodes: Nodes::default(), next: None }
    }

    /// Where `value` rises through zero, seen in the direction of integration.
    pub fn rising(value: &'e dyn Fn(S, &Y) -> S) -> Self {
        Self::new(Direction::Rising, value)
    }

    /// Where `value` falls through zero, seen in the direction of integration.
    pub fn falling(value: &'e dyn Fn(S, &Y) -> S) -> Self {
        Self::new(Direction::Falling, value)
    }

    /// Where `value` crosses zero in any direction.
    pub fn any(value: &'e dyn Fn(S, &Y) -> S) -> Self {
        Self::new(Direction::Any, value)
    }

    /// Whether a crossing in the direction `rising`, or the other one, is looked for.
    fn counts(&self, rising: bool) -> bool {
        match self.direction {
            Direction::Rising => rising,
            Direction::Falling => !rising,
            Direction::Any => true,
        }
    }
}

/// One crossing of an [`Event`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occurrence<'y, S, Y> {
    /// Which of the events it was.
    pub event: usize,
    /// When, s.
    pub t: S,
    /// The state then.
    pub y: &'y Y,
    /// Whether the function rose or fell: never [`Direction::Any`].
    pub direction: Direction,
}

/// Finds the crossings of events in the steps that it sees.
pub(super) struct EventSearch<'a, 'e, S, Y, Ob, G> {
    events: &'a mut [Event<'e, S, Y>],
    observer: &'a mut Ob,
    on_event: G,
    /// Room for states within a step.
    y: Y,
    stopped: Option<(S, Y)>,
}

impl<'a, 'e, S, Y, Ob, G> EventSearch<'a, 'e, S, Y, Ob, G>
where
    S: Real,
    Y: Vector<S>,
    Ob: Observer<S, Y>,
    G: FnMut(Occurrence<'_, S, Y>) -> ControlFlow<()>,
{
    pub fn new(events: &'a mut [Event<'e, S, Y>], y: Y, observer: &'a mut Ob, on_event: G) -> Self {
        Self { events, observer, on_event, y, stopped: None }
    }

    /// Time and state at which an event has ended the integration, if one has.
    pub fn stopped(self) -> Option<(S, Y)> {
        self.stopped
    }

    /// The event whose next crossing within the step comes first, and that crossing.
    fn next(&mut self, step: &Step<'_, S, Y>) -> Result<Option<(usize, Crossing<S>)>, IntegrationError<S>> {
        let forward = step.end().0 > step.start().0;
        let mut first: Option<(usize, Crossing<S>)> = None;
        for (index, event) in self.events.iter_mut().enumerate() {
            if event.next.is_none() {
                let (value, y) = (event.value, &mut self.y);
                let mut at = |t: S| evaluate(value, index, step, t, y);
                event.next = loop {
                    match event.nodes.next_crossing(&mut at)? {
                        Some(crossing) if !event.counts(crossing.rising) => {}
                        found => break found,
                    }
                };
            }
            if let Some(crossing) = event.next
                && first.is_none_or(|(_, first)| if forward { crossing.t < first.t } else { crossing.t > first.t })
            {
                first = Some((index, crossing));
            }
        }
        if let Some(event) = first.and_then(|(index, _)| self.events.get_mut(index)) {
            event.next = None;
        }
        Ok(first)
    }
}

impl<S, Y, Ob, G> Observer<S, Y> for EventSearch<'_, '_, S, Y, Ob, G>
where
    S: Real,
    Y: Vector<S>,
    Ob: Observer<S, Y>,
    G: FnMut(Occurrence<'_, S, Y>) -> ControlFlow<()>,
{
    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()> {
        self.observer.step(step)
    }

    fn observe<R: Formula<S, Y>, O: Ode<S, Y> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, S, Y, R, O>,
    ) -> Result<ControlFlow<()>, IntegrationError<S>> {
        let step = observed.step();
        let (from, to) = (step.start().0, step.end().0);
        for (index, event) in self.events.iter_mut().enumerate() {
            let (value, y) = (event.value, &mut self.y);
            event.nodes = Nodes::new(from, to, &mut |t| evaluate(value, index, &step, t, y))?;
            event.next = None;
        }
        let mut latest = from;
        while let Some((index, crossing)) = self.next(&observed.step())? {
            let Some(event) = self.events.get(index) else { break };
            let (mut t, mut y) = refine::refine(event.value, index, &crossing, observed)?;
            // Refined times of different events may change places by as much as the solution within the step errs.
            if (t < latest) == (to > from) && t != latest {
                t = latest;
                y = observed.step().at(t);
            }
            latest = t;
            observed.correct(t, &mut y);
            let direction = if crossing.rising { Direction::Rising } else { Direction::Falling };
            if (self.on_event)(Occurrence { event: index, t, y: &y, direction }).is_break() {
                if t != to {
                    if observed.integration.ode.accepted(t, (t - from).abs(), &mut y) == Accepted::Refused {
                        return Err(IntegrationError::Refused { t });
                    }
                    observed.integration.progress.check(t, &y)?;
                }
                let _ = self.observer.observe(&mut observed.until((t, &y)))?;
                self.stopped = Some((t, y));
                return Ok(ControlFlow::Break(()));
            }
        }
        self.observer.observe(observed)
    }
}

/// The value of an event in the solution at `t`.
fn evaluate<S: Real, Y: Vector<S>>(
    value: &dyn Fn(S, &Y) -> S,
    event: usize,
    step: &Step<'_, S, Y>,
    t: S,
    y: &mut Y,
) -> Result<S, IntegrationError<S>> {
    step.write_at(t, y);
    finite(value(t, y), event, t)
}

fn finite<S: Real>(value: S, event: usize, t: S) -> Result<S, IntegrationError<S>> {
    if value.is_finite() { Ok(value) } else { Err(IntegrationError::NonFiniteEvent { t, event }) }
}
