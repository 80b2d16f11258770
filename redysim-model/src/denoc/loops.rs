//! Closed loops: how far the two sides of each cut joint are apart, and how that changes.
//!
//! A cut is a list of [rows](CutKind::rows). Those that vanish at every position are left out
//! ([`Cut::rows`](crate::tree::Cut::rows)), so that a planar mechanism costs planar code.

use super::base_frame::{Bodies, Order, Placed};
use super::trace::{Trace, Untraced};
use crate::joint::{Measure, Screw};
use crate::model::CutKind;
use crate::parameter::ParameterIn;
use crate::spatial::{Mat3, Vec3};
use crate::tree::{Cut, CutEnd, Tree};
use redysim_runtime::Scalar;

/// One term of a row that aligns directions: factor, axis of side a, axis of side b.
pub type Alignment = (f64, usize, usize);

/// What vanishes where a cut is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutRow {
    /// A component, in the base frame, of the way from the point of side a to that of side b.
    Point(usize),
    /// The component of that way along an axis of side a.
    Along(usize),
    /// A sum of products aᵢ·bⱼ of axes of the two sides.
    Aligned(&'static [Alignment]),
}

impl CutRow {
    /// What the row measures: its multiplier is a force, N, where that is a length, or else a moment, N m.
    pub fn measure(self) -> Measure {
        match self {
            CutRow::Point(_) | CutRow::Along(_) => Measure::Length,
            CutRow::Aligned(_) => Measure::Angle,
        }
    }
}

const X: CutRow = CutRow::Point(0);
const Y: CutRow = CutRow::Point(1);
const Z: CutRow = CutRow::Point(2);
/// The axis of b, its z, against x and y of a.
const ALONG_Z: [CutRow; 2] = [CutRow::Aligned(&[(1.0, 0, 2)]), CutRow::Aligned(&[(1.0, 1, 2)])];
/// The sine of the angle between the frames about each axis.
const FRAMES: [CutRow; 3] = [
    CutRow::Aligned(&[(0.5, 2, 1), (-0.5, 1, 2)]),
    CutRow::Aligned(&[(0.5, 0, 2), (-0.5, 2, 0)]),
    CutRow::Aligned(&[(0.5, 1, 0), (-0.5, 0, 1)]),
];

impl CutKind {
    /// What vanishes where a cut of this kind is closed: points first, then directions.
    pub fn rows(self) -> &'static [CutRow] {
        const REVOLUTE: &[CutRow] = &[X, Y, Z, ALONG_Z[0], ALONG_Z[1]];
        const WELD: &[CutRow] = &[X, Y, Z, FRAMES[0], FRAMES[1], FRAMES[2]];
        const PRISMATIC: &[CutRow] = &[CutRow::Along(0), CutRow::Along(1), FRAMES[0], FRAMES[1], FRAMES[2]];
        const CYLINDRICAL: &[CutRow] = &[CutRow::Along(0), CutRow::Along(1), ALONG_Z[0], ALONG_Z[1]];
        const PLANAR: &[CutRow] = &[CutRow::Along(2), ALONG_Z[0], ALONG_Z[1]];
        match self {
            CutKind::Revolute => REVOLUTE,
            CutKind::Prismatic => PRISMATIC,
            CutKind::Universal => &[X, Y, Z, CutRow::Aligned(&[(1.0, 2, 2)])],
            CutKind::Cylindrical => CYLINDRICAL,
            CutKind::Planar => PLANAR,
            CutKind::Spherical => &[X, Y, Z],
            CutKind::Weld => WELD,
        }
    }
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
    fn new(tree: &Tree<impl Copy>, bodies: &Bodies<S>, end: &CutEnd) -> Self {
        let body = end.body.map_or(Placed::ground(), |body| bodies.placed[body]);
        // The axes fixed to the body, which those of its pose need not be.
        let fixed_axes = |index: usize| bodies.joints[index].fixed_axes(bodies.placed[index].pose.rotation);
        let rotation = end.body.map_or(Mat3::identity(), fixed_axes);
        let mut carried = vec![false; tree.bodies.len()];
        let mut at = end.body;
        while let Some(index) = at {
            carried[index] = true;
            at = tree.bodies[index].parent;
        }
        Side {
            body,
            arm: rotation.fused_product(Vec3::constant(end.point)),
            axes: rotation.apart() * Mat3::constant(end.axes).apart(),
            carried,
        }
    }

    fn point(&self) -> Vec3<S> {
        self.body.pose.position + self.arm
    }

    fn axis(&self, i: usize) -> Vec3<S> {
        self.axes.column(i)
    }
}

/// The kept rows of all loops, each as `of_row` makes it of its cut's sides a and b.
fn rows<S: Scalar, R>(
    tree: &Tree<impl ParameterIn<S>>,
    bodies: &Bodies<S>,
    of_row: impl Fn(&Side<S>, &Side<S>, CutRow) -> R,
) -> Vec<R> {
    let of_cut = |cut: &Cut| {
        let (a, b) = (Side::new(tree, bodies, &cut.a), Side::new(tree, bodies, &cut.b));
        let kept = cut.joint.rows().iter().zip(&cut.rows).filter(|(_, kept)| **kept);
        kept.map(|(row, _)| of_row(&a, &b, *row)).collect::<Vec<R>>()
    };
    tree.cuts.iter().flat_map(of_cut).collect()
}

