//! How large the steps of a method may be before its own errors grow: known before an integration runs.
//!
//! Near a state an equation behaves as its Jacobian does, and a method with a fixed step h is stable where it damps
//! every eigenvalue λ of it: for a Runge-Kutta method where |R(h λ)| ≤ 1, with the [`StabilityFunction`] R. A gain of a
//! controller moves an eigenvalue as far to the left as it is large, which is why stiff joints ask for small steps.

mod eigenvalues;
mod largest_step;
mod participation;
mod polynomial;
mod warning;

pub use largest_step::{LinearStability, StabilityLimit};
pub use polynomial::StabilityFunction;
pub use warning::StepWarning;

use crate::integrate::complex::Complex;
use eigenvalues::{Row, eigenvalues, matrix};

use super::implicit::jacobian::jacobian;
use super::integration::{Integration, zeros};
use super::tolerance::Tolerances;
use super::{FixedStep, IntegrationError, Ode};
use crate::vector::entry;
use crate::{Real, Vector};

/// The largest stable step of a method, and what limits it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StableStep<S> {
    /// The largest size of a step whose errors do not grow, s; infinite if nothing in the equation is damped or swings.
    pub step: S,
    /// Real and imaginary part of the eigenvalue of the Jacobian that limits it, 1/s.
    pub eigenvalue: (S, S),
    /// The component of the state that takes part most in the mode of that eigenvalue; of a mechanical system, the one
    /// of the velocities. `None` where nothing limits the step or no component stands out.
    pub component: Option<usize>,
    /// The same component counted from the first velocity, as in
    /// [`Mechanism::velocity_name`](crate::Mechanism::velocity_name), if the equation has coordinates.
    pub velocity: Option<usize>,
}

/// The Jacobian of an equation in a state, along its [tangent space](Ode::project_onto_tangent).
pub struct Linearised<S: Real, Y: Vector<S>> {
    pub(super) rows: Y::Of<Y>,
    pub(super) eigenvalues: Row<S, Y>,
    pub(super) coordinates: usize,
}

impl<S: Real, Y: Vector<S>> Linearised<S, Y> {
    /// Linearises about the state of `integration`, where the derivative is `rate`.
    pub(super) fn new<O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
        rate: &Y,
    ) -> Result<Self, IntegrationError<S>> {
        let len = rate.as_ref().len();
        let mut rows = Y::Of::<Y>::from_fn(len, |_| zeros(rate));
        jacobian(integration, rate, &mut rows)?;
        let Integration { ode, progress, .. } = integration;
        let coordinates = ode.coordinate_rates(progress.t, &progress.y, &mut zeros(rate));
        let mut this = Self { rows, eigenvalues: Row::<S, Y>::from_fn(len, |_| Complex::default()), coordinates };
        this.eigenvalues = eigenvalues::<S, Y>(matrix::<S, Y>(len, |i, j| this.element(i, j)))
            .ok_or(IntegrationError::NoEigenvalues { t: progress.t })?;
        Ok(this)
    }

    /// The eigenvalues that do not grow, each pair of conjugates once. One that swings and grows is taken as if it only
    /// swung.
    pub(super) fn damped(&self) -> impl Iterator<Item = (S, S)> + '_ {
        let values = self.eigenvalues.as_ref().iter().map(|value| {
            // Real to within rounding is real.
            let is_real = value.im.abs() <= S::EPSILON.sqrt() * value.re.abs();
            (value.re.minimum(S::zero()), if is_real { S::zero() } else { value.im })
        });
        // Of a pair the one above the axis is enough.
        values.filter(|&(re, im)| im >= S::zero() && (re < S::zero() || im > S::zero()))
    }

    /// The largest real part of an eigenvalue, if it is positive.
    pub(super) fn growth(&self) -> S {
        self.eigenvalues.as_ref().iter().fold(S::zero(), |growth, value| growth.maximum(value.re))
    }

    /// Element (i, j) of (∂f/∂y) P, with the projection P onto the tangent space.
    pub(super) fn element(&self, i: usize, j: usize) -> S {
        self.rows.as_ref().get(i).map_or(S::zero(), |row| entry(row, j))
    }
}

/// Estimates the largest stable step of `method` for an equation, in the state `y` at `t`, before it runs.
///
/// All eigenvalues of the Jacobian along the [tangent space](Ode::project_onto_tangent) count, also those of undamped
/// oscillations: of two that differ in size the smaller one may limit the step. A mode that grows does not limit the step,
/// since the equation and not the method makes it grow; if it also oscillates, it counts as an undamped oscillation. The
/// result holds near `y`: where inertia or gains change along the motion, evaluate several states. It costs one
/// [tangent](Ode::tangent) or evaluation for each component, and about 25 n³ operations.
///
/// # Errors
/// If the state, its derivative or the Jacobian is infinite or not a number, if the method needs coordinates and the
/// equation does not define them, or if no eigenvalues are found.
///
/// ```
/// use redysim_runtime::Ode4;
/// use redysim_runtime::integrate::stability::largest_stable_step;
///
/// // A spring of 10⁴ N/m, a damper of 250 Ns/m and 1 kg: the eigenvalues are −50 and −200.
/// let mut damped = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -1e4 * y[0] - 250.0 * y[1]];
/// let stable = largest_stable_step(&mut damped, 0.0, &[0.1, 0.0], &Ode4::new(1e-3))?;
/// assert!((stable.step - 2.785 / 200.0).abs() < 1e-5);
/// assert!((stable.eigenvalue.0 + 200.0).abs() < 1e-3);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub fn largest_stable_step<S: Real, Y: Vector<S>, M: LinearStability>(
    ode: &mut (impl Ode<S, Y> + ?Sized),
    t: S,
    y: &Y,
    method: &FixedStep<S, M>,
) -> Result<StableStep<S>, IntegrationError<S>> {
    let _ = method;
    // Differences, where they are needed, are those of components of size 1.
    let unit = Tolerances::new(S::one(), S::one());
    let mut integration = Integration::new(ode, unit, t, y.clone())?;
    let mut rate = zeros(y);
    integration.evaluate(t, &mut rate)?;
    let linearised = Linearised::<S, Y>::new(&mut integration, &rate)?;
    let StabilityLimit { step, eigenvalue: limiting } = M::largest_step(&linearised)?;
    let coordinates = linearised.coordinates;
    let component = limiting.and_then(|(re, im)| {
        participation::dominant_component::<S, Y>(&linearised.rows, Complex { re, im }, coordinates)
    });
    let velocity = component.filter(|_| coordinates > 0).and_then(|component| component.checked_sub(coordinates));
    Ok(StableStep { step, eigenvalue: limiting.unwrap_or_default(), component, velocity })
}

/// The spectral radius of the matrix with the given elements; `None` if it is not found.
fn spectral_radius<S: Real, Y: Vector<S>>(len: usize, element: impl FnMut(usize, usize) -> S) -> Option<S> {
    let values = eigenvalues::<S, Y>(matrix::<S, Y>(len, element))?;
    Some(values.as_ref().iter().fold(S::zero(), |largest, value| largest.maximum(value.abs())))
}
