//! Closed loops: how far the two sides of each cut joint are apart, and how that changes.
//!
//! The rows of a cut are the point of side b minus the point of side a, in the base frame; then what keeps directions
//! aligned: sums of products aᵢ·bⱼ of axes of the two sides ([`CutKind::alignments`]). Rows that vanish at every
//! position are left out ([`Cut::rows`](crate::tree::Cut::rows)), so that a planar mechanism costs planar code.

use super::joint::{JointFrame, joint_frames};
use super::trace::{Trace, Untraced};
use crate::model::CutKind;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::tree::{Cut, CutEnd, Joint, Tree};
use redysim_runtime::Scalar;

/// One term of a row that aligns directions: factor, axis of side a, axis of side b.
pub type Alignment = (f64, usize, usize);

impl CutKind {
    /// The rows beside the point's three, each a sum of products of axes of the two sides that vanishes when they are
    /// aligned: for a revolute cut, the axis of b (its z) against x and y of a; for a weld, the sine of the angle
    /// between the frames about each axis.
    pub fn alignments(self) -> &'static [&'static [Alignment]] {
        match self {
            CutKind::Spherical => &[],
            CutKind::Revolute => &[&[(1.0, 0, 2)], &[(1.0, 1, 2)]],
            CutKind::Weld => {
                &[&[(0.5, 2, 1), (-0.5, 1, 2)], &[(0.5, 0, 2), (-0.5, 2, 0)], &[(0.5, 1, 0), (-0.5, 0, 1)]]
            }
        }
    }
}

/// A body in the base frame.
#[derive(Clone, Copy)]
struct Placed<S> {
    pose: Pose<S>,
    /// The axes fixed to the body, which those of `pose` need not be.
    fixed: Mat3<S>,
    /// Angular velocity.
    angular: Vec3<S>,
    /// Angular acceleration at zero joint accelerations.
    angular_rate: Vec3<S>,
    /// Acceleration of the origin at zero joint accelerations, without gravity.
    acceleration: Vec3<S>,
}

impl<S: Scalar> Placed<S> {
    fn ground() -> Self {
        let zero = Vec3::zero();
        Placed {
            pose: Pose::identity(),
            fixed: Mat3::identity(),
            angular: zero,
            angular_rate: zero,
            acceleration: zero,
        }
    }

    /// How a vector fixed to the body changes, ω × r, ...
    fn rate(&self, arm: Vec3<S>) -> Vec3<S> {
        self.angular.cross(arm)
    }

    /// ... and how that changes, ω̇ × r + ω × (ω × r).
    fn second_rate(&self, arm: Vec3<S>) -> Vec3<S> {
        self.angular_rate.cross(arm) + self.rate(self.rate(arm))
    }
}

/// All bodies at the coordinates `q` and velocities `v`.
fn placed<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<Placed<S>> {
    let mut bodies: Vec<Placed<S>> = Vec::with_capacity(tree.bodies.len());
    for (body, joint) in tree.bodies.iter().zip(joint_frames(tree, trace, q)) {
        let parent = body.parent.map_or(Placed::ground(), |parent| bodies[parent]);
        let arm = parent.pose.rotation * joint.position;
        let pose = Pose { rotation: turned(parent.pose.rotation, &joint), position: parent.pose.position + arm };
        let along = pose.rotation.column(2).scale(v[body.coordinate]);
        let fixed = joint.fixed_axes(pose.rotation);
        let mut placed = Placed { pose, fixed, acceleration: parent.acceleration + parent.second_rate(arm), ..parent };
        match body.joint {
            Joint::Revolute => {
                placed.angular_rate = parent.angular_rate + parent.rate(along);
                placed.angular = parent.angular + along;
            }
            Joint::Prismatic => {
                placed.acceleration = placed.acceleration + parent.rate(along) + parent.rate(along);
            }
        }
        bodies.push(placed);
    }
    bodies
}

/// The axes of a body, of those of its parent.
fn turned<S: Scalar>(parent: Mat3<S>, joint: &JointFrame<S>) -> Mat3<S> {
    Mat3(parent.0.map(|row| joint.to_body(Vec3(row)).0))
}

/// One side of a cut, in the base frame.
struct Side<S> {
    body: Placed<S>,
    /// From the body's origin to the point.
    arm: Vec3<S>,
    axes: Mat3<S>,
    /// Whether the joint of each body carries this side.
    carried: Vec<bool>,
}

impl<S: Scalar> Side<S> {
    fn new(tree: &Tree, bodies: &[Placed<S>], end: &CutEnd) -> Self {
        let body = end.body.map_or(Placed::ground(), |body| bodies[body]);
        let mut carried = vec![false; bodies.len()];
        let mut at = end.body;
        while let Some(index) = at {
            carried[index] = true;
            at = tree.bodies[index].parent;
        }
        let rotation = body.fixed;
        Side { body, arm: rotation * Vec3::constant(end.point), axes: rotation * Mat3::constant(end.axes), carried }
    }

    fn point(&self) -> Vec3<S> {
        self.body.pose.position + self.arm
    }

    fn axis(&self, i: usize) -> Vec3<S> {
        self.axes.column(i)
    }
}

