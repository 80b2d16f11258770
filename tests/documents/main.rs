//! The figures that the README and `docs/` state are those of the runs that they tell of, and the crates have the metadata
//! that their publication needs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/documented.rs"]
mod documented;
#[cfg(feature = "generic")]
#[path = "../common/scenes/mod.rs"]
mod scenes;

mod accuracy;
mod benchmarks;
mod ci;
mod counts;
mod figures;
mod floating_and_walking;
mod heavy_top;
mod index;
mod packages;
