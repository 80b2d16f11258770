//! The looks of a mechanism, from its model: from where to where its links reach, and how they are joined.

use nalgebra::Vector3;
use redysim_model::joint::{Element, LinkJoint, Screw};
use redysim_model::spatial::{Pose, Vec3};
use redysim_model::{CutSide, JointKind, Link, Mimic, Model};
use serde::Serialize;

use super::quaternion;
use super::solid::{Ellipsoid, Solid};
use crate::layout::{self, Layout};

/// A link in the frame that its joint moves, or the ground (the first body) in the base frame.
#[derive(Serialize)]
pub struct Body<'a> {
    name: &'a str,
    /// The joint that carries it.
    joint: Option<Joint<'a>>,
    /// Points to which it reaches from its origin, m.
    ends: Vec<[f64; 3]>,
    /// Whether it carries no other link, so that the path of its last end is worth a line.
    tip: bool,
    /// Centre of mass, m; none where there is no mass.
    com: Option<[f64; 3]>,
    /// The solid ellipsoid about the centre of mass with its mass and inertia; none of a point mass.
    ellipsoid: Option<Ellipsoid>,
}

#[derive(Serialize)]
struct Joint<'a> {
    name: &'a str,
    kind: &'a str,
    /// Unit vector, in the body's frame.
    axis: [f64; 3],
    /// The body that carries it.
    parent: usize,
    /// The body's frame in that body's where the joint's motion is zero: origin, m, and quaternion x, y, z, w.
    position: [f64; 3],
    rotation: [f64; 4],
    /// What the link does for a unit of each of its coordinates, one after the other; none of a joint in space.
    motions: Vec<AxisMotion>,
    /// What is added to its coordinate, rad or m.
    offset: f64,
    /// How its last coordinates give the orientation of the body, after three of its position if it is free; none for a
    /// joint of one coordinate.
    orientation: Option<Orientations>,
    /// Number of its first coordinate, which is that of its colour; none for a joint that does not move.
    coordinate: Option<usize>,
    /// For a prismatic joint, where it slides from.
    rail: Option<Place>,
}

/// A motion about or along an axis.
#[derive(Serialize)]
struct AxisMotion {
    /// Unit vector, in the frame that the motions before have moved.
    axis: [f64; 3],
    /// Rotation about the axis and displacement along it for a unit of the coordinate.
    turn: f64,
    slide: f64,
}

/// How the page has orientations of spherical and free joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Orientations {
    /// Of a run, as quaternions x, y, z, w of any length.
    Quaternion,
    /// Of a model that is moved by hand, as roll, pitch and yaw.
    Rpy,
}

impl Orientations {
    /// The number of coordinates of a joint on the page.
    pub fn coordinates(self, joint: &layout::Joint) -> usize {
        let angles = if joint.is_in_space() && self == Orientations::Rpy { 1 } else { 0 };
        joint.q.len() - angles
    }
}

/// A point on a body.
#[derive(Serialize)]
struct Place {
    /// The body's number; 0 is the ground.
    body: usize,
    /// In the body's frame, m.
    point: [f64; 3],
}

/// A cut joint between two bodies.
#[derive(Serialize)]
pub struct Cut<'a> {
    name: &'a str,
    kind: &'a str,
    a: Side,
    b: Side,
}

/// A side of a cut joint, in the frame of its body.
#[derive(Serialize)]
struct Side {
    #[serde(flatten)]
    place: Place,
    /// Unit vector.
    axis: [f64; 3],
    /// The axes that are aligned with the other side's: quaternion x, y, z, w.
    rotation: [f64; 4],
}

/// A frame on a body: that of a link, or one of interest.
#[derive(Serialize)]
pub struct Frame<'a> {
    name: &'a str,
    /// Whether it is the frame of a link.
    of_link: bool,
    body: usize,
    /// In the body's frame: origin, m, and quaternion x, y, z, w.
    position: [f64; 3],
    rotation: [f64; 4],
}

/// The ground, then the links in the model's order.
pub fn of<'a>(model: &'a Model, layout: &Layout, orientations: Orientations) -> Vec<Body<'a>> {
    let moving = moving_joints(model, layout, orientations);
    let ground = Body { name: "base", joint: None, ends: ends(model, None), tip: false, com: None, ellipsoid: None };
    let links = model.links.iter().enumerate().map(|(index, link)| {
        let placement = frame(model, link.parent) * link.placement;
        let Mimic { link: followed, multiplier: rate, offset } = model.followed(index);
        let joint = Joint {
            name: &link.joint_name,
            kind: link.joint.name(),
            axis: link.axis.0,
            parent: number(link.parent),
            position: placement.position.0,
            rotation: quaternion(placement.rotation),
            motions: motions(link, rate),
            // Of the coordinate itself, which the motions multiply.
            offset: (link.offset + offset) / rate,
            orientation: moving[index].filter(|(joint, _)| joint.is_in_space()).map(|_| orientations),
            coordinate: moving[followed].map(|(_, first)| first),
            rail: (link.joint == JointKind::Prismatic)
                .then(|| Place { body: number(link.parent), point: foot(model, link) }),
        };
        let solid = Solid::of(link);
        let mut ends = ends(model, Some(index));
        if ends.is_empty() {
            // No joint marks where it ends: its frame may stand there, else its inertia tells how large it is.
            let far_end = link.frame.position;
            ends = if far_end == Vec3::zero() { solid.ends() } else { vec![far_end.0] };
        }
        let tip = model.links.iter().all(|other| other.parent != Some(index));
        let com = (link.mass > 0.0).then(|| solid.com.into());
        Body { name: &link.name, joint: Some(joint), ends, tip, com, ellipsoid: solid.ellipsoid() }
    });
    std::iter::once(ground).chain(links).collect()
}

