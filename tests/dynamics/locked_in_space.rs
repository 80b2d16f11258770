//! Joints with several degrees of freedom that are locked: a floating arm is one that stands where its base is held.
#![cfg(feature = "generic")]

use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::common::random::{Random, State};
use nalgebra::{Matrix3, Quaternion, Rotation3, Unit, UnitQuaternion, Vector3};
use redysim::generic::{
    CutKind, CutSide, Frame, GenericMechanism, Inertia, JointKind, Link, Loop, Mat3, Model, Pose, Vec3,
};
use redysim::{
    BiasForces, ForwardDynamics, InverseDynamics, LinkKinematics, LinkState, MassMatrix, MechanicalEnergy, redysim,
};
use redysim_codegen::functions::trace;
use redysim_model::denoc::{Untraced, evaluate};
use redysim_model::joint::EulerSequence;
use redysim_model::rotation::roll_pitch_yaw;
use redysim_model::{Function, LockError, Tree};
use std::array;

redysim! {
    /// KR5 whose platform is held, at a quaternion of another length than 1.
    struct Held(
        "models/kr5_floating.toml",
        locked = { base = [0.3, -0.2, 0.5, 0.1, -0.4, 0.2, 0.7] },
        functions = [inverse_dynamics, forward_dynamics, mass_matrix, bias_forces, energy, link_kinematics]
    );
}

const POSITION: [f64; 3] = [0.3, -0.2, 0.5];
/// (w, x, y, z).
const QUATERNION: [f64; 4] = [0.7, 0.1, -0.4, 0.2];

/// The axes of the platform.
fn axes() -> Matrix3<f64> {
    let [w, x, y, z] = QUATERNION;
    *UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).to_rotation_matrix().matrix()
}

/// KR5 as it stands on the ground, with gravity as the platform has it.
fn standing() -> GenericMechanism {
    let mut model = Model::load("models/kr5.toml").expect("a valid model").model;
    model.gravity = Vec3((axes().transpose() * Vector3::from(model.gravity.0)).into());
    GenericMechanism::new(model)
}

#[test]
fn a_floating_arm_held_at_its_base_is_a_standing_one_in_turned_gravity() {
    let (standing, mut random) = (standing(), Random::new(1));
    assert_eq!((Held::NQ, Held::NV, Held::NL, Held::NJ), (6, 6, 7, 6));
    let model = Model::load("models/kr5_floating.toml").expect("a valid model").model;
    let [w, x, y, z] = QUATERNION;
    let base = [POSITION[0], POSITION[1], POSITION[2], x, y, z, w];
    let held = GenericMechanism::new(model.locked(&[("base", base)]).expect("seven numbers"));
    let [mut forces, mut masses, mut biases, mut accelerations, mut energies, mut generic] =
        ["inverse dynamics", "mass matrix", "bias", "forward dynamics", "kinetic energy", "generic path"]
            .map(Comparison::new);
    for _ in 0..200 {
        let State { q, v, a } = random.state(6);
        let [fixed_q, fixed_v, fixed_a] = [&q, &v, &a].map(|x| <[f64; 6]>::try_from(&x[..]).expect("six"));
        let tau = Held::inverse_dynamics(&fixed_q, &fixed_v, &fixed_a);
        forces.add(&tau, &standing.inverse_dynamics(&q, &v, &a));
        generic.add(&held.inverse_dynamics(&q, &v, &a), &tau);
        masses.add(Held::mass_matrix(&fixed_q).as_flattened(), &standing.mass_matrix(&q).concat());
        biases.add(&Held::bias_forces(&fixed_q, &fixed_v), &standing.bias_forces(&q, &v));
        let found = Held::forward_dynamics(&fixed_q, &fixed_v, &tau);
        accelerations.add(&found, &standing.forward_dynamics(&q, &v, &tau.to_vec()));
        energies.add(&[Held::energy(&fixed_q, &fixed_v).kinetic], &[standing.energy(&q, &v).kinetic]);
    }
    // A few roundings, of which small components keep fewer digits; accelerations by the condition of the matrix, 1e7.
    [forces, masses, biases, energies, generic].iter().for_each(|comparison| comparison.assert_within(1e-11));
    accelerations.assert_within(1e-8);
}

