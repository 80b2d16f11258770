//! The pair of Dormand and Prince of orders 5 and 4, with steps of one size and with steps from tolerances.

use super::adaptive::Adaptive;
use super::algorithm::Algorithm;
use super::explicit::Explicit;
use super::fixed::FixedStep;
use super::integration::Integration;
use super::step_control::{Elementary, EstimatesErrors};
use super::tableau::DORMAND_PRINCE;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The method of Dormand and Prince of order 5 with steps of one given size: MATLAB's `ode5`, ReDySim's choice 2.
///
/// Each step costs 6 evaluations, and the first one more. Where the step is halved, the error shrinks about 32 times.
///
/// ```
/// use redysim_runtime::{Integrator, Ode5};
///
/// let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
/// let end = Ode5::new(0.01).integrate(&mut decay, (0.0, 1.0), [1.0])?;
/// assert!((end.y[0] - (-1.0_f64).exp()).abs() < 1e-12);
/// assert_eq!(end.statistics.evaluations, 601);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Ode5<S> = FixedStep<S, DormandPrince>;

/// The pair of Dormand and Prince of orders 5 and 4 with steps chosen from tolerances: MATLAB's `ode45`, ReDySim's
/// choice 0.
///
/// The estimate of the error belongs to the formula of order 4, and the more accurate one of order 5 goes on. Sums over
/// the steps are compensated, so that tight tolerances pay. Each attempted step costs 6 evaluations, and the start one
/// more.
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
pub type Ode45<'a, S> = Adaptive<'a, S, DormandPrince>;

/// The method of [`DORMAND_PRINCE`].
#[derive(Clone, Copy, Debug)]
pub enum DormandPrince {}

impl EstimatesErrors for DormandPrince {
    type Control<S: Real, Y: Vector<S>> = Elementary;

    fn control<S: Real, Y: Vector<S>>() -> Elementary {
        Elementary { error_exponent: DORMAND_PRINCE.error_exponent }
    }
}

impl Algorithm for DormandPrince {
    type Formula<S: Real, Y: Vector<S>> = Explicit<Y, 7>;

    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
        Explicit::new(&DORMAND_PRINCE, integration)
    }
}
