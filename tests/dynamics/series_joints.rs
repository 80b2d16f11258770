//! Joints that are several joints in series: universal, cylindrical and planar ones, and spherical and free ones with
//! Euler angles.
#![cfg(feature = "generic")]

use crate::common::call::{bias_forces, energy, forward_dynamics, gravity_forces, inverse_dynamics, mass_matrix};
use crate::common::models::generic;
use crate::common::random::{Random, State};
use crate::common::styles::{inertia, placed};
use nalgebra::{Rotation3, Unit, UnitQuaternion, Vector3};
use redysim::Real;
use redysim::generic::{GenericMechanism, JointKind, Link, Model, Vec3};
use redysim::{ConfigurationSpace, Mechanism, redysim};
use redysim_model::joint::EulerSequence;

redysim! {
    /// A universal, a cylindrical and a planar joint, and a spherical and a free one with Euler angles.
    struct Series("models/test/joints_in_series.toml", functions = [inverse_dynamics]);
}

redysim! {
    /// The same with joints held.
    struct Held(
        "models/test/joints_in_series.toml",
        functions = [inverse_dynamics],
        locked = { swivel = ["30 deg", -0.4], wrist = [0.3, "90 deg", 0.7], sleeve = [0.2, 1.1] }
    );
}

const X: Vec3<f64> = Vec3([1.0, 0.0, 0.0]);
const Y: Vec3<f64> = Vec3([0.0, 1.0, 0.0]);
const Z: Vec3<f64> = Vec3([0.0, 0.0, 1.0]);

/// A chain of three links of which the middle one is on the joint of `link`; and the same with a link without mass for each
/// of `steps` but the last.
fn pair(link: Link, steps: &[(JointKind, Vec3<f64>)]) -> [GenericMechanism; 2] {
    let tilted = |x: f64, y: f64, z: f64| *Rotation3::from_scaled_axis(Vector3::new(x, y, z)).matrix();
    let body = |link: Link, mass: f64| Link {
        mass,
        com: Vec3([0.1 * mass, -0.07, 0.05]),
        inertia: inertia(&tilted(0.3, -0.8, 0.5), [0.02, 0.03, 0.01 * mass]),
        ..link
    };
    let placement = placed(&tilted(-0.9, 0.6, 0.2), Vec3([-0.4, 0.2, -0.1]));
    let carrier = body(Link::new("carrier", None, JointKind::Revolute), 2.0);
    let arm = |parent| body(Link { placement, ..Link::new("arm", Some(parent), JointKind::Prismatic) }, 0.8);
    let model =
        |links: Vec<Link>| GenericMechanism::new(Model { links, ..Model::new("pair", Vec3([1.2, -3.4, -9.0])) });
    let whole = body(Link { placement, parent: Some(0), ..link }, 1.5);
    let mut chain = vec![carrier.clone()];
    for &(kind, axis) in steps {
        let number = chain.len();
        chain.push(Link { axis, ..Link::new(format!("step{number}"), Some(number - 1), kind) });
    }
    chain[1].placement = placement;
    let last = chain.len() - 1;
    chain[last] = body(chain[last].clone(), 1.5);
    chain.push(arm(last));
    [model(vec![carrier, whole, arm(1)]), model(chain)]
}

/// All functions of both are the same to the bit.
fn assert_same([whole, chain]: [GenericMechanism; 2]) {
    let mut random = Random::new(1);
    assert_eq!((whole.nq(), whole.nv()), (chain.nq(), chain.nv()));
    for _ in 0..20 {
        let State { q, v, a } = random.state(whole.nv());
        assert_eq!(inverse_dynamics(&whole, &q, &v, &a), inverse_dynamics(&chain, &q, &v, &a));
        assert_eq!(forward_dynamics(&whole, &q, &v, &a), forward_dynamics(&chain, &q, &v, &a));
        assert_eq!(mass_matrix(&whole, &q), mass_matrix(&chain, &q));
        assert_eq!(bias_forces(&whole, &q, &v), bias_forces(&chain, &q, &v));
        assert_eq!(energy(&whole, &q, &v), energy(&chain, &q, &v));
        assert_eq!(whole.coordinate_rates(&q, &v), v);
    }
}

#[test]
fn a_universal_joint_is_two_revolute_ones_about_x_and_y() {
    let turns = [(JointKind::Revolute, X), (JointKind::Revolute, Y)];
    assert_same(pair(Link::new("body", None, JointKind::Universal), &turns));
}

#[test]
fn a_cylindrical_joint_is_a_prismatic_and_a_revolute_one_on_the_same_axis() {
    let axis = Vec3([0.6, 0.0, 0.8]);
    let steps = [(JointKind::Prismatic, axis), (JointKind::Revolute, axis)];
    assert_same(pair(Link { axis, ..Link::new("body", None, JointKind::Cylindrical) }, &steps));
}

#[test]
fn a_planar_joint_is_two_prismatic_ones_along_x_and_y_and_a_revolute_one_about_z() {
    let steps = [(JointKind::Prismatic, X), (JointKind::Prismatic, Y), (JointKind::Revolute, Z)];
    assert_same(pair(Link::new("body", None, JointKind::Planar), &steps));
}

