//! Trees in motion, free and under control, against references, closed forms and the balance of energy.

#[path = "../common/mod.rs"]
mod common;

mod attitude_control;
mod chaotic_pendulums;
mod contact;
mod extremes;
mod free_bodies;
mod free_fall_reference;
mod heavy_top;
mod hybrid;
mod iftomm_pendulum;
mod impedance;
mod nodding_tops;
mod stiff_control;
mod tangent_errors;
mod trajectories_in_space;
mod turning_over;
