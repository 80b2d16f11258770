//! The coordinates of a model that whoever looks at it moves.

use std::f64::consts::{PI, TAU};

use redysim_model::{GenericMechanism, JointKind, JointRange, Model};
use serde::Serialize;

use super::bodies;
use crate::closed::closed_position;
use crate::layout::{Component, Layout, Measure};

/// A coordinate, and within what it is moved.
#[derive(Clone, Debug, Serialize)]
pub struct Slider {
    unit: &'static str,
    limits: Limits,
    /// rad, m or 1.
    least: f64,
    largest: f64,
    start: f64,
}

/// Where the ends of a slider come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Limits {
    /// The model gives a range.
    Range,
    /// It does not: the joint turns around.
    Turn,
    /// It does not: half a turn or a length of the model's size in either direction.
    Size,
}

/// A slider for each coordinate of a model; and that its loops do not close, if so.
pub fn of(model: &Model, layout: &Layout) -> (Vec<Slider>, Option<String>) {
    let reach = bodies::reach(&bodies::of(model, layout));
    let kinds: Vec<(JointKind, Option<JointRange>)> =
        model.moving_links().map(|link| (link.joint, link.range)).collect();
    let slider = |coordinate: &Component| {
        let (kind, range) = kinds[coordinate.joint];
        let (limits, least, largest) = match (range, coordinate.measure) {
            (Some(range), _) => (Limits::Range, range.position[0], range.position[1]),
            (None, Measure::Angle) if kind == JointKind::Revolute => (Limits::Turn, -PI, PI),
            (None, Measure::Angle) => (Limits::Size, -PI, PI),
            (None, Measure::Length) => (Limits::Size, -reach, reach),
            (None, Measure::Number) => (Limits::Size, -1.0, 1.0),
        };
        let start = coordinate.neutral.max(least).min(largest);
        Slider { unit: coordinate.unit(), limits, least, largest, start }
    };
    let mut sliders: Vec<Slider> = layout.coordinates.iter().map(slider).collect();
    if model.loops.is_empty() {
        return (sliders, None);
    }
    let mechanism = GenericMechanism::new(model.clone());
    let start: Vec<f64> = sliders.iter().map(|slider| slider.start).collect();
    match closed_position(&mechanism, start) {
        Ok(q) => {
            for (slider, q) in sliders.iter_mut().zip(q) {
                let turns = if slider.limits == Limits::Turn { TAU * (q / TAU).round() } else { 0.0 };
                slider.start = q - turns;
            }
            (sliders, None)
        }
        Err(why) => (sliders, Some(format!("the loops are shown open: {why}"))),
    }
}
