//! The looks of a mechanism, from its model: from where to where its links reach, and how they are joined.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use redysim_model::joint::{self, Screw};
use redysim_model::spatial::{Mat3, Vec3};
use redysim_model::{JointKind, Link, Model};
use serde::Serialize;

use crate::layout::Layout;

/// A link in its own frame, or the ground (the first body) in the base frame.
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
}

#[derive(Serialize)]
struct Joint<'a> {
    name: &'a str,
    kind: &'a str,
    /// Unit vector, in the link's frame.
    axis: [f64; 3],
    /// The body that carries it.
    parent: usize,
    /// The link's frame in that body's where the joint's motion is zero: origin, m, and quaternion x, y, z, w.
    position: [f64; 3],
    rotation: [f64; 4],
    /// Rotation about the axis and displacement along it for a unit of its coordinate.
    turn: f64,
    slide: f64,
    /// What is added to its coordinate, rad or m.
    offset: f64,
    /// Number of its first coordinate, which is that of its colour; none for a joint that does not move.
    coordinate: Option<usize>,
    /// For a prismatic joint, where it slides from.
    rail: Option<Place>,
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
    /// Side a.
    at: Place,
    /// Unit vector, in the frame of side a.
    axis: [f64; 3],
}

/// The ground, then the links in the model's order.
pub fn of<'a>(model: &'a Model, layout: &Layout) -> Vec<Body<'a>> {
    let mut moving = layout.joints.iter();
    let ground = Body { name: "base", joint: None, ends: ends(model, None), tip: false, com: None };
    let links = model.links.iter().enumerate().map(|(index, link)| {
        let screw = joint::Joint::of(link).map_or(Screw { turn: 0.0, slide: 0.0 }, joint::Joint::screw);
        let joint = Joint {
            name: &link.joint_name,
            kind: link.joint.name(),
            axis: link.axis.0,
            parent: number(link.parent),
            position: link.placement.position.0,
            rotation: quaternion(link.placement.rotation),
            turn: screw.turn,
            slide: screw.slide,
            offset: link.offset,
            coordinate: if link.joint.dof() > 0 { moving.next().map(|joint| joint.q.start) } else { None },
            rail: (link.joint == JointKind::Prismatic).then(|| Place { body: number(link.parent), point: foot(link) }),
        };
        let com = link.com.0;
        let mut ends = ends(model, Some(index));
        if ends.is_empty() {
            // No joint marks where it ends: a uniform rod with this centre of mass ends at twice its distance.
            ends.push(com.map(|x| 2.0 * x));
        }
        let tip = model.links.iter().all(|other| other.parent != Some(index));
        Body { name: &link.name, joint: Some(joint), ends, tip, com: (link.mass > 0.0).then_some(com) }
    });
    std::iter::once(ground).chain(links).collect()
}

/// The cut joints, each where its side a holds it.
pub fn cuts(model: &Model) -> Vec<Cut<'_>> {
    let cuts = model.loops.iter().map(|cut| {
        let at = Place { body: number(cut.a.link), point: cut.a.point.0 };
        Cut { name: &cut.name, kind: cut.joint.name(), at, axis: cut.a.axis.0 }
    });
    cuts.collect()
}

/// Number of a body among those that the page knows: the ground is 0.
fn number(link: Option<usize>) -> usize {
    link.map_or(0, |index| index + 1)
}

fn quaternion(rotation: Mat3<f64>) -> [f64; 4] {
    let matrix = Matrix3::from_fn(|row, column| rotation.0[row][column]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)).coords.into()
}

/// Where the joints of a link's children, and the cut joints on it, stand: in the link's frame.
fn ends(model: &Model, link: Option<usize>) -> Vec<[f64; 3]> {
    let children = model.links.iter().filter(|child| child.parent == link).map(foot);
    let sides = model.loops.iter().flat_map(|cut| [&cut.a, &cut.b]);
    children.chain(sides.filter(|side| side.link == link).map(|side| side.point.0)).collect()
}

/// Where a link's joint stands on its parent: for a prismatic one, where the joint variable is zero.
fn foot(link: &Link) -> [f64; 3] {
    let slid = link.offset_along_axis();
    (link.placement.position + link.placement.rotation * Vec3(link.axis.0.map(|x| x * slid))).0
}
