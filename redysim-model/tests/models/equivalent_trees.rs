//! Passes from tree to tree describe the same robot: every quantity of the whole mechanism stays what it was.

use redysim_model::denoc::{self, Method, Untraced};
use redysim_model::frames::{canonical, reframe};
use redysim_model::inertia::Sym3;
use redysim_model::joint::{AxisMass, Joint, Vanishing};
use redysim_model::pseudo::PseudoInertia;
use redysim_model::regroup::{base_parameters, take_from_parent};
use redysim_model::scaling::in_unit;
use redysim_model::spatial::{Pose, Vec3};
use redysim_model::{Function, Model, Tree, rotation};

/// Roundoff of values of size one over a few dozen operations.
const ROUNDOFF: f64 = 1e-12;

fn tree(name: &str) -> Tree {
    let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Tree::new(&Model::load(path).expect("a good model").model)
}

/// Revolute and prismatic joints, branching, oblique; with loops, the plane and space; springs between points.
fn trees() -> Vec<(&'static str, Tree)> {
    let names = [
        "kr5",
        "gripper",
        "test/gantry",
        "test/bricard",
        "slider_crank",
        "leg",
        "peers/humanoid30",
        "test/frames",
        "test/springs",
    ];
    names.map(|name| (name, tree(name))).into()
}

/// What the whole mechanism does at a state.
fn dynamics(tree: &Tree) -> Vec<Vec<f64>> {
    let (q, v, a) = (tree.sample(0), tree.sample(1), tree.sample(2));
    let energy = denoc::energy(tree, &Untraced, &q, &v);
    vec![
        denoc::inverse_dynamics(tree, &Untraced, &q, &v, &a),
        denoc::mass_matrix(tree, &Untraced, &q).concat(),
        denoc::bias_forces(tree, &Untraced, &q, &v),
        denoc::gravity_forces(tree, &Untraced, &q),
        denoc::passive_forces(tree, &Untraced, &q, &v),
        vec![denoc::dissipated_power(tree, &Untraced, &q, &v)],
        vec![energy.kinetic],
        vec![energy.potential],
    ]
}

/// Where the links and the frames are and how far the loops are from closed.
fn kinematics(tree: &Tree) -> Vec<Vec<f64>> {
    let (q, v) = (tree.sample(0), tree.sample(1));
    let mut values = vec![
        denoc::loop_residual(tree, &Untraced, &q),
        denoc::loop_jacobian(tree, &Untraced, &q).concat(),
        denoc::loop_bias(tree, &Untraced, &q, &v),
    ];
    let frames = [Function::FrameKinematics, Function::FrameJacobians, Function::FrameBias];
    values.extend(frames.map(|function| denoc::evaluate(function, tree, &Untraced, &[&q, &v])));
    for link in denoc::link_kinematics(tree, &Untraced, &q, &v) {
        values.push(link.rotation.concat());
        values.extend([link.origin, link.com, link.velocity, link.angular_velocity].map(Vec::from));
    }
    values
}

fn assert_same(what: &str, found: &[Vec<f64>], expected: &[Vec<f64>]) {
    for (quantity, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.len(), expected.len(), "{what}");
        let scale = expected.iter().fold(1e-3_f64, |scale, x| scale.max(x.abs()));
        for (x, y) in found.iter().zip(expected) {
            assert!((x - y).abs() <= ROUNDOFF * scale, "{what}, quantity {quantity}: {x:e} instead of {y:e}");
        }
    }
}

#[test]
fn frames_may_be_turned_and_slid() {
    for (name, tree) in trees() {
        let mut turned = tree.clone();
        for body in 0..tree.bodies.len() {
            reframe(&mut turned, body, 0.3 + body as f64, 0.1 * body as f64 - 0.2);
        }
        for (what, other) in
            [("turned", &turned), ("canonical", &canonical(&tree, |_| true)), ("back", &canonical(&turned, |_| true))]
        {
            assert_same(&format!("{name} {what}"), &dynamics(other), &dynamics(&tree));
            assert_same(&format!("{name} {what}"), &kinematics(other), &kinematics(&tree));
        }
    }
}

#[test]
fn canonical_frames_do_not_depend_on_those_of_the_model() {
    let kr5 = tree("peers/kr5");
    let mut turned = kr5.clone();
    for body in 0..kr5.bodies.len() {
        reframe(&mut turned, body, 0.7 * body as f64 - 1.0, 0.3 - 0.1 * body as f64);
    }
    let zeros = |tree: &Tree| -> Vec<bool> {
        let numbers = tree.bodies.iter().flat_map(|body| {
            let PseudoInertia { moment, second: s, .. } = body.inertia;
            let rotation = body.placement.rotation.0.concat();
            let inertia = [s.xx, s.yy, s.zz, s.xy, s.yz, s.xz, body.offset];
            rotation.into_iter().chain(body.placement.position.0).chain(moment.0).chain(inertia)
        });
        numbers.map(|number| number == 0.0).collect()
    };
    let canonical = |tree: &Tree| canonical(tree, |_| true);
    assert_eq!(zeros(&canonical(&turned)), zeros(&canonical(&kr5)));
}

