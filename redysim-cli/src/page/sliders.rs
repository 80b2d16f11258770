//! The coordinates of a model that whoever looks at it moves.

use std::f64::consts::{PI, TAU};

use nalgebra::UnitQuaternion;
use redysim_model::joint::LinkJoint;
use redysim_model::{GenericMechanism, JointKind, Link, Model};
use serde::Serialize;

use super::bodies::{self, Orientations};
use crate::closed::closed_position;
use crate::layout::{Component, Layout, Measure};

/// A coordinate on the page, and within what it is moved.
#[derive(Clone, Debug, Serialize)]
pub struct Slider {
    /// What the coordinate is called.
    #[serde(skip)]
    pub name: String,
    unit: &'static str,
    limits: Limits,
    /// rad or m.
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

/// The angles in the place of a quaternion.
const ANGLES: [&str; 3] = ["roll", "pitch", "yaw"];

/// A slider for each coordinate of a model, with angles in the place of quaternions; and that its loops do not close, if
/// so.
pub fn of(model: &Model, layout: &Layout) -> (Vec<Slider>, Option<String>) {
    let reach = bodies::reach(&bodies::of(model, layout, Orientations::Rpy));
    let moving: Vec<&Link> = model.moving_links().collect();
    let slider = |(index, coordinate): (usize, &Component)| {
        let link = moving[coordinate.joint];
        // The velocities of a joint with a quaternion are not the rates of its coordinates.
        let is_linear = LinkJoint::of(link).is_some_and(LinkJoint::is_linear);
        let (kind, range) = (link.joint, link.range.get(index).filter(|_| is_linear));
        let (limits, least, largest) = match (range, coordinate.measure) {
            (Some(range), _) => (Limits::Range, range.position[0], range.position[1]),
            (None, Measure::Angle) if kind == JointKind::Revolute => (Limits::Turn, -PI, PI),
            (None, Measure::Angle | Measure::Number) => (Limits::Size, -PI, PI),
            (None, Measure::Length) => (Limits::Size, -reach, reach),
        };
        let start = coordinate.neutral.max(least).min(largest);
        Slider { name: coordinate.name.clone(), unit: coordinate.unit(), limits, least, largest, start }
    };
    let mut sliders: Vec<Slider> = Vec::new();
    let mut start = Vec::new();
    for joint in &layout.joints {
        let own = &layout.coordinates[joint.q.clone()];
        let (plain, turned) = own.split_at(own.len() - joint.orientation().len());
        sliders.extend(plain.iter().enumerate().map(slider));
        start.extend(sliders[sliders.len() - plain.len()..].iter().map(|slider| slider.start));
        start.extend(turned.iter().map(|coordinate| coordinate.neutral));
        if joint.is_in_space() {
            let angle = |name| Slider {
                name: format!("{}.{name}", joint.name),
                unit: Measure::Angle.unit(),
                limits: Limits::Turn,
                least: -PI,
                largest: PI,
                start: 0.0,
            };
            sliders.extend(ANGLES.map(angle));
        }
    }
    if model.loops.is_empty() {
        return (sliders, None);
    }
    let mechanism = GenericMechanism::new(model.clone());
    match closed_position(&mechanism, start) {
        Ok(q) => {
            for (slider, q) in sliders.iter_mut().zip(on_sliders(layout, &q)) {
                let turns = if slider.limits == Limits::Turn { TAU * (q / TAU).round() } else { 0.0 };
                slider.start = q - turns;
            }
            (sliders, None)
        }
        Err(why) => (sliders, Some(format!("the loops are shown open: {why}"))),
    }
}

/// The values of the sliders at the coordinates `q`.
fn on_sliders(layout: &Layout, q: &[f64]) -> Vec<f64> {
    let values = layout.joints.iter().flat_map(|joint| {
        let (plain, turned) = q[joint.q.clone()].split_at(joint.q.len() - joint.orientation().len());
        let angles = <[f64; 4]>::try_from(turned).ok().map(|quaternion| {
            let (roll, pitch, yaw) = UnitQuaternion::from_quaternion(quaternion.into()).euler_angles();
            [roll, pitch, yaw]
        });
        plain.iter().copied().chain(angles.into_iter().flatten()).collect::<Vec<f64>>()
    });
    values.collect()
}
