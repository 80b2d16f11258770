//! What every processor computes, whatever its vectors and whether it fuses multiply and add: the generic path, single
//! states, batches and lanes agree, with each other and with references.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/robots.rs"]
mod robots;

/// Whether these tests are compiled for the processor at hand, as by `.ci/run`: then they take all cases.
const NATIVE: bool = cfg!(any(target_feature = "fma", not(target_arch = "x86_64")));

#[cfg(feature = "std")]
mod batch;
mod c;
mod compiled_against_generic;
mod deterministic;
mod inverse_dynamics_reference;
mod processors;
mod robots_in_space;
