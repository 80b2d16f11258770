//! Axes whose ticks are round numbers.

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
    /// A linear axis from the least of the values to the largest, with at most about `ticks` intervals between ticks.
    pub fn between(values: impl Iterator<Item = f64>, ticks: usize) -> Self {
        let range = extent(values);
        let step = round_step((range.end - range.start) / ticks as f64);
        Axis { range, step, logarithmic: false }
    }

    /// The same, and a little beyond them, so that no curve lies on its end.
    pub fn around(values: impl Iterator<Item = f64>, ticks: usize) -> Self {
        let Range { start, end } = extent(values);
        let margin = 0.04 * (end - start);
        Axis::between([start - margin, end + margin].into_iter(), ticks)
    }

    /// A logarithmic axis for decimal logarithms of values.
    pub fn logarithmic(exponents: impl Iterator<Item = f64>, ticks: usize) -> Self {
        let Range { start, end } = extent(exponents);
        let step = ((end - start) / ticks as f64).ceil().max(1.0);
        Axis { range: step * (start / step).floor()..step * (end / step).ceil(), step, logarithmic: true }
    }

    /// The linear axis with as few ticks as have room for their labels on a length, of which each takes `width`.
    pub fn with_room(mut self, length: f64, width: impl Fn(&str) -> f64) -> Self {
        let Range { start, end } = self.range;
        loop {
            let labels = self.labels();
            let widest = labels.iter().map(|label| width(label)).fold(0.0, f64::max);
            if labels.len() <= 2 || widest <= length * self.step / (end - start) {
                return self;
            }
            self.step = round_step(1.5 * self.step);
        }
    }

    /// What stands at the ticks.
    pub fn labels(&self) -> Vec<String> {
        self.ticks().iter().map(|value| self.format_ext(value)).collect()
    }

    fn ticks(&self) -> Vec<f64> {
        // A tick past an end by less than one can see is there.
        let slack = 1e-6;
        let first = (self.range.start / self.step - slack).ceil();
        let last = (self.range.end / self.step + slack).floor();
        (0..=(last - first) as usize).map(|k| (first + k as f64) * self.step).collect()
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

/// The range of the values, widened where it is as good as empty.
pub fn extent(values: impl Iterator<Item = f64>) -> Range<f64> {
    let range = values.filter(|value| drawable(*value)).fold(None, |range: Option<Range<f64>>, value| {
        Some(range.map_or(value..value, |range| range.start.min(value)..range.end.max(value)))
    });
    match range {
        None => 0.0..1.0,
        Some(Range { start, end }) if end - start > (1e-12 * start.abs().max(end.abs())).max(1e-290) => start..end,
        Some(Range { start, end }) => {
            let middle = start + (end - start) / 2.0;
            // To a large value one adds nothing.
            let half = (1e-9 * middle.abs()).max(1.0);
            middle - half..middle + half
        }
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
        self.ticks()
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
        let exponent = self.step.log10().floor() as i32;
        let rounded = (value / self.step).round() * self.step + 0.0;
        let power = 10_f64.powi(exponent);
        let label = match exponent {
            -5..=5 => format!("{rounded:.*}", (-exponent).max(0) as usize),
            _ if rounded == 0.0 => "0".to_owned(),
            _ => format!("{}·10{}", (rounded / power).round(), superscript(exponent)),
        };
        label.replace('-', "−")
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

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(values: &[f64]) -> Vec<String> {
        Axis::around(values.iter().copied(), 5).labels()
    }

    fn between(values: &[f64]) -> Vec<String> {
        Axis::between(values.iter().copied(), 5).labels()
    }

    #[test]
    fn steps_are_1_2_or_5_times_a_power_of_ten() {
        for (step, round) in [(1.0, 1.0), (1.1, 2.0), (2.1, 5.0), (5.1, 10.0), (0.03, 0.05), (7e5, 1e6), (2e-7, 2e-7)] {
            assert!((round_step(step) / round - 1.0).abs() < 1e-12, "{step}: {}", round_step(step));
        }
    }

    #[test]
    fn ticks_are_round_and_between_the_ends() {
        assert_eq!(between(&[0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(between(&[-102.3, 211.0]), ["−100", "0", "100", "200"]);
        assert_eq!(between(&[0.0, 1e-3 * 0.68]), ["0.0000", "0.0002", "0.0004", "0.0006"]);
        assert_eq!(between(&[f64::NAN, 3.0, f64::INFINITY, 3.0]), ["2.0", "2.5", "3.0", "3.5", "4.0"]);
        assert_eq!(between(&[]), between(&[0.0, 1.0]));
    }

    #[test]
    fn ends_are_those_of_the_values_or_a_little_beyond() {
        assert_eq!(Axis::between([0.3, 0.0, 0.68].into_iter(), 5).range(), 0.0..0.68);
        let Range { start, end } = Axis::around([0.3, 0.0, 0.68].into_iter(), 5).range();
        assert!(-0.05 * 0.68 < start && start < 0.0 && 0.68 < end && end < 1.05 * 0.68, "{start} to {end}");
    }

    #[test]
    fn labels_of_any_length_have_the_room_they_need() {
        for values in [[0.0, 0.68], [12345.0, 12345.9], [-0.00012345, 0.00054321], [1e9, 3e9], [1e-13, 2e-13]] {
            for length in [100.0, 200.0, 300.0, 700.0] {
                let axis = Axis::between(values.into_iter(), 5).with_room(length, |label| 8.0 * label.len() as f64);
                let apart = length * axis.step / (values[1] - values[0]);
                let labels = axis.labels();
                let widest = labels.iter().map(|label| 8 * label.len()).max().unwrap_or(0);
                assert!(widest as f64 <= apart || labels.len() <= 2, "{length}: {labels:?}");
                assert!(!labels.is_empty());
            }
        }
    }

    #[test]
    fn values_that_hardly_differ_stand_within_their_axis_however_large_they_are() {
        for values in [[3.0, 3.0], [1e13, 1e13 + 5.0], [-1e13 - 5.0, -1e13], [1e17, 1e17], [-1e299, -1e299]] {
            let range = Axis::around(values.into_iter(), 5).range();
            assert!(range.start < values[0] && values[1] < range.end, "{values:?}: {range:?}");
            let labels = linear(&values);
            assert!(!labels.iter().any(|label| label.contains("NaN")), "{values:?}: {labels:?}");
            assert!(labels.windows(2).all(|pair| pair[0] != pair[1]), "{values:?}: {labels:?}");
        }
    }

    #[test]
    fn a_value_on_a_tick_is_labelled() {
        assert_eq!(between(&[0.0, 1.0 - 1e-12]), between(&[0.0, 1.0]));
        // 0.1 + 0.2 is more than 0.3.
        assert_eq!(between(&[0.1 + 0.2, 1.3]).first().map(String::as_str), Some("0.4"));
        assert_eq!(Axis::between([0.0, 0.1 + 0.2].into_iter(), 3).labels().last().map(String::as_str), Some("0.3"));
    }

    #[test]
    fn powers_of_ten_are_written_as_such() {
        let axis = Axis::logarithmic([-11.2, 2.0].into_iter(), 5);
        assert_eq!(axis.labels(), ["10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰", "10³"]);
    }

    #[test]
    fn numbers_too_long_to_be_read_are_written_in_powers_of_ten() {
        assert_eq!(linear(&[0.0, 4e9]), ["0", "1·10⁹", "2·10⁹", "3·10⁹", "4·10⁹"]);
        assert_eq!(linear(&[-2e-9, 2e-9]), ["−2·10⁻⁹", "−1·10⁻⁹", "0", "1·10⁻⁹", "2·10⁻⁹"]);
    }
}