#[test]
fn links_stand_where_the_platform_is_held() {
    let (standing, axes, mut random) = (standing(), axes(), Random::new(2));
    let mut links = Comparison::new("links");
    for _ in 0..50 {
        let State { q, v, .. } = random.state(6);
        let array = |x: &[f64]| <[f64; 6]>::try_from(x).expect("six");
        let (held, expected) = (Held::link_kinematics(&array(&q), &array(&v)), standing.link_kinematics(&q, &v));
        let turned = |vector: [f64; 3]| axes * Vector3::from(vector);
        let numbers = |link: &LinkState<f64>| {
            let vectors = [link.origin, link.com, link.velocity, link.angular_velocity];
            [link.rotation.concat(), vectors.concat()].concat()
        };
        assert_eq!(held[0].origin, POSITION, "the platform");
        for (held, expected) in held[1..].iter().zip(&expected) {
            let rotation = axes * Matrix3::from_fn(|i, j| expected.rotation[i][j]);
            let at = |vector| turned(vector) + Vector3::from(POSITION);
            let vectors =
                [at(expected.origin), at(expected.com), turned(expected.velocity), turned(expected.angular_velocity)];
            let expected: Vec<f64> = rotation.transpose().iter().chain(vectors.iter().flatten()).copied().collect();
            links.add(&numbers(held), &expected);
        }
    }
    // Numbers of up to a few metres and metres per second, in which small ones keep fewer digits.
    links.assert_within(1e-9);
}

/// An arm, a body on `joint`, which is locked or fixed, and a tool on it; a frame on each, and a cut between the tool and the
/// ground.
fn on_an_arm(joint: Link) -> Model {
    let part = |name: &str, parent, joint| Link {
        mass: 1.3,
        com: Vec3([0.1, -0.2, 0.05]),
        inertia: Inertia { xx: 0.03, yy: 0.05, zz: 0.04, xy: 0.004, yz: -0.003, xz: 0.002 },
        ..Link::new(name, parent, joint)
    };
    let at = |x: f64| Pose { rotation: roll_pitch_yaw([0.3, x, -0.8]), position: Vec3([0.2, -x, 0.4]) };
    let arm = Link { axis: Vec3([0.6, 0.0, 0.8]), ..part("arm", None, JointKind::Revolute) };
    let body = Link { name: "body".into(), joint_name: "body".into(), parent: Some(0), ..joint };
    let body = Link { mass: 0.9, com: Vec3([0.05, 0.1, -0.2]), inertia: arm.inertia, ..body };
    let tool = Link { placement: at(0.7), ..part("tool", Some(1), JointKind::Spherical) };
    let side = |link, x: f64| CutSide { link, point: Vec3([x, 0.3, -0.1]), axis: Vec3([0.0, 0.0, 1.0]) };
    let frame = |link: usize| Frame { name: format!("frame{link}"), link: Some(link), placement: at(link as f64) };
    Model {
        links: vec![arm, body, tool],
        loops: vec![Loop { name: "cut".into(), joint: CutKind::Revolute, a: side(None, 0.5), b: side(Some(2), -0.2) }],
        frames: (0..3).map(frame).collect(),
        ..Model::new("arm", Vec3([0.4, -1.1, -9.6]))
    }
}

