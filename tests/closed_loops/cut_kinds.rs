//! Every kind of cut does what a joint of its kind in the tree does: a loop moves the same wherever it is cut.
//!
//! Two bodies, A that floats and B that turns about an axis of the ground, are joined by a joint. Either the tree has that
//! joint, and the loop is cut where B turns; or the tree has B on the ground, and the loop is cut at that joint.
#![cfg(feature = "generic")]

use crate::common::call::{bias_forces, loop_bias, loop_jacobian, loop_residual, mass_matrix};
use crate::common::random::Random;
use nalgebra::{DMatrix, DVector};
use redysim::generic::{CutKind, CutSide, GenericMechanism, Inertia, JointKind, Link, Loop, Mat3, Model, Pose, Vec3};
use redysim_model::joint::LinkJoint;
use redysim_model::rotation::roll_pitch_yaw;

const X: Vec3<f64> = Vec3([1.0, 0.0, 0.0]);
const Y: Vec3<f64> = Vec3([0.0, 1.0, 0.0]);
const Z: Vec3<f64> = Vec3([0.0, 0.0, 1.0]);

fn body(name: &str, parent: Option<usize>, joint: JointKind) -> Link {
    Link {
        mass: 1.3,
        com: Vec3([0.1, -0.2, 0.05]),
        inertia: Inertia { xx: 0.03, yy: 0.05, zz: 0.04, xy: 0.004, yz: -0.003, xz: 0.002 },
        ..Link::new(name, parent, joint)
    }
}

fn model(links: Vec<Link>, cut: Loop) -> GenericMechanism {
    GenericMechanism::new(Model { links, loops: vec![cut], ..Model::new("loop", Vec3([0.4, -1.1, -9.6])) })
}

fn cut(joint: CutKind, a: (Option<usize>, Vec3<f64>, Vec3<f64>), b: (Option<usize>, Vec3<f64>, Vec3<f64>)) -> Loop {
    let [a, b] = [a, b].map(|(link, point, axis)| CutSide { link, point, axis });
    Loop { name: "cut".into(), joint, a, b }
}

/// A vector that is within the null space of J.
fn motion_of(jacobian: &DMatrix<f64>, random: &mut Random) -> DVector<f64> {
    let any = DVector::from_vec(random.vector(jacobian.ncols(), 2.0));
    let correction = jacobian.clone().svd(true, true).solve(&(jacobian * &any), 1e-9).expect("both factors");
    any - correction
}

struct State {
    q: Vec<f64>,
    v: DVector<f64>,
}

/// Accelerations from M a + h = Jᵀλ and J a + J̇ v = 0.
fn accelerations(mechanism: &GenericMechanism, State { q, v }: &State) -> DVector<f64> {
    let nv = v.len();
    let jacobian = jacobian(mechanism, q);
    let nc = jacobian.nrows();
    let mass = DMatrix::from_row_slice(nv, nv, &mass_matrix(mechanism, q).concat());
    let mut system = DMatrix::zeros(nv + nc, nv + nc);
    system.view_mut((0, 0), (nv, nv)).copy_from(&mass);
    system.view_mut((0, nv), (nv, nc)).copy_from(&-jacobian.transpose());
    system.view_mut((nv, 0), (nc, nv)).copy_from(&jacobian);
    let (bias, of_loops) = (bias_forces(mechanism, q, v.as_slice()), loop_bias(mechanism, q, v.as_slice()));
    let right = DVector::from_iterator(nv + nc, bias.iter().chain(&of_loops).map(|x| -x));
    system.lu().solve(&right).expect("a regular position").rows(0, nv).into_owned()
}

