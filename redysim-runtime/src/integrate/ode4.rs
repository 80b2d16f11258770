//! The classical Runge-Kutta method.

use super::algorithm::Algorithm;
use super::explicit::Explicit;
use super::fixed::FixedStep;
use super::integration::Integration;
use super::tableau::RUNGE_KUTTA_4;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The classical Runge-Kutta method of order 4 with steps of one given size: MATLAB's `ode4`.
///
/// Each step costs 4 evaluations, and the first one more. Where the step is halved, the error shrinks about 16 times.
/// Between the ends of its steps the solution is a cubic polynomial, accurate to order 3.
///
/// ```
/// use redysim_runtime::{Integrator, Ode4};
///
/// let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
/// let end = Ode4::new(0.01).integrate(&mut decay, (0.0, 1.0), [1.0])?;
/// assert!((end.y[0] - (-1.0_f64).exp()).abs() < 1e-10);
/// assert_eq!(end.statistics.evaluations, 401);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Ode4<S> = FixedStep<S, RungeKutta4>;

/// The method of [`RUNGE_KUTTA_4`].
#[derive(Clone, Copy, Debug)]
pub enum RungeKutta4 {}

impl Algorithm for RungeKutta4 {
    type Formula<S: Real, Y: Vector<S>> = Explicit<Y, 5>;

    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
        Explicit::new(&RUNGE_KUTTA_4, integration)
    }
}