/// Where the joint, of which `motion` is the pose at the coordinates `values`, is locked, the body is fixed at that pose: all
/// functions agree to a few roundings, on the run-time path and traced; accelerations times the condition of a matrix of
/// ordinary size.
fn assert_locked_is_fixed(joint: Link, values: &[f64], (turned, moved): (Rotation3<f64>, Vector3<f64>)) {
    let placement = Pose { rotation: roll_pitch_yaw([-0.4, 0.9, 0.2]), position: Vec3([0.3, 0.1, -0.2]) };
    let motion =
        Pose { rotation: Mat3(array::from_fn(|i| array::from_fn(|j| turned[(i, j)]))), position: Vec3(moved.into()) };
    let name = format!("{:?} at {values:?}", joint.joint);
    let fixed = Link {
        placement: Pose {
            rotation: placement.rotation * motion.rotation,
            position: placement.position + placement.rotation * motion.position,
        },
        ..Link::new("body", Some(0), JointKind::Fixed)
    };
    let locked = on_an_arm(Link { placement, ..joint }).locked(&[("body", values)]).expect("as many numbers");
    let [locked, fixed] = [locked, on_an_arm(fixed)].map(|model| Tree::new(&model));
    assert_eq!((locked.nq(), locked.nv()), (fixed.nq(), fixed.nv()), "{name}");
    let traced = trace(&locked).expect("no pass changes a value");
    let mut random = Random::new(9);
    for function in Function::ALL.iter().copied().filter(|function| !function.needs_passive_joints()) {
        let mut comparisons = ["run-time path", "traced"]
            .map(|path| Comparison::new(format!("{name}, {path} {function:?}")).with_floor(1.0));
        for _ in 0..10 {
            let arguments: Vec<Vec<f64>> = function
                .signature()
                .arguments
                .iter()
                .map(|argument| random.vector(fixed.argument_length(*argument), 2.0))
                .collect();
            let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
            let expected = evaluate(function, &fixed, &Untraced, &arguments);
            comparisons[0].add(&evaluate(function, &locked, &Untraced, &arguments), &expected);
            let of_locked = traced.iter().find(|traced| traced.function == function).expect("every function");
            comparisons[1].add(&of_locked.expressions.evaluate(&arguments), &expected);
        }
        let tolerance = if function == Function::ForwardDynamics { 1e-12 } else { 1e-13 };
        comparisons.iter().for_each(|comparison| comparison.assert_within(tolerance));
    }
}

#[test]
fn a_spherical_joint_that_is_locked_is_a_link_fixed_at_its_quaternion() {
    let [w, x, y, z] = QUATERNION;
    let turned = Rotation3::from_matrix_unchecked(axes());
    assert_locked_is_fixed(Link::new("body", None, JointKind::Spherical), &[x, y, z, w], (turned, Vector3::zeros()));
}

#[test]
fn a_planar_joint_that_is_locked_is_a_link_fixed_where_it_slid_and_turned() {
    let turned = Rotation3::from_axis_angle(&Vector3::z_axis(), 0.7);
    let joint = Link::new("body", None, JointKind::Planar);
    assert_locked_is_fixed(joint, &[0.2, -0.5, 0.7], (turned, Vector3::new(0.2, -0.5, 0.0)));
}

#[test]
fn a_helical_joint_that_is_locked_is_a_link_fixed_where_its_screw_led() {
    let (axis, offset, pitch, at) = (Vector3::new(0.0, 0.6, 0.8), 0.3, 0.25, 1.1);
    let joint = Link { axis: Vec3(axis.into()), offset, pitch, ..Link::new("body", None, JointKind::Helical) };
    let turned = Rotation3::from_axis_angle(&Unit::new_unchecked(axis), offset + at);
    assert_locked_is_fixed(joint, &[at], (turned, axis * (pitch * (offset + at))));
}

#[test]
fn a_universal_joint_that_is_locked_is_a_link_fixed_where_it_turned_about_x_and_then_y() {
    let turned =
        Rotation3::from_axis_angle(&Vector3::x_axis(), 0.4) * Rotation3::from_axis_angle(&Vector3::y_axis(), -1.2);
    let joint = Link::new("body", None, JointKind::Universal);
    assert_locked_is_fixed(joint, &[0.4, -1.2], (turned, Vector3::zeros()));
}

#[test]
fn a_cylindrical_joint_that_is_locked_is_a_link_fixed_where_it_slid_and_turned_about_its_axis() {
    let axis = Vector3::new(0.48, -0.64, 0.6);
    let joint = Link { axis: Vec3(axis.into()), ..Link::new("body", None, JointKind::Cylindrical) };
    let turned = Rotation3::from_axis_angle(&Unit::new_unchecked(axis), 0.9);
    assert_locked_is_fixed(joint, &[-0.35, 0.9], (turned, -0.35 * axis));
}

/// Rotations about the axes of a sequence, each as those before it have turned it.
fn turned_by(axes: [Unit<Vector3<f64>>; 3], angles: [f64; 3]) -> Rotation3<f64> {
    let turns = axes.iter().zip(angles).map(|(axis, angle)| Rotation3::from_axis_angle(axis, angle));
    turns.fold(Rotation3::identity(), |turned, turn| turned * turn)
}

