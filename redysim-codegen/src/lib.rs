//! The code generator of redysim: from a checked model to Rust or C code made for it.
//!
//! 1. The robot is described in the way that costs least: the choice of frames, inertias and units does not change the
//!    values of its functions.
//! 2. The recursions of [`redysim_model::denoc`] run once with a [symbol](symbol::Symbol) as scalar. The result is a
//!    [graph](graph::Graph) of the operations that this mechanism needs: operations on zeros, ones and constants are
//!    folded, and equal values are one node.
//! 3. [Passes](passes) over the graph simplify it. With a tolerance, terms that do not matter within the ranges of the
//!    joints are [pruned](Pruning).
//! 4. The graph becomes a program of statements, with loops over uniform bodies where it is long. A backend prints the
//!    programs of a mechanism: as Rust over `S: Scalar`, or as C.
//!
//! [Options](redysim_model::CodegenOptions) select functions, a tolerance, and the algorithm for forward dynamics.
//!
//! | to get | use |
//! |---|---|
//! | a source file | [`source_file`], [`source_file_with`] (feature `source`, on by default) |
//! | the same in C | [`c_files`] (feature `source`) |
//! | with functions of many states, in the lanes of vectors | [`c_library`] (feature `source`) |
//! | with a header for C++ and a package of CMake | [`cpp_files`] (feature `source`) |
//! | with a gateway for MATLAB and Octave | [`mex_files`] (feature `source`) |
//! | as a functional mock-up unit | [`fmu_files`] (feature `source`) |
//! | the tokens of a mechanism's `impl`s | [`implementation`], [`implementation_with`], [`stub`] |
//! | operation counts alone | [`operations`] |
//! | the expressions of functions | [`functions::trace`], [`functions::trace_model`] |
//! | the loss of digits of a function | [`accuracy::Reference`] |
//! | what a pass saves | [`passes::Passes`] |
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
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod accuracy;
mod angles;
pub mod expressions;
pub mod functions;
pub mod graph;
pub mod passes;
pub mod symbol;

mod backend;
mod documentation;
mod forward_dynamics;
mod generate;
mod lumping;
mod mechanism;
mod policies;
mod program;
mod pruning;
mod random;
mod reroll;
mod siblings;
mod tracing;
mod trees;

#[cfg(feature = "source")]
pub use backend::c::{
    CFiles, CLibrary, COptions, CScalar, CppFiles, FmiVersion, FmuFiles, MexFiles, c_files, c_library, cpp_files,
    fmu_files, mex_files,
};
#[cfg(feature = "source")]
pub use backend::head::model_hash;
#[cfg(feature = "source")]
pub use backend::rust::source::{SourceError, source_file, source_file_with};
pub use backend::rust::{TypeTokens, stub};
pub use generate::{Counted, Generated, implementation, implementation_with, operations};
pub use pruning::Pruning;
