//! The classical Runge-Kutta method with steps of one size.

use core::ops::ControlFlow;

use super::adaptive::check_step;
use super::interval::Interval;
use super::tableau::RUNGE_KUTTA_4;
use super::{IntegrationError, Integrator, Ode, Solution, Step, fixed};
use crate::{Real, Vector};

/// The classical Runge-Kutta method of order 4 with steps of one given size: MATLAB's `ode4`.
///
/// Steps end where those of [`Ode5`](crate::Ode5) do. Each costs 4 evaluations, and the first one more. Nothing estimates
/// the error: halve the step and compare, the error shrinks about 16 times. Between the ends of its steps the solution is
/// a cubic polynomial, accurate to order 3.
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
#[derive(Clone, Copy, Debug)]
pub struct Ode4<S> {
    step: S,
    max_steps: u64,
}

impl<S: Real> Ode4<S> {
    /// The method with steps of size `step` > 0, in units of time, whichever the direction of integration.
    pub fn new(step: S) -> Self {
        Self { step, max_steps: 1_000_000_000 }
    }

    /// Refuses, before it begins, what would take more than `max_steps` steps; 10⁹ unless told.
    pub fn max_steps(self, max_steps: u64) -> Self {
        Self { max_steps, ..self }
    }
}

impl<S: Real> Integrator<S> for Ode4<S> {
    fn each_step_until<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        check_step("step", Some(self.step))?;
        let interval = Interval::new(interval)?;
        fixed::integrate(&RUNGE_KUTTA_4, self.step, self.max_steps, ode, interval, start, on_step)
    }
}
