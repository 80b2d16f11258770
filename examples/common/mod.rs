//! What the examples share: studies of any mechanism, and the reports, tables and pictures that show them.
#![allow(dead_code, reason = "each example uses a part")]

pub mod compare;
pub mod csv;
pub mod failure;
pub mod free_fall;
pub mod inverse;
pub mod loop_inverse;
pub mod loop_motion;
pub mod loop_speed;
pub mod outputs;
pub mod processor;
pub mod progress;
pub mod reference;
pub mod speed;
pub mod table;

pub use failure::{Context, Failure};
pub use outputs::Outputs;
pub use redysim_figures::{Rows, Series, column, figure, peak, plot};

/// `count` + 1 instants from 0 to `duration`, s, evenly spread.
pub fn instants(duration: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| duration * k as f64 / count as f64).collect()
}
