//! The interface of a method, and what it returns.

use core::ops::{Add, ControlFlow};

use super::events::EventSearch;
use super::interval::Interval;
use super::observer::{Ends, EveryStep, Observer};
use super::save_at::SaveAt;
use super::{Event, IntegrationError, Occurrence, Ode, Step};
use crate::{Real, Vector};

/// A method that solves initial value problems.
///
/// The ways to receive a solution differ only in what they report during the integration; the steps are the same.
///
/// ```
/// use redysim_runtime::{Integrator, Ode45};
///
/// let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
/// let method = Ode45::new().rtol(1e-10).atol(1e-12);
///
/// let end = method.integrate(&mut oscillator, (0.0, 2.0), [1.0, 0.0])?;
/// assert!((end.y[0] - 2.0_f64.cos()).abs() < 1e-9);
///
/// method.solve(&mut oscillator, (0.0, 2.0), [1.0, 0.0], [0.5, 1.0, 2.0], |t, y| {
///     assert!((y[0] - t.cos()).abs() < 1e-9);
/// })?;
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub trait Integrator<S: Real> {
    /// Integrates from `start` at the first time of `interval` to the second, earlier or later, and shows every
    /// accepted step to `observer`, which may end the integration after it. All other functions are this one with an
    /// observer.
    ///
    /// # Errors
    /// What [`IntegrationError`] lists; the number of evaluations is bounded in every case.
    fn run<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        observer: &mut impl Observer<S, Y>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>>;

    /// Shows every accepted step to `on_step`, which may ask it for the solution at any time within.
    /// [`ControlFlow::Break`] ends the integration after that step.
    ///
    /// # Errors
    /// As [`run`](Self::run).
    fn each_step_until<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        self.run(ode, interval, start, &mut EveryStep(on_step))
    }

    /// As [`each_step_until`](Self::each_step_until), always to the end of the interval.
    ///
    /// # Errors
    /// As [`each_step_until`](Self::each_step_until).
    fn each_step<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        mut on_step: impl FnMut(&Step<'_, S, Y>),
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        self.each_step_until(ode, interval, start, |step| {
            on_step(step);
            ControlFlow::Continue(())
        })
    }

    /// Integrates over `interval` and calls `output` with every time of `save_at` and the solution there. The
    /// times follow the direction of integration, lie within the interval, both ends allowed, and do not change the
    /// steps.
    ///
    /// # Errors
    /// As [`each_step_until`](Self::each_step_until), and for a time outside the interval or out of order, as soon as
    /// the iterator yields it.
    fn solve<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        save_at: impl IntoIterator<Item = S>,
        output: impl FnMut(S, &Y),
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        let mut saver = SaveAt::new(save_at.into_iter(), Interval::new(interval)?, start.clone(), output)?;
        let solution = self.run(ode, interval, start, &mut saver)?;
        saver.fault().map_or(Ok(solution), Err)
    }

    /// Integrates over `interval` and looks for `events`: every crossing of zero of their functions is shown to
    /// `on_event`, in order of time, also several in one step, before `on_step` is shown the step in which they are.
    /// [`ControlFlow::Break`] from `on_event` ends the solution at the event: `on_step` is shown the step up to there,
    /// and the [`Solution`] has the time and the state of the event, corrected by [`Ode::accepted`] like that at the
    /// end of a step. Break from `on_step` ends it after that step.
    ///
    /// Crossings are found on the continuous extension, by nine samples of each step, and by a search for the minimum
    /// where a function comes near zero between them; one that crosses zero twice within a sixteenth of a step may be
    /// missed. Methods whose extension is of lower order than their steps, all but [`Ode15s`](crate::Ode15s) and
    /// [`SemiImplicitEuler`](crate::SemiImplicitEuler), then refine time and state by steps of their own, so that both
    /// are as exact as the ends of steps: up to six steps for each crossing, and usually two or three. The steps of the
    /// integration are the same as without events.
    ///
    /// # Errors
    /// As [`each_step_until`](Self::each_step_until), and for a function that is infinite or not a number.
    ///
    /// ```
    /// use core::ops::ControlFlow;
    /// use redysim_runtime::{Event, Integrator, Ode45};
    ///
    /// // A ball falls from 10 m.
    /// let mut fall = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -9.81];
    /// let events = &mut [Event::falling(&|_t, y: &[f64; 2]| y[0])];
    /// let go_on = |_: &redysim_runtime::Step<'_, f64, [f64; 2]>| ControlFlow::Continue(());
    /// let stop = |_: redysim_runtime::Occurrence<'_, f64, [f64; 2]>| ControlFlow::Break(());
    /// let end = Ode45::new().solve_with_events(&mut fall, (0.0, 5.0), [10.0, 0.0], events, go_on, stop)?;
    /// assert!((end.t - (20.0_f64 / 9.81).sqrt()).abs() < 1e-14);
    /// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
    /// ```
    fn solve_with_events<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        events: &mut [Event<'_, S, Y>],
        on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
        on_event: impl FnMut(Occurrence<'_, S, Y>) -> ControlFlow<()>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        self.run_with_events(ode, interval, start, events, &mut EveryStep(on_step), on_event)
    }

    /// As [`solve_with_events`](Self::solve_with_events), with an `observer` of the steps, as [`run`](Self::run) has one.
    /// An event that ends the solution ends the step that the observer sees.
    ///
    /// # Errors
    /// As [`solve_with_events`](Self::solve_with_events).
    fn run_with_events<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        events: &mut [Event<'_, S, Y>],
        observer: &mut impl Observer<S, Y>,
        on_event: impl FnMut(Occurrence<'_, S, Y>) -> ControlFlow<()>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        let mut search = EventSearch::new(events, start.clone(), observer, on_event);
        let solution = self.run(ode, interval, start, &mut search)?;
        Ok(match search.stopped() {
            Some((t, y)) => Solution { t, y, ..solution },
            None => solution,
        })
    }

    /// Integrates over `interval`, for the end alone.
    ///
    /// # Errors
    /// As [`each_step_until`](Self::each_step_until).
    fn integrate<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        self.run(ode, interval, start, &mut Ends)
    }
}

/// Where an integration ended, and what it took.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Solution<S, Y> {
    /// The end of the interval, or the time at which the observer ended the integration.
    pub t: S,
    /// The state at `t`.
    pub y: Y,
    /// What it took.
    pub statistics: Statistics,
}

/// What an integration took; the sum of two is what both took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Accepted steps.
    pub steps: u64,
    /// Attempted steps that were rejected and tried again with a smaller size.
    pub rejected: u64,
    /// Evaluations of the right-hand side, those after corrections, for differences, for events and for dense output
    /// included; [tangents](Ode::tangent) are not.
    pub evaluations: u64,
    /// Accepted steps whose end was corrected by [`Ode::accepted`]. A state at which an event ends the integration is
    /// not counted.
    pub corrections: u64,
    /// Evaluations of the Jacobian ∂f/∂y.
    pub jacobians: u64,
    /// Decompositions of a matrix.
    pub decompositions: u64,
}

impl Add for Statistics {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            steps: self.steps + other.steps,
            rejected: self.rejected + other.rejected,
            evaluations: self.evaluations + other.evaluations,
            corrections: self.corrections + other.corrections,
            jacobians: self.jacobians + other.jacobians,
            decompositions: self.decompositions + other.decompositions,
        }
    }
}