fn jacobian(mechanism: &GenericMechanism, q: &[f64]) -> DMatrix<f64> {
    let rows = loop_jacobian(mechanism, q);
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

/// The two models with the joint `tree` in the tree or the cut `cut_joint`, whose axes on A, in the frame of the joint there,
/// and on B are `axes`.
fn assert_same(tree: JointKind, cut_joint: CutKind, axes: [Vec3<f64>; 2]) {
    let mut random = Random::new(3);
    for _ in 0..20 {
        // Frames that align have no rotation between them.
        let rotation = match cut_joint {
            CutKind::Prismatic | CutKind::Weld => Mat3::identity(),
            _ => roll_pitch_yaw([random.within(3.0), random.within(1.0), random.within(3.0)]),
        };
        let on_a = Pose { rotation, position: Vec3([0.3, -0.1, 0.2]) };
        let joint = Link { placement: on_a, axis: axes[1], ..body("b", Some(0), tree) };
        let q_joint = random.vector(LinkJoint::of(&joint).map_or(0, LinkJoint::nq), 0.9);
        let q_a = [random.vector(3, 1.0), random.vector(4, 1.0)].concat();
        let a = LinkJoint::of(&body("a", None, JointKind::Free)).expect("it moves");
        let across = match LinkJoint::of(&joint) {
            Some(motion) => in_frame(motion, &q_joint, axes[1]),
            None => Pose::identity(),
        };
        let of_b: Pose<f64> = in_frame(a, &q_a, Z) * on_a * across;

        let (hinge, at) = (Vec3([0.6, 0.0, 0.8]), Vec3([0.2, 0.3, -0.1]));
        let place = |position| Pose { rotation: Mat3::identity(), position };
        let hinged = of_b * place(at);
        let at_ground = (None, hinged.position, hinged.rotation * hinge);
        let in_tree = model(
            vec![body("a", None, JointKind::Free), joint],
            cut(CutKind::Revolute, at_ground, (Some(1), at, hinge)),
        );
        let frame = place(at.scale(-1.0));
        let on_ground = Link { placement: hinged, axis: hinge, frame, ..body("b", None, JointKind::Revolute) };
        let cut_there = model(
            vec![body("a", None, JointKind::Free), on_ground],
            cut(cut_joint, (Some(0), on_a.position, rotation * axes[0]), (Some(1), Vec3::zero(), axes[1])),
        );

        let q = [&q_a[..], &q_joint].concat();
        let v = motion_of(&jacobian(&in_tree, &q), &mut random);
        let first = State { q, v };
        let q = [&q_a[..], &[0.0]].concat();
        let residual = loop_residual(&cut_there, &q);
        assert!(residual.iter().all(|x| x.abs() < 1e-13), "{cut_joint:?}: closed at the same position {residual:?}");
        let rows = jacobian(&cut_there, &q);
        // A moves as before, and there is a rate of B with which the loop stays closed.
        let of_a = rows.columns(0, 6) * first.v.rows(0, 6);
        let of_b = rows.column(6);
        let rate = -of_b.dot(&of_a) / of_b.norm_squared();
        let left = (&of_a + of_b * rate).amax();
        // Roundings times the condition of the null space, up to 1e3.
        assert!(left < 1e-12 * first.v.amax().max(1.0), "{cut_joint:?}: the loop opens at {left:e} of {of_a}");
        let v = DVector::from_iterator(7, first.v.rows(0, 6).iter().copied().chain([rate]));
        let [found, expected] = [accelerations(&cut_there, &State { q, v }), accelerations(&in_tree, &first)];
        let difference = (found.rows(0, 6) - expected.rows(0, 6)).amax();
        // Roundings times the condition of the linear system, about 1e4.
        assert!(difference < 1e-10 * expected.amax(), "{cut_joint:?}: {difference:e}\n{found}{expected}");
    }
}

/// The frame of the link at the coordinates `q`, in that of its joint, where the joint has the given axis.
fn in_frame(joint: LinkJoint, q: &[f64], axis: Vec3<f64>) -> Pose<f64> {
    let elements = joint.elements(axis);
    let each = elements.iter().zip(q.chunks(q.len() / elements.len()));
    each.fold(Pose::identity(), |moved, (element, q)| {
        let axes = |rotation| Pose { rotation, position: Vec3::zero() };
        moved * axes(element.axes) * element.joint.transform(q) * axes(element.axes.transpose())
    })
}

#[test]
fn a_revolute_cut_is_a_revolute_joint() {
    assert_same(JointKind::Revolute, CutKind::Revolute, [Z; 2]);
}

#[test]
fn a_prismatic_cut_is_a_prismatic_joint() {
    let axis = Vec3([0.0, 0.8, -0.6]);
    assert_same(JointKind::Prismatic, CutKind::Prismatic, [axis; 2]);
}

#[test]
fn a_universal_cut_is_a_universal_joint() {
    assert_same(JointKind::Universal, CutKind::Universal, [X, Y]);
}

#[test]
fn a_cylindrical_cut_is_a_cylindrical_joint() {
    let axis = Vec3([0.0, 0.8, -0.6]);
    assert_same(JointKind::Cylindrical, CutKind::Cylindrical, [axis; 2]);
}

#[test]
fn a_planar_cut_is_a_planar_joint() {
    assert_same(JointKind::Planar, CutKind::Planar, [Z; 2]);
}

#[test]
fn a_spherical_cut_is_a_spherical_joint() {
    assert_same(JointKind::Spherical, CutKind::Spherical, [Z; 2]);
}

#[test]
fn a_weld_is_a_fixed_joint() {
    assert_same(JointKind::Fixed, CutKind::Weld, [Z; 2]);
}
