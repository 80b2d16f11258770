//! Spherical and free joints by statements of physics: they are the joints with one degree of freedom of which they can be built,
//! and the attitude of a floating mechanism is felt by gravity alone.
#![cfg(feature = "generic")]

use super::hybrid::Floating;
use crate::common::call::{bias_forces, energy, forward_dynamics, inverse_dynamics, mass_matrix};
use crate::common::comparison::Comparison;
use crate::common::random::{Random, State};
use crate::common::styles::{inertia, placed};
use crate::common::traced::traced;
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, UnitQuaternion, Vector3};
use redysim::generic::{GenericMechanism, JointKind, Link, Model, Vec3};
use redysim::{Dispatch, Mechanism, VelocityCoordinates, redysim};
use redysim_model::{Function, Tree};

redysim! {
    /// A body on a spherical joint.
    struct Pendulum("models/spherical_pendulum.toml");
}

/// A joint with several degrees of freedom between an arm that carries it and one that it carries, and the same with links without
/// mass on joints with one degree of freedom instead: along x, y and z for a free joint, then about z, y and x.
struct Pair {
    joint: JointKind,
    whole: GenericMechanism,
    chain: GenericMechanism,
}

impl Pair {
    fn new(joint: JointKind) -> Pair {
        let tilt = |x: f64, y: f64, z: f64| *Rotation3::from_scaled_axis(Vector3::new(x, y, z)).matrix();
        let body = |link: Link, mass: f64| Link {
            mass,
            com: Vec3([0.1 * mass, -0.07, 0.05]),
            inertia: inertia(&tilt(0.3, -0.8, 0.5), [0.02, 0.03, 0.01 * mass]),
            ..link
        };
        let at = |turned: Matrix3<f64>, x: f64| placed(&turned, Vec3([x, 0.2, -0.1]));
        let carrier =
            Link { placement: at(tilt(0.4, 0.1, -0.7), 0.3), ..Link::new("carrier", None, JointKind::Revolute) };
        let (carrier, placement) = (body(carrier, 2.0), at(tilt(-0.9, 0.6, 0.2), -0.4));
        let arm = |parent| {
            let arm = Link::new("arm", Some(parent), JointKind::Revolute);
            body(Link { placement: at(tilt(0.5, 0.5, 1.1), 0.25), ..arm }, 0.8)
        };
        let model = |links: Vec<Link>| {
            let mut model = Model::new("pair", Vec3([1.2, -3.4, -9.0]));
            model.links = links;
            GenericMechanism::new(model)
        };
        let whole = body(Link { placement, ..Link::new("body", Some(0), joint) }, 1.5);
        let axes = [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0]), Vec3([0.0, 0.0, 1.0])];
        let [x, y, z] = axes;
        let slides = [x, y, z].map(|axis| (JointKind::Prismatic, axis));
        let turns = [z, y, x].map(|axis| (JointKind::Revolute, axis));
        let steps = match joint {
            JointKind::Free => [slides, turns].concat(),
            _ => turns.to_vec(),
        };
        let mut links = vec![carrier.clone()];
        for (kind, axis) in &steps {
            let number = links.len();
            links.push(Link { axis: *axis, ..Link::new(format!("step{number}"), Some(number - 1), *kind) });
        }
        links[1].placement = placement;
        let last = links.len() - 1;
        links[last] = body(links[last].clone(), 1.5);
        links.push(arm(last));
        Pair { joint, whole: model(vec![carrier, whole, arm(1)]), chain: model(links) }
    }

    /// The state of the whole joint where the chain is at `chain`, and T in v = T v', where v' are the chain's velocities.
    fn state(&self, chain: &State) -> (State, DMatrix<f64>) {
        let nv = self.chain.nv();
        // Where the three angles start.
        let angles = nv - 4;
        let [about_z, about_y, about_x] = [0, 1, 2].map(|i| chain.q[angles + i]);
        let [rz, ry, rx] = [(Vector3::z_axis(), about_z), (Vector3::y_axis(), about_y), (Vector3::x_axis(), about_x)]
            .map(|(axis, angle)| Rotation3::from_axis_angle(&axis, angle));
        let rotation = rz * ry * rx;
        let [along_z, along_y, along_x] =
            [(ry * rx).inverse() * Vector3::z(), rx.inverse() * Vector3::y(), Vector3::x()];
        let mut map = DMatrix::identity(nv, nv);
        map.fixed_view_mut::<3, 3>(angles, angles).copy_from(&Matrix3::from_columns(&[along_z, along_y, along_x]));
        // The derivative of T v' at constant v': each axis turns backwards in the axes of the joints beyond it.
        let [vz, vy, vx] = [0, 1, 2].map(|i| chain.v[angles + i]);
        let turned = [along_z * vz, along_y * vy, along_x * vx];
        let rate = -(turned[1] + turned[2]).cross(&turned[0]) - turned[2].cross(&turned[1]);
        let mut rates = DVector::zeros(nv);
        rates.fixed_rows_mut::<3>(angles).copy_from(&rate);
        let quaternion = UnitQuaternion::from_rotation_matrix(&rotation).coords;
        // Of another length than 1.
        let mut q = vec![chain.q[0]];
        if self.joint == JointKind::Free {
            let to_body = *rotation.inverse().matrix();
            map.fixed_view_mut::<3, 3>(1, 1).copy_from(&to_body);
            let linear = to_body * Vector3::from_row_slice(&chain.v[1..4]);
            let angular: Vector3<f64> = turned.iter().sum();
            rates.fixed_rows_mut::<3>(1).copy_from(&-angular.cross(&linear));
            q.extend_from_slice(&chain.q[1..4]);
        }
        q.extend(quaternion.iter().map(|x| 0.3 * x));
        q.push(chain.q[nv - 1]);
        let of = |values: &[f64]| &map * DVector::from_row_slice(values);
        let state = State { q, v: of(&chain.v).as_slice().to_vec(), a: (of(&chain.a) + rates).as_slice().to_vec() };
        (state, map)
    }

    fn assert_equal(&self) {
        let mut random = Random::new(1);
        let [mut forces, mut masses, mut biases, mut energies, mut accelerations] =
            ["inverse dynamics", "mass matrix", "bias forces", "energy", "forward dynamics"].map(Comparison::new);
        for _ in 0..200 {
            let mut chain = random.state(self.chain.nv());
            // Away from where the outer axes are parallel, at a quarter turn about the middle one.
            let middle = self.chain.nv() - 3;
            chain.q[middle] = random.within(1.2);
            let (State { q, v, a }, map) = self.state(&chain);
            let back = |forces: Vec<f64>| (map.transpose() * DVector::from_vec(forces)).as_slice().to_vec();
            let tau = inverse_dynamics(&self.whole, &q, &v, &a);
            let of_chain = inverse_dynamics(&self.chain, &chain.q, &chain.v, &chain.a);
            forces.add(&back(tau), &of_chain);
            let matrix = mass_matrix(&self.whole, &q).concat();
            let matrix = DMatrix::from_row_slice(v.len(), v.len(), &matrix);
            masses.add((map.transpose() * &matrix * &map).as_slice(), &mass_matrix(&self.chain, &chain.q).concat());
            let [whole, parts] = [energy(&self.whole, &q, &v), energy(&self.chain, &chain.q, &chain.v)];
            energies.add(&[whole.kinetic, whole.potential], &[parts.kinetic, parts.potential]);
            // Where the chain does not accelerate, the joint does, by Ṫ v'.
            let zero = State { a: vec![0.0; v.len()], q: chain.q.clone(), v: chain.v.clone() };
            let (at_zero, _) = self.state(&zero);
            let of_rates = matrix * DVector::from_vec(at_zero.a);
            let bias = of_rates + DVector::from_vec(bias_forces(&self.whole, &q, &v));
            biases.add(&back(bias.as_slice().to_vec()), &bias_forces(&self.chain, &chain.q, &chain.v));
            // Forces τ on the joint are Tᵀ τ on the chain, whose accelerations the joint has by T.
            let tau = random.vector(v.len(), 5.0);
            let found = forward_dynamics(&self.chain, &chain.q, &chain.v, &back(tau.clone()));
            let (expected, _) = self.state(&State { a: found, q: chain.q.clone(), v: chain.v.clone() });
            accelerations.add(&forward_dynamics(&self.whole, &q, &v, &tau), &expected.a);
        }
        // Components that are 1e-6 of the largest have ten digits less than it: 1e-10 at most, a few in practice.
        [forces, masses, biases, energies].iter().for_each(|comparison| comparison.assert_within(2e-11));
        // And the condition of the mass matrix, 1e3.
        accelerations.assert_within(1e-9);
    }
}

