//! The scenarios and results of the command `redysim` as data, for programs that make scenarios, keep results, or
//! exchange both with others.
//!
//! A [`Scenario`] has the keys of a scenario file as fields, [`Results`] what is in a folder of results. Both serialise
//! and deserialise by [`serde`], can be built in Rust, are checked by the rules for files, and are written as files that
//! read back to the same bits. The command runs them: `redysim forward SCENARIO`.
//!
//! # Example
//!
//! ```
//! use redysim_cli::{Failure, Forward, Scenario, Torque};
//!
//! // A study: the shipped four-bar with several gains.
//! let scenarios = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios");
//! let shipped = Scenario::load(format!("{scenarios}/fourbar.toml"))?;
//! for kp in [10.0, 20.0, 40.0] {
//!     let torque = Torque::Pd {
//!         joints: Some(vec!["crank".into()]),
//!         target: [1.0].into(),
//!         kp: kp.into(),
//!         kd: (0.4 * kp).into(),
//!         limits: None,
//!     };
//!     let name = format!("fourbar_{kp}");
//!     let forward = Forward { torque: Some(torque), ..Forward::new(2.0, 0.01) };
//!     let study = Scenario { name: Some(name), forward: Some(forward), ..shipped.clone() };
//!     study.check(scenarios)?;
//!     let text = study.to_toml(); // to be written beside the shipped one
//!     assert_eq!(Scenario::from_toml(text, format!("{scenarios}/study.toml"))?, study);
//! }
//! # Ok::<(), Failure>(())
//! ```

// They panic if the pipe is closed; `output` does not.
#![deny(clippy::print_stdout, clippy::print_stderr)]

mod c_compiler;
mod carriers;
mod closed;
mod commands;
mod data;
mod euler_angles;
mod failure;
mod interrupt;
mod kind;
mod layout;
mod model;
mod number;
mod output;
mod page;
mod progress;
mod recorded;
mod results;
mod scenario;
mod summary;
mod sweep;
mod table;
mod text;
mod urdf;

pub use c_compiler::c_compiler;
#[doc(hidden)]
pub use commands::run;
pub use data::{
    AbsoluteTolerance, AxisGains, Compensation, Contact, FixedStep, Forward, FrameNames, Ground, Impedance, Initial,
    Integrator, Limits, Payload, Results, Scenario, Span, Stabilisation, Table, Target, Through, Tolerances, Torque,
    Trajectory, Values, interrupt_computation, page_of_results,
};
pub use failure::Failure;
pub use model::ModelFile;
pub use results::{Ending, Run};
pub use scenario::Dynamics;
pub use sweep::{Rows as SweepRows, Sample, Sampler, Study};
pub use table::Column;

/// The program of the guide to scenarios.
#[cfg(doctest)]
#[doc = include_str!("../../docs/scenarios.md")]
struct Guide;
