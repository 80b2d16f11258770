//! Chains of rods, in numbers and proportions that make dynamics ill-conditioned.

use redysim_model::spatial::{Mat3, Pose, Vec3};
use redysim_model::{Inertia, JointKind, Link, Model, Tree};

/// A rod of a chain.
#[derive(Clone, Copy)]
pub struct Rod {
    /// What its joint turns about.
    pub axis: [f64; 3],
    /// kg
    pub mass: f64,
    /// m
    pub length: f64,
}

/// The axis of every rod in a planar chain.
pub const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// Axes that alternate, as in a chain of universal joints.
pub fn universal(index: usize) -> [f64; 3] {
    if index.is_multiple_of(2) { Z } else { [0.0, 1.0, 0.0] }
}

/// Axes that are parallel to no side of a rod.
pub fn oblique(index: usize) -> [f64; 3] {
    if index.is_multiple_of(2) { [0.0, 0.6, 0.8] } else { [0.6, 0.8, 0.0] }
}

/// A rod along x whose joint is at `start` of its parent.
fn link(index: usize, parent: Option<usize>, start: [f64; 3], Rod { axis, mass, length }: Rod) -> Link {
    let inertia = mass * length * length;
    Link {
        joint_name: format!("joint{index}"),
        placement: Pose { rotation: Mat3::identity(), position: Vec3(start) },
        axis: Vec3(axis),
        mass,
        com: Vec3([length / 2.0, 0.0, 0.0]),
        inertia: Inertia { xx: 0.01 * inertia, yy: 0.09 * inertia, zz: 0.09 * inertia, ..Inertia::default() },
        ..Link::new(format!("link{index}"), parent, JointKind::Revolute)
    }
}

/// A chain of `count` rods along x, each hinged at the end of the one before.
pub fn chain(count: usize, rod: impl Fn(usize) -> Rod) -> Tree {
    let numbered = |index: usize| {
        let parent = index.checked_sub(1);
        let start = parent.map_or(0.0, |parent| rod(parent).length);
        link(index, parent, [start, 0.0, 0.0], rod(index))
    };
    let links = (0..count).map(numbered).collect();
    Tree::new(&Model {
        name: "chain".into(),
        gravity: Vec3([0.0, -9.81, 0.0]),
        links,
        loops: Vec::new(),
        frames: Vec::new(),
        springs: Vec::new(),
    })
}

/// A palm on a joint, with `fingers` chains of `joints` light links each.
pub fn palm(fingers: usize, joints: usize) -> Tree {
    let numbered = |index: usize| {
        let (finger, joint) = ((index.max(1) - 1) / joints, (index.max(1) - 1) % joints);
        let (mass, length) = if index == 0 { (1.0, 0.1) } else { (0.02, 0.03) };
        let parent = if index == 0 { None } else { Some(if joint == 0 { 0 } else { index - 1 }) };
        let start = match (index, joint) {
            (0, _) => [0.0; 3],
            (_, 0) => [0.1, 0.02 * finger as f64 - 0.04, 0.01],
            _ => [length, 0.0, 0.0],
        };
        let axis = if joint == 0 { oblique(finger) } else { universal(joint) };
        link(index, parent, start, Rod { axis, mass, length })
    };
    let links = (0..=fingers * joints).map(numbered).collect();
    Tree::new(&Model {
        name: "palm".into(),
        gravity: Vec3([0.0, -9.81, 0.0]),
        links,
        loops: Vec::new(),
        frames: Vec::new(),
        springs: Vec::new(),
    })
}