#[test]
fn a_free_joint_is_three_prismatic_and_three_revolute_ones() {
    Pair::new(JointKind::Free).assert_equal();
}

#[test]
fn a_spherical_joint_is_three_revolute_ones() {
    Pair::new(JointKind::Spherical).assert_equal();
}

/// Without gravity, by the expressions of compiled code and by the generic path.
#[test]
fn the_pose_of_a_floating_base_is_felt_by_gravity_alone() {
    let mut random = Random::new(2);
    let mut model = Model::load("models/kr5_floating.toml").expect("a valid model").model;
    model.gravity = Vec3::zero();
    let traced = traced(&Tree::new(&model), &[Function::InverseDynamics, Function::MassMatrix]);
    let function = |name: Function| &traced.iter().find(|traced| traced.function == name).expect("traced").expressions;
    let generic = GenericMechanism::new(model);
    for _ in 0..50 {
        let State { v, a, .. } = random.state(Floating::NV);
        let arm = random.vector(6, 3.0);
        let [here, there] = [(); 2].map(|()| [random.vector(7, 5.0), arm.clone()].concat());
        let tau = |q: &[f64]| function(Function::InverseDynamics).evaluate(&[q, &v, &a]);
        assert_eq!(tau(&here), tau(&there));
        assert_eq!(inverse_dynamics(&generic, &here, &v, &a), inverse_dynamics(&generic, &there, &v, &a));
        let matrix = |q: &[f64]| function(Function::MassMatrix).evaluate(&[q]);
        assert_eq!(matrix(&here), matrix(&there));
        assert_eq!(Floating::mass_matrix(&array(&here)), Floating::mass_matrix(&array(&there)), "with gravity as well");
    }
}

