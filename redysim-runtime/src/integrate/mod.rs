//! Integration of ordinary differential equations ẏ = f(t, y), forward or backward in time, without allocation.
//!
//! [`Ode4`], [`Ode5`], [`Dop8`] and [`SemiImplicitEuler`] take steps of one given size; [`Ode45`] and [`Dop853`] choose
//! their steps from tolerances, as MATLAB's `ode45` does. [`Ode15s`] and [`Radau5`] are for stiff equations, [`Gauss4`]
//! and [`Gauss6`] for long conservative motion. Each is an [`Integrator`], and gives the solution between its steps,
//! too. What is integrated is an [`Ode`]: a closure, a [`ForwardSimulation`](crate::ForwardSimulation) of a mechanism,
//! or a [`ClosedLoopSimulation`](crate::ClosedLoopSimulation), which corrects the end of each step.
//!
//! [`solve_with_events`](Integrator::solve_with_events) finds [`Event`]s on the way, [`stability`] computes before a
//! run how large steps may be, and explicit methods report where an equation is stiff.
//!
//! The parts of an integration are separate, as in OrdinaryDiffEq.jl: a [`Formula`](algorithm::Formula) takes one trial
//! step and keeps its own cache ([`explicit`], [`collocation`]; coefficients in [`tableau`]), a
//! [`StepControl`](step_control::StepControl) chooses sizes from errors, and an
//! [`Integration`](integration::Integration), owned by the `driver` of `fixed` and `adaptive`, has equation,
//! tolerances, time, state and statistics. Another explicit Runge-Kutta pair is another [`Tableau`](tableau::Tableau),
//! another method of any kind another [`Algorithm`](algorithm::Algorithm).

mod adaptive;
pub mod algorithm;
pub mod collocation;
mod complex;
mod dormand_prince;
mod dormand_prince_853;
mod driver;
mod error;
mod events;
pub mod explicit;
mod fixed;
mod implicit;
pub mod integration;
mod interval;
mod ndf;
mod observer;
mod ode4;
mod save_at;
mod semi_implicit_euler;
pub mod stability;
mod step;
pub mod step_control;
mod stiffness;
pub mod tableau;
mod tolerance;

use core::ops::ControlFlow;

pub use adaptive::Adaptive;
pub use collocation::gauss::{Gauss4, Gauss6, GaussLegendre2, GaussLegendre3};
pub use collocation::radau::{Radau5, RadauIIA};
pub use dormand_prince::{DormandPrince, Ode5, Ode45};
pub use dormand_prince_853::{Dop8, Dop853, DormandPrince853};
pub use error::IntegrationError;
pub use events::{Direction, Event, Occurrence};
pub use fixed::FixedStep;
pub use ndf::{Bdf, Ndf, Ode15s};
pub use observer::{ObservedStep, Observer};
pub use ode4::{Ode4, RungeKutta4};
pub use semi_implicit_euler::{SemiImplicitEuler, SymplecticEuler};
pub use step::Step;
pub use tolerance::Tolerances;

use crate::{LengthMismatch, Real, Vector};
use events::EventSearch;
use interval::Interval;
use observer::{Ends, EveryStep};
use save_at::SaveAt;

/// The right-hand side of an ordinary differential equation, ẏ = f(t, y).
///
/// Every closure `FnMut(S, &Y, &mut Y)` is one. An integrator calls it at points of its own choice, also at points of
/// steps that it then rejects, and not always in the order of time.
pub trait Ode<S, Y> {
    /// Writes f(t, y) to `dydt`, which has the length of `y` and holds anything.
    fn derivative(&mut self, t: S, y: &Y, dydt: &mut Y);

    /// Checks, before the first derivative, that the state `y` at the first time `t` and the vectors that the equation
    /// holds have the lengths that it needs. Arrays always have. By default, nothing is checked.
    ///
    /// # Errors
    /// The first vector that has another length.
    fn check_lengths(&self, t: S, y: &Y) -> Result<(), LengthMismatch> {
        let _ = (t, y);
        Ok(())
    }

    /// Called once for each accepted step, with its end `t`, its size `step` > 0 and the state `y` there, which may be
    /// corrected in place: brought back to what an invariant of the equation demands. What an integration shows as the
    /// end of the step is the corrected state, and from there it goes on; within the step the solution is that of the
    /// method. Where an event ends the integration within a step, it is called once more, for the state there, which is
    /// earlier. By default, nothing happens.
    fn accepted(&mut self, t: S, step: S, y: &mut Y) -> Accepted {
        let _ = (t, step, y);
        Accepted::Unchanged
    }

    /// Writes (∂f/∂y) `direction` at (t, y) to `slope` and returns `true`, if it can do that without differences; from
    /// such products implicit methods have their Jacobians. `false`, the default, leaves them to differences.
    fn tangent(&mut self, t: S, y: &Y, direction: &Y, slope: &mut Y) -> bool {
        let _ = (t, y, direction, slope);
        false
    }

    /// Writes the rates of the leading components of y that are coordinates of a mechanical system, those whose rates
    /// depend on the coordinates and velocities alone, and returns how many there are: what a method needs that treats
    /// coordinates and velocities differently. The default is 0.
    fn coordinate_rates(&mut self, t: S, y: &Y, rates: &mut Y) -> usize {
        let _ = (t, y, rates);
        0
    }
}

/// What an [`Ode`] makes of the state at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// It stays.
    Unchanged,
    /// It was changed, so that the derivative there must be evaluated again.
    Corrected,
    /// It cannot be accepted: the integration ends with [`IntegrationError::Refused`].
    Refused,
}

impl<S, Y, F: FnMut(S, &Y, &mut Y)> Ode<S, Y> for F {
    fn derivative(&mut self, t: S, y: &Y, dydt: &mut Y) {
        self(t, y, dydt);
    }
}

/// A method that solves initial value problems.
///
/// The ways to receive a solution differ only in what they report on the way; the steps are the same.
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
    /// accepted step to `observer`, who may end the integration after it. All other functions are this one with an
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
    /// missed. Methods whose extension is of lower order than their steps, all but [`Ode15s`] and
    /// [`SemiImplicitEuler`], then refine time and state by steps of their own, so that both are as exact as the ends
    /// of steps: up to six steps for each crossing, and usually two or three. The steps of the integration are the same
    /// as without events.
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
        let mut search = EventSearch::new(events, start.clone(), on_step, on_event);
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
pub struct Solution<S, Y> {
    /// The end of the interval, or of the step after which the integration was told to break.
    pub t: S,
    /// The state at `t`.
    pub y: Y,
    /// What it took.
    pub statistics: Statistics,
}

/// What an integration took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
