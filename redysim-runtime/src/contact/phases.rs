//! Integration from touch-down to lift-off to touch-down.

use core::cell::Cell;
use core::ops::ControlFlow;

use super::{Contact, ContactLaw, Grounded, Phase};
use crate::integrate::algorithm::Formula;
use crate::integrate::{ObservedStep, Observer};
use crate::vector::entry;
use crate::{Event, FrameState, Frames, IntegrationError, Integrator, Ode, Real, Solution, Statistics, Step, Vector};

/// A run has at most so many touch-downs and lift-offs.
const MOST_EVENTS: u64 = 10_000_000;
/// Each contact changes at most so often at one time.
const MOST_AT_ONCE: u64 = 100;
/// Times are one where they differ by less than so many roundoff units of the interval's larger end.
const AT_ONCE: f64 = 64.0;

/// A contact has begun or ended.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactEvent<S> {
    /// Which contact, counted from 0.
    pub contact: usize,
    /// When, s.
    pub t: S,
    /// Whether it has begun (touch-down) or ended (lift-off).
    pub touching: bool,
    /// The origin of its frame then, m, in the base frame.
    pub place: [S; 3],
}

impl<'m, S: Real, M: Frames<S>, L: ContactLaw<S>> Grounded<'m, S, M, L> {
    /// Integrates `ode`, a simulation of this mechanism, from event to event: each touch-down and lift-off ends a step
    /// and begins a new integration, so that the force is smooth within every step. As [`Integrator::run`], which
    /// shows every accepted step to `observer`; each event is shown to `on_event`.
    ///
    /// Contact by contact, whether frame and ground touch is fixed between events, also in the states of steps that are
    /// rejected or that reach beyond an event. Statistics are those of all parts together.
    ///
    /// The state of `ode` begins with q and q̇, as those of [`ForwardSimulation`](crate::ForwardSimulation) and
    /// [`ClosedLoopSimulation`](crate::ClosedLoopSimulation) do.
    ///
    /// ```
    /// # #[allow(dead_code)]
    /// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
    /// # use mechanisms::Ball;
    /// use redysim_runtime::{
    ///     Contact, ForwardSimulation, GroundPlane, Grounded, HuntCrossleyContact, Ode45, ZeroTorque, integrate::Ends,
    /// };
    ///
    /// let law = HuntCrossleyContact { stiffness: 1e6, exponent: 1.5, damping: 0.1, friction: 0.5, slip_velocity: 0.01 };
    /// let contacts = [Contact::new(0, GroundPlane::new([0.0; 3], [0.0, 0.0, 1.0])?, law)?];
    /// let ball = Ball { mass: 0.5 };
    /// let grounded = Grounded::new(&ball, &contacts)?;
    /// let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    /// let start = simulation.state(&[0.0, 0.0, 1.0], &[0.2, 0.0, 0.0]);
    /// let mut bounces = 0;
    /// let method = Ode45::new().rtol(1e-8).atol(1e-10);
    /// grounded.run(&method, &mut simulation, (0.0, 2.0), start, &mut Ends, |event| {
    ///     bounces += u32::from(event.touching);
    /// })?;
    /// assert_eq!(bounces, 3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Integrator::run`]; [`IntegrationError::Chattering`] where contacts begin and end without progress of time, as
    /// with steps that are too long for the damping of the ground; and [`IntegrationError::TooManySteps`] after ten million
    /// events.
    pub fn run<Y: Vector<S>>(
        &self,
        method: &impl Integrator<S>,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        observer: &mut impl Observer<S, Y>,
        mut on_event: impl FnMut(ContactEvent<S>),
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        if self.contacts().is_empty() {
            return method.run(ode, interval, start, observer);
        }
        let _reset = ByPosition(self.contacts());
        self.fix(&start, interval.0, |_| {});
        let mut reached = Solution { t: interval.0, y: start, statistics: Statistics::default() };
        let instant = S::from_f64(AT_ONCE) * S::EPSILON * interval.0.abs().maximum(interval.1.abs());
        let most_at_once = MOST_AT_ONCE * self.contacts().len() as u64;
        let mut at_once = 0;
        for _ in 0..MOST_EVENTS {
            let margin = |_t: S, y: &Y| self.margin(y);
            let mut part = Part { margin: &margin, observer: &mut *observer, ended: false, disagrees: false };
            let mut changed = false;
            let interval = (reached.t, interval.1);
            let solution = method.run_with_events(
                &mut *ode,
                interval,
                reached.y,
                &mut [Event::falling(&margin)],
                &mut part,
                |_| {
                    changed = true;
                    ControlFlow::Break(())
                },
            )?;
            let Part { ended, disagrees, .. } = part;
            let statistics = reached.statistics + solution.statistics;
            reached = Solution { statistics, ..solution };
            if ended || !(changed || disagrees) {
                return Ok(reached);
            }
            at_once = if (reached.t - interval.0).abs() < instant { at_once + 1 } else { 0 };
            if at_once > most_at_once {
                return Err(IntegrationError::Chattering { t: reached.t, events: at_once });
            }
            if changed {
                self.switch(&reached.y, reached.t, &mut on_event);
            } else {
                self.fix(&reached.y, reached.t, &mut on_event);
            }
            if reached.t == interval.1 {
                return Ok(reached);
            }
        }
        Err(IntegrationError::TooManySteps { t: reached.t, limit: MOST_EVENTS })
    }