#[test]
fn a_spherical_joint_in_euler_angles_that_is_locked_is_a_link_fixed_at_them() {
    let (x, z, angles) = (Vector3::x_axis(), Vector3::z_axis(), [0.5, -0.8, 1.3]);
    let joint = Link { coordinates: Some(EulerSequence::Zxz), ..Link::new("body", None, JointKind::Spherical) };
    assert_locked_is_fixed(joint, &angles, (turned_by([z, x, z], angles), Vector3::zeros()));
}

#[test]
fn a_free_joint_in_euler_angles_that_is_locked_is_a_link_fixed_at_its_position_and_them() {
    let (x, y, z) = (Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis());
    let (position, angles) = (Vector3::new(0.3, -0.2, 0.5), [0.5, -0.8, 1.3]);
    let joint = Link { coordinates: Some(EulerSequence::Zxy), ..Link::new("body", None, JointKind::Free) };
    let values: Vec<f64> = position.iter().copied().chain(angles).collect();
    assert_locked_is_fixed(joint, &values, (turned_by([z, x, y], angles), position));
}

#[test]
fn a_wrong_number_of_coordinates_is_refused() {
    let (floating, pendulum) = (generic("kr5_floating"), generic("spherical_pendulum"));
    let refused = |joint: &str, values: &[f64], mechanism: &GenericMechanism| {
        mechanism.model().locked(&[(joint, values)]).expect_err("another count")
    };
    let fault = refused("base", &[0.0; 6], &floating);
    assert_eq!(fault, LockError::WrongCount { joint: "base".into(), expected: 7, found: 6 });
    assert_eq!(fault.to_string(), "joint `base` has 7 coordinates, but is locked at 6");
    let fault = floating.model().locked(&[("base", 0.5)]).expect_err("one number");
    assert_eq!(fault, LockError::WrongCount { joint: "base".into(), expected: 7, found: 1 });
    let fault = refused("pivot", &[0.0, 0.0, 1.0], &pendulum);
    assert_eq!(fault, LockError::WrongCount { joint: "pivot".into(), expected: 4, found: 3 });
    let fault = refused("joint1", &[0.1, 0.2], &floating);
    assert_eq!(fault, LockError::WrongCount { joint: "joint1".into(), expected: 1, found: 2 });
}

#[test]
fn a_quaternion_of_zero_is_refused() {
    let (floating, pendulum) = (generic("kr5_floating"), generic("spherical_pendulum"));
    let fault =
        floating.model().locked(&[("base", [1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 0.0])]).expect_err("a zero quaternion");
    assert_eq!(fault, LockError::NoOrientation { joint: "base".into() });
    assert_eq!(fault.to_string(), "joint `base` cannot be locked at a zero quaternion: give one that is not zero");
    let fault = pendulum.model().locked(&[("pivot", [0.0; 4])]).expect_err("a zero quaternion");
    assert_eq!(fault, LockError::NoOrientation { joint: "pivot".into() });
}

#[test]
fn what_is_not_finite_is_refused_before_it_is_an_orientation() {
    let floating = generic("kr5_floating");
    for value in [f64::NAN, f64::INFINITY] {
        let fault =
            floating.model().locked(&[("base", [0.0, 0.0, 0.0, 0.0, value, 0.0, 1.0])]).expect_err("not finite");
        assert!(matches!(fault, LockError::NotFinite { .. }), "{fault:?}");
    }
}

/// The same in a model's file, with the place.
#[test]
fn files_that_lock_at_no_orientation_or_at_a_wrong_count_are_refused() {
    let text = std::fs::read_to_string("models/kr5_floating.toml").expect("it is there");
    let refused = |value: &str| {
        let options = format!("locked = {{ base = {value} }}");
        Model::from_toml_with(text.clone(), "kr5_floating.toml", &options).expect_err("not valid").to_string()
    };
    let message = refused("[0, 0, 0, 0, 0, 0, 0]");
    assert!(message.contains("quaternion"), "{message}");
    let message = refused("[0, 0, 0, 1]");
    assert!(message.contains('7') && message.contains('4'), "{message}");
    let message = refused("0.5");
    assert!(message.contains('7'), "{message}");
}
