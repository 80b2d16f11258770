//! Dormand-Prince with steps chosen from tolerances.

use core::ops::ControlFlow;

use super::adaptive::{self, Options};
use super::interval::Interval;
use super::tableau::DORMAND_PRINCE;
use super::tolerance::{Absolute, Tolerances};
use super::{IntegrationError, Integrator, Ode, Solution, Step};
use crate::{Real, Vector};

/// The pair of Dormand and Prince of orders 5 and 4 with steps chosen from tolerances: MATLAB's `ode45`.
///
/// A step is accepted when its estimated error e satisfies, for every component i,
/// |e_i| ≤ max(rtol max(|y_i|, |y_new,i|), atol_i). The estimate belongs to the formula of order 4, and the more accurate
/// one of order 5 goes on. Errors of steps add up, and the equation may amplify them: ask for less than is allowed at the
/// end. First step, step control and defaults are those of MATLAB's `ode45`; sums over the steps are compensated, so that
/// tight tolerances pay. Each attempted step costs 6 evaluations, and the start one more.
///
/// A derivative that is infinite or not a number at an attempted step makes the step smaller; only where that does not
/// help, it is an error.
///
/// ```
/// use redysim_runtime::{Integrator, Ode45};
///
/// // ẏ = −2 t y², y(0) = 1, has the solution 1/(1 + t²).
/// let mut bell = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -2.0 * t * y[0] * y[0];
/// let end = Ode45::new().rtol(1e-9).atol(1e-9).integrate(&mut bell, (0.0, 3.0), [1.0])?;
/// assert!((end.y[0] - 0.1).abs() < 1e-8);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Ode45<'a, S> {
    options: Options<'a, S>,
}

impl<'a, S: Real> Ode45<'a, S> {
    /// The method with MATLAB's defaults: rtol 10⁻³, atol 10⁻⁶, steps of at most a tenth of the interval.
    pub fn new() -> Self {
        let tolerances = Tolerances { relative: S::from_f64(1e-3), absolute: Absolute::All(S::from_f64(1e-6)) };
        Self { options: Options { tolerances, initial_step: None, max_step: None, max_steps: 100_000_000 } }
    }

    /// Sets the relative tolerance, at least 100 roundoff units (2.2·10⁻¹⁴ for `f64`, 1.2·10⁻⁵ for `f32`): no step
    /// could keep a smaller one, so it is an error where MATLAB warns and takes the smallest.
    pub fn rtol(mut self, tolerance: S) -> Self {
        self.options.tolerances.relative = tolerance;
        self
    }

    /// Sets one absolute tolerance for all components, > 0, in the units of the state.
    pub fn atol(mut self, tolerance: S) -> Self {
        self.options.tolerances.absolute = Absolute::All(tolerance);
        self
    }

    /// Sets one absolute tolerance, > 0, for each component.
    pub fn atol_each(mut self, tolerances: &'a [S]) -> Self {
        self.options.tolerances.absolute = Absolute::Each(tolerances);
        self
    }

    /// Sets the size of the first step to try, > 0; unless told, it follows from the derivative at the start.
    pub fn initial_step(mut self, size: S) -> Self {
        self.options.initial_step = Some(size);
        self
    }

    /// Sets the largest size of a step, > 0; unless told, a tenth of the interval. The last step may be a tenth longer,
    /// so that it ends at the end.
    pub fn max_step(mut self, size: S) -> Self {
        self.options.max_step = Some(size);
        self
    }

    /// Gives up after `max_steps` steps, accepted or rejected; 10⁸ unless told.
    pub fn max_steps(mut self, max_steps: u64) -> Self {
        self.options.max_steps = max_steps;
        self
    }
}

impl<S: Real> Default for Ode45<'_, S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<S: Real> Integrator<S> for Ode45<'_, S> {
    fn each_step_until<Y: Vector<S>>(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        interval: (S, S),
        start: Y,
        on_step: impl FnMut(&Step<'_, S, Y>) -> ControlFlow<()>,
    ) -> Result<Solution<S, Y>, IntegrationError<S>> {
        adaptive::integrate(&DORMAND_PRINCE, &self.options, ode, Interval::new(interval)?, start, on_step)
    }
}
