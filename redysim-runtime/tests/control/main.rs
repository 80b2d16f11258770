//! Mechanisms in motion and under control, and the arithmetic that they are computed with.

#[macro_use]
#[path = "../mechanisms/mod.rs"]
mod mechanisms;
#[path = "../slider_crank/mod.rs"]
mod slider_crank;

mod alloc;
mod attitude;
mod closed_loop_coordinates;
mod closed_loop_hybrid;
mod contact;
mod control;
mod coordinate_rates;
mod dual;
mod lanes;
mod operational_space;
mod pid;
mod simulation;
mod trajectory;
mod trigonometry;
mod via_points;
