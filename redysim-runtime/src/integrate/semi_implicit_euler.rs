//! The semi-implicit method of Euler.

use core::slice::from_ref;

use super::fixed::FixedStep;
use super::method::{Method, Stepper};
use super::progress::{Progress, zeros};
use super::step::Step;
use super::tolerance::Tolerances;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The semi-implicit (symplectic) method of Euler for mechanical systems, with steps of one given size h:
///
/// v_new = v + h a(t, q, v), q_new = q + h N(q) v_new.
///
/// It is of order 1: a baseline, and what many simulators of contact use. Where forces come from a potential and the
/// mass matrix is constant, it is symplectic: the energy swings by O(h) but does not drift, which it would with the
/// explicit method of Euler. Coordinates are what [`Ode::coordinate_rates`] says; everything else, velocities and the
/// work of actuators, takes the explicit step. Each step costs one evaluation. Between the ends of its steps the
/// solution is linear in time, as accurate as the method. E. Hairer, C. Lubich and G. Wanner, *Geometric Numerical
/// Integration*, 2nd ed., Springer (2006), section I.1.
///
/// ```
/// # #[allow(dead_code)]
/// # mod mechanisms { include!("../../tests/mechanisms/mod.rs"); }
/// # use mechanisms::Pendulum;
/// use redysim_runtime::{ForwardSimulation, Free, Integrator, MechanicalEnergy, SemiImplicitEuler};
///
/// let pendulum = Pendulum { mass: 2.0, length: 0.5 };
/// let mut simulation = ForwardSimulation::new(&pendulum, Free);
/// let start = simulation.state(&[0.3], &[0.0]);
/// let end = SemiImplicitEuler::new(0.01).integrate(&mut simulation, (0.0, 100.0), start)?;
/// let energy = |y: &[f64; 3]| pendulum.energy(&[y[0]], &[y[1]]).total();
/// assert!((energy(&end.y) - energy(&start)).abs() < 0.02);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type SemiImplicitEuler<S> = FixedStep<S, SymplecticEuler>;

/// The method of [`SemiImplicitEuler`].
#[derive(Clone, Copy, Debug)]
pub enum SymplecticEuler {}

impl Method for SymplecticEuler {
    type Stepper<S: Real, Y: Vector<S>> = SemiImplicit<S, Y>;

    fn start<S: Real, Y: Vector<S>>(
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self::Stepper<S, Y>, IntegrationError<S>> {
        let mut progress = Progress::new(t, y)?;
        let mut rate = zeros(&progress.y);
        let coordinates = ode.coordinate_rates(t, &progress.y, &mut rate);
        if coordinates == 0 {
            return Err(IntegrationError::NoCoordinates);
        }
        progress.evaluate(ode, t, &mut rate)?;
        Ok(SemiImplicit { scratch: zeros(&rate), progress, rate, coordinates })
    }
}

/// Takes the steps of [`SemiImplicitEuler`].
#[derive(Clone, Debug)]
pub struct SemiImplicit<S, Y> {
    progress: Progress<S, Y>,
    /// The derivative at the start of the step.
    rate: Y,
    scratch: Y,
    /// How many of the leading components are coordinates.
    coordinates: usize,
}

impl<S: Real, Y: Vector<S>> Stepper<S, Y> for SemiImplicit<S, Y> {
    fn progress(&self) -> &Progress<S, Y> {
        &self.progress
    }

    fn progress_mut(&mut self) -> &mut Progress<S, Y> {
        &mut self.progress
    }

    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t_new: S,
        _tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        let Self { progress, rate, scratch, coordinates } = self;
        progress.t_new = t_new;
        progress.increment.clone_from(rate);
        progress.advance_by_increment();
        // N is that of the coordinates at the start, since they are not known at the end.
        for (new, &old) in progress.y_new.as_mut().iter_mut().zip(progress.y.as_ref()).take(*coordinates) {
            *new = old;
        }
        ode.coordinate_rates(progress.t, &progress.y_new, scratch);
        progress.increment.clone_from(rate);
        for (rate, &new) in progress.increment.as_mut().iter_mut().zip(scratch.as_ref()).take(*coordinates) {
            *rate = new;
        }
        progress.advance_by_increment();
        Ok(())
    }

    /// Nothing estimates it.
    fn error(&mut self, _tolerances: &Tolerances<'_, S>) -> S {
        S::zero()
    }

    fn error_exponent(&self) -> u32 {
        2
    }

    fn step(&self) -> Step<'_, S, Y> {
        let Progress { t, y, t_new, y_new, increment, .. } = &self.progress;
        Step::new((*t, y), (*t_new, y_new), S::one(), from_ref(increment), &[&[1.0]])
    }

    fn accept(&mut self) {
        self.progress.accept();
    }

    fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        self.progress.take_correction();
        self.progress.y_new.clone_from(&self.progress.y);
        self.progress.evaluate(ode, self.progress.t, &mut self.rate)
    }
}