/// For each link, its joint with the number of that joint's first coordinate on the page; `None` for a joint without
/// coordinates of its own.
fn moving_joints<'a>(
    model: &Model,
    layout: &'a Layout,
    orientations: Orientations,
) -> Vec<Option<(&'a layout::Joint, usize)>> {
    let (mut joints, mut next) = (layout.joints.iter(), 0);
    let of_link = |link: &Link| {
        let joint = if link.dof() > 0 { joints.next()? } else { return None };
        let first = next;
        next += orientations.coordinates(joint);
        Some((joint, first))
    };
    model.links.iter().map(of_link).collect()
}

/// The motions of a link about and along axes of its joint's frame, at `rate` for each of its coordinates.
fn motions(link: &Link, rate: f64) -> Vec<AxisMotion> {
    let elements = LinkJoint::of(link).map(|joint| joint.elements(link.axis)).unwrap_or_default();
    let on_axis = elements.into_iter().filter(|element| element.joint.is_on_axis());
    on_axis
        .map(|Element { joint, axes }| {
            let Screw { turn, slide, .. } = joint.screw(0);
            AxisMotion { axis: axes.column(2).0, turn: rate * turn, slide: rate * slide }
        })
        .collect()
}

impl Frame<'_> {
    /// The body that it is on, and its origin in the frame of the body, m.
    pub fn place(&self) -> (usize, [f64; 3]) {
        (self.body, self.position)
    }
}

impl Body<'_> {
    /// Draws it to a point, m, that no end of it is near.
    pub fn reach_to(&mut self, point: [f64; 3]) {
        let near =
            |end: &[f64; 3]| (Vector3::from(*end) - Vector3::from(point)).norm() < 1e-3 * Vector3::from(point).norm();
        if !self.ends.iter().any(near) {
            self.ends.push(point);
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        self.name
    }
}

/// The longest way from the base along the joints to the end of a link, m; 1 m where all is in one point.
pub fn reach(bodies: &[Body]) -> f64 {
    let length = |vector: [f64; 3]| Vector3::from(vector).norm();
    let from_joint = |body: &Body| body.ends.iter().map(|&end| length(end)).fold(0.0, f64::max);
    let joint = |body: &usize| bodies[*body].joint.as_ref();
    let to_joint = |body: usize| -> f64 {
        let chain = std::iter::successors(Some(body), |body| joint(body).map(|joint| joint.parent));
        chain.filter_map(|body| joint(&body)).map(|joint| length(joint.position)).sum()
    };
    let longest = bodies.iter().enumerate().map(|(index, body)| to_joint(index) + from_joint(body)).fold(0.0, f64::max);
    if longest > 0.0 { longest } else { 1.0 }
}

/// The cut joints.
pub fn cuts(model: &Model) -> Vec<Cut<'_>> {
    let cuts = model.loops.iter().map(|cut| {
        let [of_a, of_b] = cut.axes();
        let [a, b] = [(&cut.a, of_a), (&cut.b, of_b)].map(|(side, axes)| {
            let rotation = frame(model, side.link).rotation;
            let place = Place { body: number(side.link), point: point(model, side) };
            Side { place, axis: (rotation * side.axis).0, rotation: quaternion(rotation * axes) }
        });
        Cut { name: &cut.name, kind: cut.joint.name(), a, b }
    });
    cuts.collect()
}

/// The frames of the links, then those of interest, in the model's order.
pub fn frames(model: &Model) -> Vec<Frame<'_>> {
    let placed = |name, of_link, link, Pose { position, rotation }: Pose<f64>| {
        let (position, rotation) = (position.0, quaternion(rotation));
        Frame { name, of_link, body: number(link), position, rotation }
    };
    let of_links =
        model.links.iter().enumerate().map(|(index, link)| placed(link.name.as_str(), true, Some(index), link.frame));
    let of_interest = model.frames.iter().map(|of| {
        let pose = frame(model, of.link) * of.placement;
        placed(of.name.as_str(), false, of.link, pose)
    });
    of_links.chain(of_interest).collect()
}

/// The frame of a link, or of the base, in the body's.
fn frame(model: &Model, link: Option<usize>) -> Pose<f64> {
    link.map_or(Pose::identity(), |link| model.links[link].frame)
}

/// The point of a cut on one side, in the body's frame.
fn point(model: &Model, side: &CutSide) -> [f64; 3] {
    frame(model, side.link).transform(side.point).0
}

/// Number of a body among those that the page knows: the ground is 0.
pub fn number(link: Option<usize>) -> usize {
    link.map_or(0, |index| index + 1)
}

