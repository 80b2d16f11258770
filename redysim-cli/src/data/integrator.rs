//! Integrators and their settings.

use serde::{Deserialize, Serialize};

/// An integrator, by the name of its method in `redysim_runtime`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method")]
pub enum Integrator {
    /// Symplectic, of order 1.
    SemiImplicitEuler(FixedStep),
    /// Runge and Kutta's, of order 4.
    Ode4(FixedStep),
    /// Dormand and Prince's, of order 5.
    Ode5(FixedStep),
    /// Dormand and Prince's, of order 8.
    Dop8(FixedStep),
    /// Gauss's, of order 4.
    Gauss4(FixedStep),
    /// Gauss's, of order 6.
    Gauss6(FixedStep),
    /// Dormand and Prince's pair of orders 5 and 4.
    Ode45(Tolerances),
    /// Dormand and Prince's of order 8 with estimates of orders 5 and 3.
    Dop853(Tolerances),
    /// Differentiation formulas of orders 1 to 5, for stiff equations.
    Ode15s(Tolerances),
    /// Radau's IIA method of order 5, for stiff equations.
    Radau5(Tolerances),
}

/// The setting of a method with steps of one size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FixedStep {
    /// The step of the integration, s.
    pub step: f64,
}

/// The settings of a method that chooses its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerances {
    /// The relative tolerance; by default 1e-3.
    pub rtol: Option<f64>,
    /// The absolute tolerance, in the units of the state; by default 1e-6.
    pub atol: Option<AbsoluteTolerance>,
    /// The largest step, s; by default a tenth of the run.
    pub max_step: Option<f64>,
}

/// An absolute tolerance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "expected a number, or numbers under the keys position, velocity and work"
)]
pub enum AbsoluteTolerance {
    /// One number for all components of the state.
    Uniform(f64),
    /// One for each quantity; by default 1e-6.
    Each {
        /// Of coordinates, rad or m.
        position: Option<f64>,
        /// Of velocities, rad/s or m/s.
        velocity: Option<f64>,
        /// Of the actuators' work, J, and of integral actions, N m or N.
        work: Option<f64>,
    },
}
