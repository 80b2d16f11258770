//! Closed loops: their functions, their closing from a guess, and their motion, inverse dynamics and control, against
//! references and other formulations.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/linkages.rs"]
mod linkages;

mod assembly;
mod balls;
mod benchmarks;
mod control;
mod cut_kinds;
mod frames;
mod functions;
mod hybrid;
mod inverse;
mod massless_links;
mod mechanisms;
mod mimic;
mod motion;
mod own_closure;
mod random_trees;
mod redundant;
