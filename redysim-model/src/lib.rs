//! The model of a mechanism: read from TOML, checked, and driven through the DeNOC recursions.

mod check;
pub mod denoc;
mod diagnostic;
pub mod document;
pub mod frames;
pub mod generic;
pub mod inertia;
mod load;
mod lock;
mod mobility;
pub mod model;
pub mod pseudo;
pub mod regroup;
pub mod rotation;
pub mod scaling;
pub mod scene;
mod schema;
pub mod spatial;
pub mod tree;
mod units;

pub use diagnostic::{Diagnostic, Faults, Severity};
pub use generic::GenericMechanism;
pub use load::Loaded;
pub use lock::LockError;
pub use mobility::Mobility;
pub use model::{CutKind, CutSide, Inertia, JointKind, JointRange, Link, Loop, Model, Outline};
pub use scene::{AccelerationMethod, Functions, Scene, UnknownFunction};
pub use tree::Tree;
