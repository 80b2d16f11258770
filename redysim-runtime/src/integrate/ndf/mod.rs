//! Numerical differentiation formulas of orders 1 to 5 with steps and order from tolerances, for stiff equations.
//!
//! The formulas are in [`coefficients`], the past of the solution in [`differences`], the equation for the end of a
//! step in [`correction_solver`], a step in [`formula`]; size and order are chosen by [`VariableOrder`].

mod coefficients;
#[cfg(test)]
mod convergence;
mod correction_solver;
mod differences;
mod formula;

use super::adaptive::Adaptive;
use super::algorithm::Algorithm;
use super::integration::Integration;
use super::step_control::{EstimatesErrors, VariableOrder};
use super::{IntegrationError, Ode};
use crate::{Real, Vector};
use coefficients::{BACKWARD_DIFFERENTIATION, HIGHEST_ORDER, NUMERICAL_DIFFERENTIATION};
pub use formula::NdfFormula;

/// The numerical differentiation formulas of orders 1 to 5 with steps and order chosen from tolerances: MATLAB's
/// `ode15s`, ReDySim's choice 1. For stiff equations, those whose fast motions have long died down.
///
/// The formula of order k is Σ_{m=1}^k (1/m) ∇^m y_{n+1} − h f(t_{n+1}, y_{n+1}) − κ γ_k ∇^{k+1} y_{n+1} = 0, with
/// backward differences ∇, γ_k = Σ_{j=1}^k 1/j and the κ of L. F. Shampine, M. W. Reichelt, *The MATLAB ODE Suite*,
/// SIAM J. Sci. Comput. 18 (1997), section 2. It is solved by a simplified Newton iteration with the Jacobian ∂f/∂y
/// along the [tangent space](Ode::project_onto_tangent) from [`Ode::tangent`] or else from differences; a new Jacobian is
/// evaluated only where the iteration does not converge, and a matrix decomposed only for that and for another size or
/// order. A step of n components costs one or two evaluations and n² operations, a Jacobian n tangents or n + 1
/// evaluations, a decomposition n³/3 operations; there is room for two matrices and 18 vectors.
///
/// Size and order change only where the estimated error pays for it, and not before k + 2 steps of one size. Between
/// the ends of its steps the solution is the polynomial of degree k through the ends of the last k steps, continuous,
/// and accurate to order k; its derivative jumps a little from step to step.
///
/// The formulas of orders 1 and 2 are stable wherever the equation is. Those of orders 3, 4 and 5 are not along the
/// imaginary axis: for oscillations that hardly die down there is [`Ndf<2>`](Ndf), which goes no further than order 2.
///
/// ```
/// use redysim_runtime::{Integrator, Ode15s};
///
/// // ẏ = −10⁶ (y − cos t) − sin t, y(0) = 2, soon is cos t.
/// let mut stiff = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -1e6 * (y[0] - t.cos()) - t.sin();
/// let end = Ode15s::new().rtol(1e-6).atol(1e-6).integrate(&mut stiff, (0.0, 3.0), [2.0])?;
/// assert!((end.y[0] - 3.0_f64.cos()).abs() < 1e-5);
/// assert!(end.statistics.evaluations < 300);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Ode15s<'a, S> = Adaptive<'a, S, Ndf>;

/// The numerical differentiation formulas of orders 1 to `MAX_ORDER`, at most 5: see [`Ode15s`]. They start with order
/// 1; with [`FixedStep`](super::FixedStep), which estimates no error, they stay there.
///
/// ```
/// use redysim_runtime::Integrator;
/// use redysim_runtime::integrate::{Adaptive, Ndf};
///
/// let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
/// let end = Adaptive::<f64, Ndf<2>>::new().rtol(1e-6).integrate(&mut oscillator, (0.0, 2.0), [1.0, 0.0])?;
/// assert!((end.y[0] - 2.0_f64.cos()).abs() < 1e-3);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Ndf<const MAX_ORDER: usize = HIGHEST_ORDER> {}

/// The backward differentiation formulas of C. W. Gear of orders 1 to `MAX_ORDER`, at most 5: κ = 0, MATLAB's option
/// `BDF`. Their errors are larger than those of [`Ndf`] at orders 1 to 4, and at orders 3 and 4 they are a little more
/// stable.
///
/// ```
/// use redysim_runtime::Integrator;
/// use redysim_runtime::integrate::{Adaptive, Bdf};
///
/// let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -1e3 * (y[0] - 1.0);
/// let end = Adaptive::<f64, Bdf>::new().integrate(&mut decay, (0.0, 1.0), [0.0])?;
/// assert!((end.y[0] - 1.0).abs() < 1e-3);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Bdf<const MAX_ORDER: usize = HIGHEST_ORDER> {}

/// The first of `kappas`, one for each order. That there are so many is checked at compile time.
const fn up_to<const MAX_ORDER: usize>(kappas: &'static [f64; HIGHEST_ORDER]) -> &'static [f64] {
    const { assert!(1 <= MAX_ORDER && MAX_ORDER <= HIGHEST_ORDER, "there are formulas of orders 1 to 5") }
    kappas.split_at(MAX_ORDER).0
}

macro_rules! method {
    ($name:ident, $kappas:ident) => {
        impl<const MAX_ORDER: usize> EstimatesErrors for $name<MAX_ORDER> {
            type Control<S: Real, Y: Vector<S>> = VariableOrder;

            fn control<S: Real, Y: Vector<S>>() -> VariableOrder {
                VariableOrder
            }
        }

        impl<const MAX_ORDER: usize> Algorithm for $name<MAX_ORDER> {
            type Formula<S: Real, Y: Vector<S>> = NdfFormula<S, Y>;

            fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
                integration: &mut Integration<'_, S, Y, O>,
            ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
                NdfFormula::new(const { up_to::<MAX_ORDER>(&$kappas) }, integration)
            }
        }
    };
}

method!(Ndf, NUMERICAL_DIFFERENTIATION);
method!(Bdf, BACKWARD_DIFFERENTIATION);
