//! The functions of a tree, compiled, generic and as expressions: against other formulations and other programs, by the
//! identities of dynamics, and to how many digits.

#[path = "../common/mod.rs"]
mod common;
#[path = "../common/robots.rs"]
mod robots;

mod digits;
mod frames;
mod gaits;
mod helical;
mod hybrid;
mod identities;
mod ill_conditioned;
mod joint_physics;
mod link_kinematics_identities;
mod locked;
mod locked_in_space;
mod long_functions;
mod mimic;
mod parameters;
mod peer_trees;
mod physics_in_space;
mod placement;
mod positions;
mod random_trees;
#[cfg(feature = "generic")]
mod redysim_examples;
mod roundings;
mod series_joints;
mod space_joints;
mod springs;
