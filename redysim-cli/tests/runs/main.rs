//! `redysim forward` and `redysim inverse`: what is computed, which files are written, and which input is refused.

#[path = "../common/mod.rs"]
mod common;

mod again;
mod balls_in_loops;
mod contact;
mod data;
mod equations;
mod faults;
mod floating;
mod folders;
mod heavy_top;
mod in_series;
mod in_space;
mod interrupt;
mod laws;
mod limits;
mod loops;
mod motions;
mod orientations;
mod output;
mod per_velocity;
mod pipes;
mod prescribed;
mod prescribed_in_loops;
mod references;
mod results;
mod steps;
