//! What is generated for a model: with which options, at what cost, by which passes, and within which tolerance.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/linkages.rs"]
mod linkages;

mod derive;
mod generated;
mod no_more_than_needed;
mod operation_counts;
mod options;
mod passes;
mod tolerance;
