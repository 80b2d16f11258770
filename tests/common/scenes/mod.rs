//! Motions on which integrators are judged, of tests and of `examples/accuracy_vs_speed.rs`.
#![allow(dead_code, reason = "each program uses a part")]

pub mod extrapolation;
pub mod floating;
pub mod heavy_top;
pub mod trot;
