//! The model of a mechanism: read from TOML, checked, and driven through the DeNOC recursions.

mod assembly;
mod check;
pub mod denoc;
mod faults;
pub mod frames;
pub mod generic;
pub mod inertia;
pub mod joint;
mod load;
mod lock;
mod messages;
mod mobility;
pub mod model;
mod options;
pub mod parameter;
pub mod pseudo;
mod public_interface;
pub mod regroup;
pub mod rotation;
mod roundoff;
pub mod scaling;
mod schema;
pub mod spatial;
pub mod tree;

pub use faults::Faults;
pub use generic::GenericMechanism;
pub use load::Loaded;
pub use lock::LockError;
pub use mobility::Mobility;
pub use model::{CutKind, CutSide, Inertia, JointKind, JointRange, Link, Loop, Model};
pub use options::{AccelerationMethod, CodegenOptions};
pub use public_interface::PublicInterface;
pub use redysim_runtime::{Function, Functions};
pub use redysim_toml::{Diagnostic, Diagnostics, Severity};
pub use schema::key_documentation;
pub use tree::Tree;
