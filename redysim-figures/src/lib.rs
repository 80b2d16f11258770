//! Pictures of what mechanisms do: a [`Figure`](figure::Figure) says what is to be seen, [`plot::svg`] draws it, and
//! `png::png` (feature `png`) does so in pixels.
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

mod axis;
pub mod figure;
mod legend;
mod multiples;
pub mod plot;
#[cfg(feature = "png")]
pub mod png;
mod text;

use std::fmt;

/// A value for every joint at every instant of a run: `rows[instant][joint]`.
pub type Rows = Vec<Vec<f64>>;

/// A named run or reference, to be drawn or compared.
#[derive(Clone, Copy, Debug)]
pub struct Series<'a> {
    /// As a legend shows it.
    pub name: &'a str,
    /// The instants, s, in order.
    pub t: &'a [f64],
    /// What is at these instants.
    pub rows: &'a Rows,
}

/// One joint's values over time.
pub fn column(rows: &[Vec<f64>], joint: usize) -> Vec<f64> {
    rows.iter().map(|row| row[joint]).collect()
}

/// The largest magnitude; NaN counts as infinite, so that it is not overlooked.
pub fn peak(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |peak, value| if value.is_nan() { f64::INFINITY } else { value.abs().max(peak) })
}

/// Why a figure cannot be drawn.
#[derive(Debug)]
pub struct DrawingError(String);

impl DrawingError {
    fn new(cause: impl fmt::Display) -> Self {
        DrawingError(cause.to_string())
    }
}

impl fmt::Display for DrawingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot draw the picture: {}", self.0)
    }
}

impl std::error::Error for DrawingError {}
