//! The dynamics of serial, tree-type and closed-loop mechanisms, made at compile time for the one mechanism you have.
//!
//! A model in TOML becomes a type by [`redysim!`] (or `#[derive(Mechanism)]`), checked while the program compiles. Its
//! functions are the DeNOC recursions made for that topology: no `std`, no allocation, no panics.
//!
//! ```
//! use redysim::redysim;
//!
//! redysim! {
//!     /// The KUKA KR5 of the ReDySim paper.
//!     pub struct Kr5("models/kr5.toml");
//! }
//!
//! let (q, v) = ([0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [1.0; Kr5::NV]);
//! let torques = Kr5::bias_forces(&q, &v);
//! let accelerations: [f64; 6] = Kr5::forward_dynamics(&q, &v, &torques);
//! assert!(accelerations.iter().all(|acceleration| acceleration.abs() < 1e-9));
//! assert!(Kr5::OPS.inverse_dynamics.flops() <= 450);
//! ```
//!
//! A program over the traits takes compiled types and, with the feature `generic`, models read at run time alike:
//!
//! ```
//! # #[cfg(feature = "generic")] {
//! use redysim::generic::{GenericMechanism, Model};
//! use redysim::{GravityForces, Mechanism, redysim};
//!
//! redysim! { struct Gripper("models/gripper.toml"); }
//!
//! /// The largest joint force that gravity asks for at this pose.
//! fn largest<M: GravityForces<f64>>(mechanism: &M, q: &M::Coordinates) -> f64 {
//!     mechanism.gravity_forces(q).as_ref().iter().fold(0.0, |largest, force| force.abs().max(largest))
//! }
//!
//! let model = Model::load(concat!(env!("CARGO_MANIFEST_DIR"), "/models/gripper.toml"))?.model;
//! let (compiled, generic) = (largest(&Gripper, &[0.3; 4]), largest(&GenericMechanism::new(model), &vec![0.3; 4]));
//! assert!((compiled - generic).abs() < 1e-15);
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! With the feature `std`, many states are computed on all cores, several at a time in vector lanes, by the best
//! instructions that the processor has, whatever the program is compiled for:
//!
//! ```
//! # #[cfg(feature = "std")] {
//! use redysim::{Dispatch, InverseDynamics, batch, redysim};
//!
//! redysim! { struct Kr5("models/kr5.toml"); }
//!
//! // The torques of a thousand samples of a motion.
//! let [q, v, a] = [0.1, 0.2, 0.3].map(|scale| (0..1000).map(|i| [scale * f64::from(i); 6]).collect::<Vec<_>>());
//! let mut torques = vec![[0.0; 6]; q.len()];
//! batch::inverse_dynamics(&Kr5, &q, &v, &a, &mut torques)?;
//! // One state by the same instructions.
//! let kr5 = Kr5.dispatched();
//! assert_eq!(torques[500], kr5.inverse_dynamics(&q[500], &v[500], &a[500]));
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The same lanes can be used without `std`: [`lanes::F64x8`] and its like are scalars, so that
//! `Kr5::inverse_dynamics` of `[F64x8; 6]` works on eight states.
//!
//! Where to look: [`Mechanism`](trait@Mechanism) and the traits beside it for what a mechanism can do; [`Ode45`] and
//! [`Ode5`], and for stiff equations [`Ode15s`], with [`ForwardSimulation`] for motion in time; [`TorqueLaw`] and
//! [`Trajectory`] for what drives it; [`ClosedLoop`] for mechanisms with loops.
//!
//! # Features
//!
//! - `generic` (on by default): [`generic`]; brings `std`.
//! - `std`: [`batch`], [`Dispatched`], and a fused multiply-add that is quicker to compile. Without it the crate is
//!   `no_std`.
//! - `nalgebra`: [`nalgebra`](mod@nalgebra), the functions over its vectors, matrices and isometries; without `std` too.
//! - `serde`: models, results, torque laws, trajectories and integrators serialise and deserialise.
//! - `deterministic`: the same bits on every target. Without it products and sums are fused where the target can (see
//!   [`FUSED`]), so that a program compiled with `-C target-cpu=native` may differ from one that is not in the
//!   last places; within one program, lanes and plain numbers agree to the bit either way, and so do batches and
//!   [`Dispatched`] mechanisms, which fuse where the processor can.
#![no_std]
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

/// The runtime under the path by which generated code finds it. Its items are those of this crate.
#[doc(hidden)]
pub use redysim_runtime as runtime;

pub use redysim_macros::{Mechanism, redysim};
pub use redysim_runtime::*;

/// The generic path: the same recursions, driven by a model that is read at run time.
#[cfg(feature = "generic")]
pub mod generic {
    pub use redysim_model::denoc::Workspace;
    pub use redysim_model::inertia::Sym3;
    pub use redysim_model::joint::{Joint, JointPhysics};
    pub use redysim_model::pseudo::PseudoInertia;
    pub use redysim_model::spatial::{Mat3, Pose, Vec3};
    pub use redysim_model::{
        AccelerationMethod, Attachment, Body, BodyFrame, CodegenOptions, Cut, CutEnd, CutKind, CutSide, Diagnostic,
        Diagnostics, Faults, Frame, GenericMechanism, Inertia, JointKind, JointRange, Link, LinkPoint, Lint, Loaded,
        LockError, Loop, Mobility, Model, MovingJoint, PerVelocity, PublicInterface, Quantity, RunTimeParameter,
        Severity, Spring, Tree,
    };
}

#[cfg(feature = "nalgebra")]
pub mod nalgebra;

/// The README's program, so that it is known to run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The programs of the guides.
#[cfg(doctest)]
mod guides {
    #[doc = include_str!("../docs/first_steps.md")]
    struct FirstSteps;
    #[doc = include_str!("../docs/own_robot.md")]
    struct OwnRobot;
    #[doc = include_str!("../docs/closed_loops.md")]
    struct ClosedLoops;
    #[doc = include_str!("../docs/controllers.md")]
    struct Controllers;
    #[doc = include_str!("../docs/frames.md")]
    struct Frames;
    #[doc = include_str!("../docs/floating_and_walking.md")]
    struct FloatingAndWalking;
    #[doc = include_str!("../docs/no_std.md")]
    struct NoStd;
}
