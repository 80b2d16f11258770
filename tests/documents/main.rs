//! The figures that the README and `docs/` state are those of the runs that they tell of, and the crates have the metadata
//! that their publication needs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/documented.rs"]
mod documented;

mod accuracy;
mod benchmarks;
mod counts;
mod figures;
mod packages;