fn array<const N: usize>(values: &[f64]) -> [f64; N] {
    values.try_into().expect("as many values")
}

/// Six sine-cosine pairs are those of the arm: a quaternion needs none.
#[test]
fn spherical_and_free_joints_take_no_more_operations_than_they_did() {
    const {
        assert!(Floating::OPS.inverse_dynamics.flops() <= 587);
        assert!(Floating::OPS.hybrid_dynamics.flops() <= 1005);
        assert!(Floating::OPS.mass_matrix.flops() <= 310);
        assert!(Floating::OPS.inverse_dynamics.trig == 6 && Floating::OPS.hybrid_dynamics.trig == 6);
        assert!(Floating::OPS.mass_matrix.trig <= 6);
        assert!(Pendulum::OPS.inverse_dynamics.flops() <= 75);
        assert!(Pendulum::OPS.forward_dynamics.flops() <= 79);
        assert!(Pendulum::OPS.mass_matrix.flops() == 0);
        assert!(Pendulum::OPS.inverse_dynamics.trig == 0 && Pendulum::OPS.forward_dynamics.trig == 0);
    }
}

#[test]
fn names_are_those_of_the_joint_and_of_its_components() {
    let arm = ["joint1", "joint2", "joint3", "joint4", "joint5", "joint6"];
    let pose = ["base.x", "base.y", "base.z", "base.qx", "base.qy", "base.qz", "base.qw"];
    let twist = ["base.vx", "base.vy", "base.vz", "base.wx", "base.wy", "base.wz"];
    assert_eq!((Floating::NQ, Floating::NV, Floating::NL, Floating::NJ), (13, 12, 7, 7));
    assert_eq!(Floating::JOINT_NAMES[0], "base");
    assert_eq!(Floating::JOINT_NAMES[1..], arm);
    assert_eq!(Floating::COORDINATE_NAMES[..], [&pose[..], &arm].concat());
    assert_eq!(Floating::VELOCITY_NAMES[..], [&twist[..], &arm].concat());
    assert_eq!(Floating::ACTUATED[..], [[false; 6], [true; 6]].concat());
    assert_eq!((Pendulum::NQ, Pendulum::NV, Pendulum::NJ), (4, 3, 1));
    assert_eq!(Pendulum::COORDINATE_NAMES, ["pivot.qx", "pivot.qy", "pivot.qz", "pivot.qw"]);
    assert_eq!(Pendulum::VELOCITY_NAMES, ["pivot.wx", "pivot.wy", "pivot.wz"]);
    assert_eq!(Pendulum::ACTUATED, [true; 3]);
}

