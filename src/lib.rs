//! # redysim
//!
//! The dynamics of serial and tree-type mechanisms, made at compile time for the one mechanism you have.
#![no_std]

/// The runtime that compiled mechanisms stand on: scalars, traits, integrators, trajectories, torque laws.
pub use redysim_runtime as runtime;

pub use redysim_macros::{Mechanism, redysim};
pub use redysim_runtime::*;

/// The generic path: the same recursions, driven by a model that is read at run time.
#[cfg(feature = "generic")]
pub mod generic {
    pub use redysim_model::{Diagnostic, Faults, GenericMechanism, Loaded, Model, Severity};
}