#[test]
fn axes_that_do_not_rotate_with_their_joint_change_no_quantity() {
    for (name, tree) in trees() {
        for pattern in 1..8_usize {
            let mut merged = tree.clone();
            for (index, body) in merged.bodies.iter_mut().enumerate() {
                body.merged_parallel = (pattern >> (index % 3)) & 1 == 1;
            }
            assert_same(&format!("{name} {pattern}"), &dynamics(&merged), &dynamics(&tree));
            assert_same(&format!("{name} {pattern}"), &kinematics(&merged), &kinematics(&tree));
            let forward = |tree: &Tree| {
                denoc::forward_dynamics(
                    Method::Recursion,
                    tree,
                    &Untraced,
                    &tree.sample(0),
                    &tree.sample(1),
                    &tree.sample(2),
                )
            };
            let (found, expected) = (forward(&merged), forward(&tree));
            let scale = expected.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            for (x, y) in found.iter().zip(&expected) {
                assert!((x - y).abs() <= 1e-9 * scale, "{name} {pattern} forward: {x:e} instead of {y:e}");
            }
        }
    }
}

#[test]
fn mass_on_an_axis_goes_with_either_body() {
    for (name, tree) in trees() {
        for vanishing in [Vanishing::TensorYy, Vanishing::SecondMomentZz] {
            let base = base_parameters(&tree, vanishing);
            assert_same(&format!("{name} {vanishing:?}"), &dynamics(&base), &dynamics(&tree));
        }
        let mut taken = base_parameters(&tree, Vanishing::SecondMomentZz);
        for body in (0..tree.bodies.len()).filter(|&body| tree.bodies[body].joint == Joint::Revolute) {
            take_from_parent(&mut taken, body, AxisMass { mass: 0.5, first: -0.2, second: 0.1 });
        }
        assert_same(&format!("{name} taken"), &dynamics(&taken), &dynamics(&tree));
    }
}

#[test]
fn base_parameters_vanish() {
    let base = base_parameters(&tree("kr5"), Vanishing::SecondMomentZz);
    for body in &base.bodies {
        assert_eq!((body.inertia.mass, body.inertia.moment[2], body.inertia.second.zz), (0.0, 0.0, 0.0));
    }
    for body in &base_parameters(&tree("kr5"), Vanishing::TensorYy).bodies {
        assert_eq!(body.inertia.to_rigid().tensor.yy, 0.0);
    }
}

#[test]
fn another_unit_of_length_changes_no_number_of_a_revolute_mechanism() {
    for (name, tree) in trees() {
        let prismatic = tree.bodies.iter().any(|body| body.joint == Joint::Prismatic);
        let scaled = in_unit(&tree, 0.37);
        assert_eq!(scaled.is_none(), prismatic, "{name}");
        if let Some(scaled) = scaled {
            assert_same(name, &dynamics(&scaled), &dynamics(&tree));
        }
    }
    let kr5 = in_unit(&tree("peers/kr5"), 0.6).expect("no joint is prismatic");
    assert_eq!(kr5.bodies[2].placement.position, Vec3([1.0, 0.0, 0.0]));
}

#[test]
fn moments_of_mass_are_those_of_the_inertia_tensor() {
    let central = Sym3 { xx: 0.4, yy: 0.5, zz: 0.6, xy: 0.01, yz: -0.02, xz: 0.03 };
    let body = PseudoInertia::from_central(2.0, Vec3([0.1, -0.2, 0.3]), central);
    // Steiner's theorem, m (c·c 1 − c cᵀ).
    let tensor = body.to_rigid().tensor;
    let expected = Sym3 {
        xx: 0.4 + 2.0 * (0.04 + 0.09),
        yy: 0.5 + 2.0 * (0.01 + 0.09),
        zz: 0.6 + 2.0 * (0.01 + 0.04),
        xy: 0.01 + 2.0 * 0.02,
        yz: -0.02 + 2.0 * 0.06,
        xz: 0.03 - 2.0 * 0.03,
    };
    for (found, expected) in tensor.full().0.concat().iter().zip(expected.full().0.concat()) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    // Turned and moved there and back, it is the same.
    let pose = Pose { rotation: rotation::roll_pitch_yaw([0.3, 0.5, 0.7]), position: Vec3([0.5, -0.4, 0.2]) };
    let back = Pose { rotation: pose.rotation.transpose(), position: -(pose.rotation.transpose() * pose.position) };
    let same = body.transformed(pose).transformed(back);
    assert!((same.moment - body.moment).0.iter().all(|x| x.abs() < 1e-15));
    let difference = same.second.full() - body.second.full();
    assert!(difference.0.concat().iter().all(|x| x.abs() < 1e-15), "{difference:?}");
}
