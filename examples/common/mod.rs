//! What the examples share: studies of any mechanism, and the reports, tables and pictures that show them.
#![allow(dead_code, reason = "each example uses a part")]

pub mod axis;
pub mod compare;
pub mod csv;
pub mod failure;
pub mod figure;
pub mod free_fall;
pub mod inverse;
pub mod loop_inverse;
pub mod loop_motion;
pub mod loop_speed;
pub mod outputs;
pub mod plot;
pub mod progress;
pub mod reference;
pub mod speed;
pub mod table;

pub use failure::{Context, Failure};
pub use outputs::Outputs;

/// A value for every joint at every instant of a run: `rows[instant][joint]`.
pub type Rows = Vec<Vec<f64>>;

/// A named run or reference, to be drawn or compared.
#[derive(Clone, Copy)]
pub struct Series<'a> {
    pub name: &'a str,
    /// The instants, s, in order.
    pub t: &'a [f64],
    pub rows: &'a Rows,
}

/// `count` + 1 instants from 0 to `duration`, s, evenly spread.
pub fn instants(duration: f64, count: usize) -> Vec<f64> {
    (0..=count).map(|k| duration * k as f64 / count as f64).collect()
}

/// One joint's values over time.
pub fn column(rows: &[Vec<f64>], joint: usize) -> Vec<f64> {
    rows.iter().map(|row| row[joint]).collect()
}

/// The largest magnitude; what is no number counts as infinite, so that it cannot hide.
pub fn peak(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |peak, value| if value.is_nan() { f64::INFINITY } else { value.abs().max(peak) })
}
