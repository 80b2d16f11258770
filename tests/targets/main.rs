//! What every processor computes, whatever its vectors and whether it fuses multiply and add: the generic path, single
//! states, batches and lanes agree, with each other and with references.

#[path = "../common/mod.rs"]
mod common;

#[cfg(feature = "std")]
mod batch;
mod compiled_against_generic;
mod deterministic;
mod inverse_dynamics_reference;
mod processors;