/// Where the joints of a link's children, and the cut joints on it, stand: in the body's frame. A free joint stands
/// nowhere.
fn ends(model: &Model, link: Option<usize>) -> Vec<[f64; 3]> {
    let children = model.links.iter().filter(|child| child.parent == link && child.joint != JointKind::Free);
    let children = children.map(|child| foot(model, child));
    let sides = model.loops.iter().flat_map(|cut| [&cut.a, &cut.b]);
    children.chain(sides.filter(|side| side.link == link).map(|side| point(model, side))).collect()
}

/// Where a link's joint stands on its parent: for a prismatic one, where the joint variable is zero.
fn foot(model: &Model, link: &Link) -> [f64; 3] {
    let slid = link.axis.scale(link.offset_along_axis());
    (frame(model, link.parent) * link.placement).transform(slid).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::Value;

    /// A swinging arm that carries a slide, to which a loop is cut.
    fn drawn(arm: &str, slide: &str) -> (Value, Value) {
        let text = format!(
            "name = 'crane'\ngravity = [0, 0, -9.81]\n\
             [[link]]\nname = 'arm'\nparent = 'base'\njoint = 'revolute'\n{arm}\nmass = 1\n\
             [[link]]\nname = 'slide'\nparent = 'arm'\njoint = 'prismatic'\n{slide}\nmass = 1\nactuated = false\n\
             [[loop]]\nname = 'pin'\njoint = 'revolute'\nlink_a = 'slide'\nlink_b = 'base'\npoint_b = [0.5, 0.1, 0.7]\n"
        );
        let text = text.replace("\nlink_b", if arm.contains("standard") { FAR_PIN } else { NEAR_PIN });
        let model =
            redysim_model::Model::from_toml(text, "crane.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
        let json = |value: serde_json::Result<Value>| value.expect("numbers and texts");
        let bodies = json(serde_json::to_value(of(&model, &Layout::of(&model), Orientations::Quaternion)));
        (bodies, json(serde_json::to_value(cuts(&model))))
    }

    /// The point (0.3, 0.2, 0.1) and the axis x of the slide, in the frame at its joint and in the one at its far end.
    const NEAR_PIN: &str = "\npoint_a = [0.3, 0.2, 0.1]\naxis_a = [0, 1, 0]\nlink_b";
    const FAR_PIN: &str = "\npoint_a = [0.1, 0.1, -0.2]\naxis_a = [0, 0, -1]\nlink_b";

    fn numbers(value: &Value, found: &mut Vec<f64>) {
        match value {
            Value::Number(number) => found.extend(number.as_f64()),
            Value::Array(values) => values.iter().for_each(|value| numbers(value, found)),
            Value::Object(entries) => entries.values().for_each(|value| numbers(value, found)),
            _ => {}
        }
    }

    #[test]
    fn a_robot_by_standard_parameters_looks_as_it_does_by_khalil_kleinfinger_parameters() {
        let (bodies, cuts) = drawn(
            "dh_standard = { a = 0.4, alpha = '-90 deg', d = 0.2, theta = 0.3 }\ncom = [-0.1, 0.02, 0.03]",
            "dh_standard = { a = 0.2, alpha = '90 deg', d = 0.25, theta = 0.7 }\ncom = [-0.1, 0, 0.05]",
        );
        let (expected_bodies, expected_cuts) = drawn(
            "dh = { b = 0.2, theta = 0.3 }\ncom = [0.3, 0.03, -0.02]",
            "dh = { a = 0.4, alpha = '-90 deg', b = 0.25, theta = 0.7 }\ncom = [0.1, -0.05, 0]",
        );
        for (found, expected) in [(&bodies, &expected_bodies), (&cuts, &expected_cuts)] {
            let [mut ours, mut theirs] = [Vec::new(), Vec::new()];
            numbers(found, &mut ours);
            numbers(expected, &mut theirs);
            assert!(ours.len() > 5 && ours.len() == theirs.len(), "{found} instead of {expected}");
            assert!(ours.iter().zip(&theirs).all(|(a, b)| (a - b).abs() < 1e-15), "{found} instead of {expected}");
        }
    }

    /// The right rack mimics the left one, at 1 q, and this the pinion, at 0.01 q + 0.02: both slide by 0.01 (q + 2).
    #[test]
    fn a_joint_that_mimics_others_moves_by_the_coordinate_of_the_last_one() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/parallel_gripper.toml");
        let model = Model::load(path).expect("a valid model").model;
        let bodies = serde_json::to_value(of(&model, &Layout::of(&model), Orientations::Quaternion)).expect("numbers");
        let joint = |body: usize| bodies[body]["joint"].clone();
        assert_eq!([1, 2, 3, 4].map(|body| joint(body)["coordinate"].clone()), [0, 1, 1, 1]);
        for rack in [3, 4] {
            let motion = &joint(rack)["motions"][0];
            assert_eq!((motion["slide"].as_f64(), motion["turn"].as_f64()), (Some(0.01), Some(0.0)));
            assert_eq!(joint(rack)["offset"], 2.0);
        }
    }
}
