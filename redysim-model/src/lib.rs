//! The model of a mechanism: read from TOML, checked, and driven through the DeNOC recursions.
//!
//! ```
//! use redysim_model::{GenericMechanism, Model};
//! use redysim_runtime::{ForwardDynamics, InverseDynamics};
//!
//! let pendulum = r#"
//!     name = "pendulum"
//!     gravity = [0.0, 0.0, -9.81]
//!
//!     [[link]]
//!     name = "rod"
//!     parent = "base"
//!     joint = "revolute"
//!     axis = [0.0, 1.0, 0.0]
//!     mass = 2.0
//!     com = [0.5, 0.0, 0.0]
//! "#;
//! let pendulum = GenericMechanism::new(Model::from_toml(pendulum, "pendulum.toml")?.model);
//! let (q, v) = (vec![0.3], vec![1.2]);
//! let tau = pendulum.inverse_dynamics(&q, &v, &vec![0.7]);
//! let a: Vec<f64> = pendulum.forward_dynamics(&q, &v, &tau);
//! assert!((a[0] - 0.7).abs() < 1e-14);
//! # Ok::<(), redysim_model::Faults>(())
//! ```
//!
//! | where | what it is |
//! |---|---|
//! | [`Model`], [`Loaded`], [`Faults`] | a model file: its contents, its warnings and its errors |
//! | [`Lint`] | what a model may have, but is rarely meant |
//! | [`GenericMechanism`] | the functions of a model read at run time; without allocation in a [`denoc::Workspace`] |
//! | [`Tree`], [`joint`], [`parameter`] | the moving bodies, their joints, and numbers that may be given at run time |
//! | [`denoc`] | the recursions over a tree: RNEA, CRBA, ABA and others in the DeNOC form, for any scalar |
//! | [`frames`], [`regroup`], [`scaling`] | other descriptions of the same robot, for which the recursions cost less |
//! | [`spatial`], [`inertia`], [`pseudo`], [`rotation`] | vectors, twists, wrenches, inertias and rotations |
//! | [`RunTimeParameter`], [`Quantity`] | the numbers of a model that compiled code is given at run time |
//! | [`Mobility`], [`LockError`] | independent velocities of closed loops; joints that are locked |
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

mod assembly;
mod check;
mod cut;
pub mod denoc;
mod faults;
pub mod frames;
mod generic;
pub mod inertia;
pub mod joint;
mod lint;
mod load;
mod lock;
mod messages;
mod mobility;
mod model;
mod options;
pub mod parameter;
mod per_velocity;
pub mod pseudo;
mod public_interface;
pub mod regroup;
pub mod rotation;
mod roundoff;
mod run_time;
pub mod scaling;
mod schema;
#[cfg(feature = "serde")]
mod serde;
pub mod spatial;
mod spring;
mod tree;
mod write;

pub use faults::Faults;
pub use generic::GenericMechanism;
pub use lint::Lint;
pub use load::Loaded;
pub use lock::{JointCoordinates, LockError};
pub use mobility::Mobility;
pub use model::{CutKind, CutSide, Frame, Inertia, JointKind, JointRange, Link, LinkPoint, Loop, Mimic, Model, Spring};
pub use options::{AccelerationMethod, CodegenOptions};
pub use per_velocity::PerVelocity;
pub use public_interface::{MovingJoint, ParameterNumber, PublicInterface};
pub use redysim_runtime::{Function, Functions};
pub use redysim_toml::{Diagnostic, Diagnostics, Severity};
pub use run_time::{Quantity, RunTimeParameter};
pub use schema::{key_documentation, option_names};
pub use spring::{BodyPoint, BodySpring};
pub use tree::{Attachment, Body, BodyFrame, Cut, CutEnd, Tree};
