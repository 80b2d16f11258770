//! From a checked model to Rust code made for it.
//!
//! Before anything is traced, the robot is described in the way that costs least: frames, inertias and units are chosen
//! anew where the values stay the same ([`passes::Passes`] lists what is done and switches it).
//!
//! The recursions of [`redysim_model::denoc`] run once with a [symbol](symbol::Symbol) for a scalar. What they leave
//! behind is a [graph](graph::Graph) of the operations that this one mechanism needs: zeros, ones and constants are
//! folded as they arise, equal values are one node, and [passes] over the graph collect what is left. The graph is then
//! written out as Rust over `S: Scalar`, in blocks that a compiler can take.
//!
//! A [scene](redysim_model::Scene) asks for less: for some of the functions only, or for joint forces that may be wrong
//! by a tolerance, for which terms are left out that do not matter within the ranges of the joints.
//!
//! ```
//! use redysim_codegen::source_file;
//! use redysim_model::Model;
//!
//! let pendulum = r#"
//!     name = "pendulum"
//!     gravity = [0.0, -9.81, 0.0]
//!
//!     [[link]]
//!     name = "rod"
//!     parent = "base"
//!     joint = "revolute"
//!     axis = [0.0, 0.0, 1.0]
//!     mass = 2.0
//!     com = [0.5, 0.0, 0.0]
//! "#;
//! let model = Model::from_toml(pendulum, "pendulum.toml")?.model;
//! let source = source_file(&model, "Pendulum")?;
//! assert!(source.contains("let [cos_rod] = *cos;"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod accuracy;
mod angles;
pub mod expressions;
pub mod functions;
pub mod graph;
pub mod passes;
pub mod symbol;

mod backend;
mod forward_dynamics;
mod generate;
mod policies;
mod program;
mod pruning;
mod random;
mod reroll;
mod tracing;
mod trees;

#[cfg(feature = "source")]
pub use backend::rust::source::{SourceError, source_file, source_file_with};
pub use backend::rust::stub;
pub use generate::{Counted, Generated, implementation, implementation_with, operations};
pub use pruning::Pruning;
