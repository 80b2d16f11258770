//! The semi-implicit method of Euler.

use core::slice::from_ref;

use super::algorithm::{Algorithm, Formula};
use super::fixed::FixedStep;
use super::integration::{Integration, Progress, zeros};
use super::step::Step;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The semi-implicit (symplectic) method of Euler for mechanical systems, with steps of one given size.
///
/// A step of size h is
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
/// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
/// # use mechanisms::Pendulum;
/// use redysim_runtime::{ForwardSimulation, ZeroTorque, Integrator, MechanicalEnergy, SemiImplicitEuler};
///
/// let pendulum = Pendulum { mass: 2.0, length: 0.5 };
/// let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
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

impl Algorithm for SymplecticEuler {
    type Formula<S: Real, Y: Vector<S>> = SemiImplicit<Y>;

    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
        let progress = &integration.progress;
        let mut rate = zeros(&progress.y);
        let coordinates = integration.ode.coordinate_rates(progress.t, &progress.y, &mut rate);
        if coordinates == 0 {
            return Err(IntegrationError::NoCoordinates);
        }
        integration.evaluate(integration.progress.t, &mut rate)?;
        Ok(SemiImplicit { scratch: zeros(&rate), rate, coordinates })
    }
}

/// Takes the steps of [`SemiImplicitEuler`].
#[derive(Clone, Debug)]
pub struct SemiImplicit<Y> {
    /// The derivative at the start of the step.
    rate: Y,
    scratch: Y,
    /// How many of the leading components are coordinates.
    coordinates: usize,
}

impl<S: Real, Y: Vector<S>> Formula<S, Y> for SemiImplicit<Y> {
    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        let Self { rate, scratch, coordinates } = self;
        let Integration { ode, progress, .. } = integration;
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

    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y> {
        progress.step(S::one(), from_ref(&progress.increment), &[&[1.0]])
    }

    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        _corrected: bool,
    ) -> Result<(), IntegrationError<S>> {
        integration.evaluate_at_state(&mut self.rate)
    }
}