/// The rows of all loops: of each cut, what `point` and `alignment` make of its sides a and b.
fn rows<S: Scalar, R>(
    tree: &Tree,
    bodies: &[Placed<S>],
    point: impl Fn(&Side<S>, &Side<S>) -> [R; 3],
    alignment: impl Fn(&Side<S>, &Side<S>, &[Alignment]) -> R,
) -> Vec<R> {
    let of_cut = |cut: &Cut| {
        let (a, b) = (Side::new(tree, bodies, &cut.a), Side::new(tree, bodies, &cut.b));
        let alignments = cut.joint.alignments().iter().map(|terms| alignment(&a, &b, terms));
        let rows: Vec<R> = point(&a, &b).into_iter().chain(alignments).collect();
        rows.into_iter().zip(&cut.rows).filter(|(_, kept)| **kept).map(|(row, _)| row).collect::<Vec<R>>()
    };
    tree.cuts.iter().flat_map(of_cut).collect()
}

/// Σ factor · term(axis of a, axis of b).
fn weighted<S: Scalar>(terms: &[Alignment], term: impl Fn(usize, usize) -> S) -> S {
    terms.iter().fold(S::zero(), |sum, &(factor, i, j)| sum + S::from_f64(factor) * term(i, j))
}

/// How far each loop is from closed: m for points, sines for directions.
pub fn loop_residual<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S]) -> Vec<S> {
    let bodies = placed(tree, trace, q, &vec![S::zero(); tree.dof()]);
    rows(
        tree,
        &bodies,
        |a, b| (b.point() - a.point()).0,
        |a, b, terms| weighted(terms, |i, j| a.axis(i).dot(b.axis(j))),
    )
}

/// The Jacobian J of the residual, by rows of length NV: the residual changes by J v.
pub fn loop_jacobian<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S]) -> Vec<Vec<S>> {
    let bodies = placed(tree, trace, q, &vec![S::zero(); tree.dof()]);
    // A joint that carries both sides turns their difference; one that carries one side moves that side alone.
    let over_joints = |a: &Side<S>, b: &Side<S>, effect: &dyn Fn(usize, bool, bool) -> S| {
        let mut row = vec![S::zero(); tree.dof()];
        for (index, body) in tree.bodies.iter().enumerate() {
            if a.carried[index] || b.carried[index] {
                row[body.coordinate] = effect(index, a.carried[index], b.carried[index]);
            }
        }
        row
    };
    let point_effect = |index: usize, a: &Side<S>, b: &Side<S>, on_a: bool, on_b: bool| {
        let Pose { rotation, position } = bodies[index].pose;
        let (axis, sign) = (rotation.column(2), if on_b { S::one() } else { -S::one() });
        match (tree.bodies[index].joint, on_a && on_b) {
            (Joint::Revolute, true) => axis.cross(b.point() - a.point()),
            (Joint::Revolute, false) => axis.cross(if on_b { b.point() } else { a.point() } - position).scale(sign),
            (Joint::Prismatic, true) => Vec3::zero(),
            (Joint::Prismatic, false) => axis.scale(sign),
        }
    };
    let alignment_effect =
        |index: usize, a: Vec3<S>, b: Vec3<S>, on_a: bool, on_b: bool| match (tree.bodies[index].joint, on_a, on_b) {
            (Joint::Prismatic, ..) | (Joint::Revolute, true, true) => S::zero(),
            (Joint::Revolute, _, true) => bodies[index].pose.rotation.column(2).dot(b.cross(a)),
            (Joint::Revolute, ..) => bodies[index].pose.rotation.column(2).dot(a.cross(b)),
        };
    rows(
        tree,
        &bodies,
        |a, b| {
            [0, 1, 2].map(|axis| over_joints(a, b, &|index, on_a, on_b| point_effect(index, a, b, on_a, on_b)[axis]))
        },
        |a, b, terms| {
            over_joints(a, b, &|index, on_a, on_b| {
                weighted(terms, |i, j| alignment_effect(index, a.axis(i), b.axis(j), on_a, on_b))
            })
        },
    )
}

/// J̇ v: how the rates J v of the residual change at zero joint accelerations.
pub fn loop_bias<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<S> {
    let bodies = placed(tree, trace, q, v);
    let acceleration = |side: &Side<S>| side.body.acceleration + side.body.second_rate(side.arm);
    rows(
        tree,
        &bodies,
        |a, b| (acceleration(b) - acceleration(a)).0,
        |a, b, terms| {
            weighted(terms, |i, j| {
                let (of_a, of_b) = (a.axis(i), b.axis(j));
                let both = a.body.rate(of_a).dot(b.body.rate(of_b));
                a.body.second_rate(of_a).dot(of_b) + of_a.dot(b.body.second_rate(of_b)) + both + both
            })
        },
    )
}

/// Which rows of the loops do more than vanish at every position, by a look at a few positions.
///
/// A row whose residual is a constant other than zero is kept: its loop cannot close, and that must be seen.
pub(crate) fn rows_that_vary(tree: &Tree) -> Vec<bool> {
    const POSITIONS: usize = 4;
    const ROUNDOFF: f64 = 1e-13;
    let mut kept = Vec::new();
    for position in 0..POSITIONS {
        let q = tree.sample(position);
        let residual = loop_residual(tree, &Untraced, &q);
        let jacobian = loop_jacobian(tree, &Untraced, &q);
        let largest = jacobian.iter().flatten().chain(&residual).fold(1.0_f64, |largest, x| largest.max(x.abs()));
        kept.resize(residual.len(), false);
        for ((kept, residual), row) in kept.iter_mut().zip(residual).zip(jacobian) {
            *kept |= row.iter().chain([&residual]).any(|element| element.abs() > ROUNDOFF * largest);
        }
    }
    kept
}