#[test]
fn both_paths_name_coordinates_and_velocities_alike() {
    fn names(mechanism: &impl Mechanism) -> Vec<String> {
        let all = |count: usize, name: &dyn Fn(usize) -> Option<String>| {
            assert_eq!(name(count), None, "past the last");
            (0..count).map(|i| name(i).expect("a name")).collect::<Vec<_>>()
        };
        [
            all(mechanism.nq(), &|i| mechanism.coordinate_name(i).map(String::from)),
            all(mechanism.nv(), &|i| mechanism.velocity_name(i).map(String::from)),
        ]
        .concat()
    }
    let [floating, pendulum] = ["kr5_floating", "spherical_pendulum"].map(crate::common::models::generic);
    assert_eq!(names(&floating), names(&Floating));
    assert_eq!(names(&Floating), [&Floating::COORDINATE_NAMES[..], &Floating::VELOCITY_NAMES].concat());
    assert_eq!(names(&pendulum), names(&Pendulum));
}

#[test]
fn a_velocity_has_a_coordinate_of_its_own_where_its_joint_has_one() {
    fn coordinates(mechanism: &impl Mechanism) -> Vec<Option<usize>> {
        (0..=mechanism.nv()).map(|velocity| mechanism.coordinate_of_velocity(velocity)).collect()
    }
    let expected: Vec<Option<usize>> = [vec![None; 6], (7..13).map(Some).collect(), vec![None]].concat();
    let [floating, pendulum] = ["kr5_floating", "spherical_pendulum"].map(crate::common::models::generic);
    assert_eq!(coordinates(&Floating), expected);
    assert_eq!(coordinates(&floating), expected);
    assert_eq!(coordinates(&Pendulum), [None; 4]);
    assert_eq!(coordinates(&pendulum), [None; 4]);
}

#[test]
fn a_mechanism_reports_which_coordinates_each_of_its_velocities_changes() {
    fn moved(mechanism: &impl Mechanism) -> Vec<VelocityCoordinates> {
        (0..=mechanism.nv()).map(|velocity| mechanism.coordinates_of_velocity(velocity)).collect()
    }
    use VelocityCoordinates::{One, Position, Quaternion, Unknown};
    let expected = [vec![Position(0); 3], vec![Quaternion(3); 3], (7..13).map(One).collect(), vec![Unknown]].concat();
    let [floating, pendulum] = ["kr5_floating", "spherical_pendulum"].map(crate::common::models::generic);
    assert_eq!(moved(&Floating), expected);
    assert_eq!(moved(&Floating.dispatched()), expected);
    assert_eq!(moved(&floating), expected);
    for spherical in [moved(&Pendulum), moved(&pendulum)] {
        assert_eq!(spherical, [Quaternion(0), Quaternion(0), Quaternion(0), Unknown]);
    }
}

#[test]
fn a_mechanism_reports_which_of_its_velocities_have_an_actuator() {
    fn actuated(mechanism: &impl Mechanism) -> Vec<bool> {
        (0..=mechanism.nv()).map(|velocity| mechanism.is_actuated(velocity)).collect()
    }
    let [floating, pendulum] = ["kr5_floating", "spherical_pendulum"].map(crate::common::models::generic);
    let expected = [&Floating::ACTUATED[..], &[false]].concat();
    assert_eq!((expected[5], expected[6]), (false, true));
    assert_eq!(actuated(&Floating), expected);
    assert_eq!(actuated(&Floating.dispatched()), expected);
    assert_eq!(actuated(&floating), expected);
    assert_eq!(actuated(&Pendulum), [true, true, true, false]);
    assert_eq!(actuated(&pendulum), [true, true, true, false]);
}