#[test]
fn euler_angles_are_three_revolute_joints_and_a_position_three_prismatic_ones_before_them() {
    for (name, sequence) in EulerSequence::ALL {
        let axis = |letter: char| [X, Y, Z]["xyz".find(letter).expect("an axis")];
        let turns: Vec<_> = name.chars().map(|letter| (JointKind::Revolute, axis(letter))).collect();
        let coordinates = Some(sequence);
        assert_same(pair(Link { coordinates, ..Link::new("body", None, JointKind::Spherical) }, &turns));
        let slides = [X, Y, Z].map(|axis| (JointKind::Prismatic, axis));
        let steps = [&slides[..], &turns].concat();
        assert_same(pair(Link { coordinates, ..Link::new("body", None, JointKind::Free) }, &steps));
    }
}

/// Rz(φ) Rx(θ) Ry(ψ) of the sequence zxy, and the quaternion of that rotation: the same forces of gravity, mapped by the rates
/// of the angles.
#[test]
fn a_free_joint_with_euler_angles_stands_where_its_quaternion_does() {
    let free = |coordinates| {
        let body = Link {
            coordinates,
            mass: 2.0,
            com: Vec3([0.1, 0.2, -0.3]),
            inertia: inertia(Rotation3::identity().matrix(), [0.3, 0.2, 0.4]),
            ..Link::new("body", None, JointKind::Free)
        };
        GenericMechanism::new(Model { links: vec![body], ..Model::new("body", Vec3([0.0, 0.0, -9.81])) })
    };
    let [angles, quaternion] = [Some(EulerSequence::Zxy), None].map(free);
    let (phi, theta, psi) = (0.7, -0.4, 1.9);
    let about = |axis: Unit<Vector3<f64>>, angle| UnitQuaternion::from_axis_angle(&axis, angle);
    let turned = about(Vector3::z_axis(), phi) * about(Vector3::x_axis(), theta) * about(Vector3::y_axis(), psi);
    let position = [0.3, -0.2, 0.5];
    let by_angles = gravity_forces(&angles, &[&position[..], &[phi, theta, psi]].concat());
    let by_quaternion = gravity_forces(&quaternion, &[&position[..], turned.coords.as_slice()].concat());
    // Forces in the frame of the joint, moments about its three axes.
    let (force, moment) = by_quaternion.split_at(3);
    let [force, moment] = [force, moment].map(|part| turned * Vector3::from_column_slice(part));
    let axes = [
        Vector3::z(),
        about(Vector3::z_axis(), phi) * Vector3::x(),
        about(Vector3::z_axis(), phi) * about(Vector3::x_axis(), theta) * Vector3::y(),
    ];
    let expected: Vec<f64> = force.iter().copied().chain(axes.map(|axis| axis.dot(&moment))).collect();
    let largest = by_angles.iter().zip(&expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
    assert!(largest < 1e-14 * 20.0, "{by_angles:?} {expected:?}");
}

#[test]
fn names_are_those_of_the_joint_and_of_its_coordinates() {
    let names = [
        "swivel.phi",
        "swivel.theta",
        "sleeve.displacement",
        "sleeve.angle",
        "wrist.phi",
        "wrist.theta",
        "wrist.psi",
        "probe.x",
        "probe.y",
        "probe.z",
        "probe.phi",
        "probe.theta",
        "probe.psi",
        "carriage.x",
        "carriage.y",
        "carriage.angle",
    ];
    assert_eq!(Series::JOINT_NAMES, ["swivel", "sleeve", "wrist", "probe", "carriage"]);
    assert_eq!(Series::COORDINATE_NAMES, names);
    assert_eq!(Series::VELOCITY_NAMES, names);
    let series = generic("test/joints_in_series");
    for (i, name) in names.into_iter().enumerate() {
        assert_eq!((series.coordinate_name(i), series.velocity_name(i)), (Some(name), Some(name)));
        assert_eq!((series.coordinate_of_velocity(i), Series.coordinate_of_velocity(i)), (Some(i), Some(i)));
    }
}

#[test]
fn each_velocity_of_a_joint_may_have_an_actuator_of_its_own() {
    let [yes, no] = [true, false];
    let of_wrist_and_probe = [[no, no, no].as_slice(), &[no, yes, no, yes, yes, no]].concat();
    assert_eq!(Series::ACTUATED[..], [&[yes; 4][..], &of_wrist_and_probe, &[yes; 3]].concat());
    assert_eq!(generic("test/joints_in_series").tree().actuated(), Series::ACTUATED);
}

/// The forces that hold the joints are what the whole mechanism takes there at rest in them.
#[test]
fn a_joint_in_series_is_held_where_the_whole_mechanism_has_it() {
    let mut random = Random::new(5);
    let (swivel, sleeve, wrist) = ([30f64.to_radians(), -0.4], [0.2, 1.1], [0.3, 90f64.to_radians(), 0.7]);
    let held = [(0, swivel.as_slice()), (2, &sleeve), (4, &wrist)];
    for _ in 0..20 {
        let State { q, v, a } = random.state(Held::NV);
        let all = |free: &[f64], values: bool| {
            let mut all = vec![0.0; Series::NV];
            all[7..].copy_from_slice(free);
            for (first, held) in held.iter().filter(|_| values) {
                all[*first..first + held.len()].copy_from_slice(held);
            }
            all
        };
        let of_whole = inverse_dynamics(&Series, &all(&q, true), &all(&v, false), &all(&a, false));
        let found = inverse_dynamics(&Held, &q, &v, &a);
        let largest = found.iter().fold(0.0_f64, |most, x| Real::maximum(most, x.abs()));
        let error = found.iter().zip(&of_whole[7..]).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
        assert!(error < 1e-13 * largest, "{found:?} {of_whole:?}");
    }
}