/// Σ factor · term(axis of a, axis of b).
fn weighted<S: Scalar>(terms: &[Alignment], term: impl Fn(usize, usize) -> S) -> S {
    terms.iter().fold(S::zero(), |sum, &(factor, i, j)| sum + S::from_f64(factor) * term(i, j))
}

/// How far each loop is from closed: m for points, sines for directions.
pub fn loop_residual<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S]) -> Vec<S> {
    let q = &tree.all_coordinates(q);
    let bodies = Bodies::new(tree, trace, q, &[], Order::Positions);
    rows(tree, &bodies, |a, b, row| match row {
        CutRow::Point(axis) => (b.point() - a.point())[axis],
        CutRow::Along(i) => (b.point() - a.point()).fused_dot(a.axis(i)),
        CutRow::Aligned(terms) => weighted(terms, |i, j| a.axis(i).fused_dot(b.axis(j))),
    })
}

/// The Jacobian J of the residual, by rows of length NV: the residual changes by J v.
pub fn loop_jacobian<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S]) -> Vec<Vec<S>> {
    let q = &tree.all_coordinates(q);
    let bodies = Bodies::new(tree, trace, q, &[], Order::Positions);
    // A joint that carries both sides turns their difference; one that carries one side moves that side alone.
    let point_effect = |index: usize, screw: Screw, a: &Side<S>, b: &Side<S>, on_a: bool, on_b: bool| {
        let (axis, sign) = (bodies.axis(index, screw.axis), if on_b { S::one() } else { -S::one() });
        let turn = screw.turn(S::one()).map(|turn| {
            let arm = match (on_a, on_b) {
                (true, true) => b.point() - a.point(),
                (_, true) => b.point() - bodies.placed[index].pose.position,
                _ => a.point() - bodies.placed[index].pose.position,
            };
            let across = axis.fused_cross(arm);
            if on_a && on_b { across.scale(turn) } else { across.scale(sign * turn) }
        });
        // A joint that carries both sides displaces both.
        let slide = screw.slide(S::one()).filter(|_| !(on_a && on_b)).map(|slide| axis.scale(sign * slide));
        match (turn, slide) {
            (Some(turn), Some(slide)) => turn + slide,
            (turn, slide) => turn.or(slide).unwrap_or(Vec3::zero()),
        }
    };
    let alignment_effect = |index: usize, screw: Screw, a: Vec3<S>, b: Vec3<S>, on_a: bool, on_b: bool| {
        let across = match (on_a, on_b) {
            (true, true) => return S::zero(),
            (_, true) => b.fused_cross(a),
            _ => a.fused_cross(b),
        };
        screw.turn(bodies.axis(index, screw.axis).fused_dot(across)).unwrap_or(S::zero())
    };
    let effect = |index: usize, screw: Screw, a: &Side<S>, b: &Side<S>, row: CutRow| {
        let (on_a, on_b) = (a.carried[index], b.carried[index]);
        match row {
            CutRow::Point(axis) => point_effect(index, screw, a, b, on_a, on_b)[axis],
            // The way and the axis turn as one.
            CutRow::Along(_) if on_a && on_b => S::zero(),
            CutRow::Along(i) => {
                let (way, axis) = (b.point() - a.point(), a.axis(i));
                let moved = point_effect(index, screw, a, b, on_a, on_b).fused_dot(axis);
                if on_a { moved + alignment_effect(index, screw, axis, way, true, false) } else { moved }
            }
            CutRow::Aligned(terms) => {
                weighted(terms, |i, j| alignment_effect(index, screw, a.axis(i), b.axis(j), on_a, on_b))
            }
        }
    };
    rows(tree, &bodies, |a, b, cut_row| {
        let mut row = vec![S::zero(); tree.nv_of_all()];
        for (index, body) in tree.bodies.iter().enumerate() {
            if a.carried[index] || b.carried[index] {
                for (velocity, screw) in body.v.clone().zip(body.joint.screws()) {
                    row[velocity] = effect(index, screw, a, b, cut_row);
                }
            }
        }
        tree.folded(row)
    })
}

/// J̇ v: how the rates J v of the residual change at zero joint accelerations.
pub fn loop_bias<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<S> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let bodies = Bodies::new(tree, trace, q, v, Order::Accelerations);
    let velocity = |side: &Side<S>| side.body.velocity + side.body.derivative(side.arm);
    let acceleration = |side: &Side<S>| side.body.acceleration + side.body.second_derivative(side.arm);
    rows(tree, &bodies, |a, b, row| match row {
        CutRow::Point(axis) => (acceleration(b) - acceleration(a))[axis],
        CutRow::Along(i) => {
            let axis = a.axis(i);
            let both = (velocity(b) - velocity(a)).fused_dot(a.body.derivative(axis));
            let of_axis = (b.point() - a.point()).fused_dot(a.body.second_derivative(axis));
            (acceleration(b) - acceleration(a)).fused_dot(axis) + of_axis + both + both
        }
        CutRow::Aligned(terms) => weighted(terms, |i, j| {
            let (of_a, of_b) = (a.axis(i), b.axis(j));
            let both = a.body.derivative(of_a).fused_dot(b.body.derivative(of_b));
            a.body.second_derivative(of_a).fused_dot(of_b)
                + of_a.fused_dot(b.body.second_derivative(of_b))
                + both
                + both
        }),
    })
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