    /// Calls `see` with each contact, its number and the state of its frame in a state of a simulation.
    fn each_in<Y: Vector<S>>(&self, y: &Y, mut see: impl FnMut(usize, &Contact<S, L>, &FrameState<S>)) {
        let (nq, nv) = (self.mechanism().nq(), self.mechanism().nv());
        let q = M::Coordinates::from_fn(nq, |i| entry(y, i));
        let v = M::Velocities::from_fn(nv, |i| entry(y, nq + i));
        let mut index = 0;
        self.each(&q, &v, |contact, state| {
            see(index, contact, state);
            index += 1;
        });
    }

    /// The smallest margin of all contacts, m: it falls through zero at the first event. 1 m without contacts.
    fn margin<Y: Vector<S>>(&self, y: &Y) -> S {
        let mut smallest: Option<S> = None;
        self.each_in(y, |_, contact, state| {
            let margin = contact.margin(state);
            smallest = Some(smallest.map_or(margin, |least| least.minimum(margin)));
        });
        smallest.unwrap_or(S::one())
    }

    /// Fixes the state of each contact as the position has it.
    fn fix<Y: Vector<S>>(&self, y: &Y, t: S, mut on_event: impl FnMut(ContactEvent<S>)) {
        self.each_in(y, |index, contact, state| {
            contact.set((index, t, state.origin), contact.gap(state) <= S::zero(), &mut on_event);
        });
    }

    /// Changes the contacts whose margin is used up. The time of an event is exact to rounding, so that a rest may be
    /// left: then the contact with the smallest margin is the one that changes.
    fn switch<Y: Vector<S>>(&self, y: &Y, t: S, mut on_event: impl FnMut(ContactEvent<S>)) {
        let limit = self.margin(y).maximum(S::zero());
        self.each_in(y, |index, contact, state| {
            if contact.margin(state) <= limit {
                contact.set((index, t, state.origin), contact.phase.get() != Phase::Closed, &mut on_event);
            }
        });
    }
}

impl<S: Real, L: ContactLaw<S>> Contact<S, L> {
    /// Fixes whether contact number `contact`, whose frame is at `place`, is closed from `t` on, and reports it if that is a
    /// change.
    fn set(&self, (contact, t, place): (usize, S, [S; 3]), closed: bool, on_event: &mut impl FnMut(ContactEvent<S>)) {
        let before = self.phase.replace(if closed { Phase::Closed } else { Phase::Open });
        if closed != (before == Phase::Closed) {
            on_event(ContactEvent { contact, t, touching: closed, place });
        }
    }
}

/// Contacts whose state follows from the position again when this goes away.
struct ByPosition<'m, S, L>(&'m [Contact<S, L>]);

impl<S, L> Drop for ByPosition<'_, S, L> {
    fn drop(&mut self) {
        for Contact { phase, .. } in self.0 {
            Cell::set(phase, Phase::ByPosition);
        }
    }
}

/// The observer of a part of the run between two events.
struct Part<'a, S, Y, O> {
    margin: &'a dyn Fn(S, &Y) -> S,
    observer: &'a mut O,
    /// Whether the observer has ended the integration.
    ended: bool,
    /// Whether position and state of a contact differ at the end of a step without an event: after one whose time was
    /// rounded to the wrong side.
    disagrees: bool,
}

impl<S: Real, Y: Vector<S>, O: Observer<S, Y>> Observer<S, Y> for Part<'_, S, Y, O> {
    fn needs_dense_output(&self, _from: S, _to: S) -> bool {
        true
    }

    fn step(&mut self, step: &Step<'_, S, Y>) -> ControlFlow<()> {
        let flow = self.observer.step(step);
        self.after(step, flow)
    }

    fn observe<F: Formula<S, Y>, E: Ode<S, Y> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, S, Y, F, E>,
    ) -> Result<ControlFlow<()>, IntegrationError<S>> {
        let flow = self.observer.observe(observed)?;
        Ok(self.after(&observed.step(), flow))
    }
}

impl<S: Real, Y, O> Part<'_, S, Y, O> {
    fn after(&mut self, step: &Step<'_, S, Y>, flow: ControlFlow<()>) -> ControlFlow<()>
    where
        Y: Vector<S>,
    {
        let (t, y) = step.end();
        self.ended = flow.is_break();
        self.disagrees = (self.margin)(t, y) < S::zero();
        if self.ended || self.disagrees { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
