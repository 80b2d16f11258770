//! Axes whose ends and ticks are round numbers.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};

/// One axis of a panel. A logarithmic one carries powers of ten: its coordinate is the exponent.
#[derive(Clone)]
pub struct Axis {
    range: Range<f64>,
    step: f64,
    logarithmic: bool,
}

impl Axis {
    /// A linear axis that holds all values, with at most about `ticks` intervals between its ticks.
    pub fn linear(values: impl Iterator<Item = f64>, ticks: usize) -> Self {
        let Range { start, end } = extent(values);
        let step = round_step((end - start) / ticks as f64);
        // A value that lies past a tick by less than one can see does not open one more interval.
        let slack = 1e-3;
        let range = step * (start / step + slack).floor()..step * (end / step - slack).ceil();
        Axis { range, step, logarithmic: false }
    }

    /// A logarithmic axis for decimal logarithms of values.
    pub fn logarithmic(exponents: impl Iterator<Item = f64>, ticks: usize) -> Self {
        let Range { start, end } = extent(exponents);
        let step = ((end - start) / ticks as f64).ceil().max(1.0);
        Axis { range: step * (start / step).floor()..step * (end / step).ceil(), step, logarithmic: true }
    }

    /// First and last coordinate.
    pub fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// Whether a coordinate can stand on an axis: it is a number, and so are the differences to others.
pub fn drawable(value: f64) -> bool {
    value.abs() < 1e300
}

/// The range of the values, widened where it is empty.
fn extent(values: impl Iterator<Item = f64>) -> Range<f64> {
    let range = values.filter(|value| drawable(*value)).fold(None, |range: Option<Range<f64>>, value| {
        Some(range.map_or(value..value, |range| range.start.min(value)..range.end.max(value)))
    });
    match range {
        None => 0.0..1.0,
        Some(Range { start, end }) if end - start > (1e-12 * start.abs().max(end.abs())).max(1e-290) => start..end,
        Some(Range { start, .. }) => start - 1.0..start + 1.0,
    }
}

/// The smallest of 1, 2, 5, 10, 20, … (or 0.1, 0.2, …) that is at least `step`.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let digit = [1.0, 2.0, 5.0].into_iter().find(|digit| digit * power >= step * (1.0 - 1e-9));
    digit.unwrap_or(10.0) * power
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let part = (value - self.range.start) / (self.range.end - self.range.start);
        limit.0 + (part * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        let intervals = ((self.range.end - self.range.start) / self.step).round() as usize;
        (0..=intervals).map(|k| self.range.start + k as f64 * self.step).collect()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        if self.logarithmic {
            return format!("10{}", superscript(value.round() as i32));
        }
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        let rounded = (value / self.step).round() * self.step + 0.0;
        format!("{rounded:.decimals$}").replace('-', "−")
    }
}

fn superscript(number: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or('⁰'),
    };
    number.to_string().chars().map(digit).collect()
}
