//! The recursions of the decoupled natural orthogonal complement (DeNOC), written once for every scalar.
//!
//! With `f64` they are the generic path; with a symbolic scalar the same code leaves behind the expressions from which
//! specialised code is made. All of them walk the bodies of a [`Tree`](crate::tree::Tree): outwards (parents first) for
//! motion, inwards for forces and inertias. Vectors are in the body's own frame, moments about its origin.
//!
//! Each takes an observer, a [`Trace`]: [`Untraced`] for numbers.
//!
//! Inputs and outputs are in the model's order of joints; every function expects slices of length
//! [`Tree::nq`](crate::tree::Tree::nq) or [`Tree::nv`](crate::tree::Tree::nv).
//!
//! Source: Shah, Saha, Dutt, *Dynamics of Tree-Type Robotic Systems*, Springer 2013; Featherstone, *Rigid Body Dynamics
//! Algorithms*, Springer 2008.

mod articulated;
mod base_frame;
mod center_of_mass;
mod configuration;
mod coriolis;
mod energy;
mod evaluate;
mod factorisation;
mod forward;
mod frame;
mod hybrid;
#[cfg(debug_assertions)]
mod instances;
mod inverse;
mod kinematics;
mod loops;
mod mass_matrix;
mod mimic;
mod momentum;
mod passive;
mod rotation;
mod springs;
mod task_frames;
mod trace;
mod workspace;

pub use center_of_mass::center_of_mass;
pub use configuration::{coordinate_rates, difference, integrate, neutral};
pub use coriolis::coriolis_matrix;
pub use energy::energy;
pub use evaluate::{evaluate, evaluate_dynamics};
pub use factorisation::{EliminationOrder, Factorisation};
pub use forward::{
    Method, forward_dynamics, forward_dynamics_by_factorisation, forward_dynamics_by_recursion, forward_dynamics_in,
};
pub use hybrid::{hybrid_dynamics, hybrid_dynamics_by_factorisation, hybrid_dynamics_by_recursion};
pub use inverse::{bias_forces, gravity_forces, inverse_dynamics, inverse_dynamics_in};
pub use kinematics::{frame_kinematics, link_kinematics};
pub(crate) use loops::rows_that_vary;
pub use loops::{loop_bias, loop_jacobian, loop_residual};
pub use mass_matrix::{mass_matrix, mass_matrix_in};
pub use momentum::momentum;
pub use passive::{dissipated_power, passive_forces};
pub use task_frames::{frame_bias, frame_forces, frame_jacobians};
pub use trace::{Trace, Untraced};
pub use workspace::Workspace;
