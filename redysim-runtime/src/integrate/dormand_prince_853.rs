//! The pair of Dormand and Prince of order 8, with steps of one size and with steps from tolerances.

use super::adaptive::Adaptive;
use super::algorithm::Algorithm;
use super::explicit::Explicit;
use super::fixed::FixedStep;
use super::integration::Integration;
use super::step_control::{Elementary, EstimatesErrors};
use super::tableau::DORMAND_PRINCE_853;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The method of Dormand and Prince of order 8 with steps of one given size.
///
/// Each step costs 12 evaluations, and the first one more; dense output costs three more. Where the step is halved, the
/// error shrinks about 256 times.
///
/// ```
/// use redysim_runtime::{Dop8, Integrator};
///
/// let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
/// let end = Dop8::new(0.1).integrate(&mut decay, (0.0, 1.0), [1.0])?;
/// assert!((end.y[0] - (-1.0_f64).exp()).abs() < 1e-14);
/// assert_eq!(end.statistics.evaluations, 121);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Dop8<S> = FixedStep<S, DormandPrince853>;

/// The pair of Dormand and Prince of order 8 with steps chosen from tolerances: the method of tight ones.
///
/// Two embedded formulas of orders 5 and 3 estimate the error together, e² / √(e² + 0.01 ẽ²), which shrinks with the
/// eighth power of the step; between the ends of a step the solution is a polynomial of degree 7, accurate to order 7.
/// Each attempted step costs 12 evaluations, dense output three more, and the start one. For smooth equations and
/// tolerances below about 10⁻⁷ that is less than [`Ode45`](crate::Ode45) takes. The method is that of E. Hairer, S. P.
/// Nørsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., Springer (1993), section II.10; the
/// steps are chosen by the rules of [`Adaptive`], not by those of the book.
///
/// ```
/// use redysim_runtime::{Dop853, Integrator};
///
/// // ẏ = −2 t y², y(0) = 1, has the solution 1/(1 + t²).
/// let mut bell = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -2.0 * t * y[0] * y[0];
/// let end = Dop853::new().rtol(1e-12).atol(1e-12).integrate(&mut bell, (0.0, 3.0), [1.0])?;
/// assert!((end.y[0] - 0.1).abs() < 1e-11);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Dop853<'a, S> = Adaptive<'a, S, DormandPrince853>;

/// The method of [`DORMAND_PRINCE_853`].
#[derive(Clone, Copy, Debug)]
pub enum DormandPrince853 {}

impl EstimatesErrors for DormandPrince853 {
    type Control<S: Real, Y: Vector<S>> = Elementary;

    fn control<S: Real, Y: Vector<S>>() -> Elementary {
        Elementary { error_exponent: DORMAND_PRINCE_853.error_exponent }
    }
}

impl Algorithm for DormandPrince853 {
    type Formula<S: Real, Y: Vector<S>> = Explicit<Y, 16>;

    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
        Explicit::new(&DORMAND_PRINCE_853, integration)
    }
}
