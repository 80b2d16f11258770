//! A mechanism with locked joints computes what the whole one does with those joints at rest, for less.

use crate::common::comparison::Comparison;
use crate::common::random::{Random, State};
use crate::robots::{Gantry, Kr5};
use nalgebra::{Matrix5, Vector5};
use redysim::{LinkState, redysim};

redysim! {
    /// Whose hand does not turn.
    struct Locked("models/kr5.toml", locked = { joint6 = "40 deg" });
}

redysim! {
    /// Whose shoulder does not turn: what follows is part of the ground.
    struct Stump("models/kr5.toml", locked = { joint1 = -0.7, joint4 = 0.3 }, functions = [inverse_dynamics]);
}

redysim! {
    struct LockedGantry(
        "models/test/gantry.toml",
        locked = { along = 0.25, gripper = -0.8, camera = "90 deg" },
        functions = [inverse_dynamics, link_kinematics]
    );
}

redysim! {
    /// Two fingers in the plane, of which all but the root are locked.
    struct Pendulum(
        "models/gripper.toml",
        locked = { joint2 = 0.5, joint3 = -0.9, joint4 = 2.0 },
        functions = [inverse_dynamics, forward_dynamics]
    );
}

const SIXTH: f64 = 40.0 * std::f64::consts::PI / 180.0;

/// A state of the whole robot in which the last joint rests at its place, and the same of the others.
fn states(random: &mut Random) -> ([[f64; 6]; 3], [[f64; 5]; 3]) {
    let State { q, v, a } = random.state(6);
    let mut whole = [q, v, a].map(|x| <[f64; 6]>::try_from(x).unwrap());
    (whole[0][5], whole[1][5], whole[2][5]) = (SIXTH, 0.0, 0.0);
    (whole, whole.map(|x| [x[0], x[1], x[2], x[3], x[4]]))
}

fn first_five<T: Copy>(x: [T; 6]) -> [T; 5] {
    [x[0], x[1], x[2], x[3], x[4]]
}

#[test]
fn sizes_and_names_are_those_of_the_joints_that_are_left() {
    assert_eq!((Locked::NQ, Locked::NV, Locked::NL), (5, 5, 6));
    assert_eq!(Locked::JOINT_NAMES, ["joint1", "joint2", "joint3", "joint4", "joint5"]);
    assert_eq!(Locked::LINK_NAMES, Kr5::LINK_NAMES);
    assert_eq!(Stump::JOINT_NAMES, ["joint2", "joint3", "joint5", "joint6"]);
}

#[test]
fn joint_forces_mass_matrix_and_energies_are_those_of_the_whole_robot() {
    let mut random = Random::new(7);
    let mut forces = Comparison::new("joint forces");
    let mut gravity = Comparison::new("gravity forces");
    let mut masses = Comparison::new("mass matrix");
    let mut energies = Comparison::new("energies");
    let mut stump = Comparison::new("joint forces beyond a locked shoulder");
    for _ in 0..200 {
        let ([q, v, a], [ql, vl, al]) = states(&mut random);
        forces.add(&Locked::inverse_dynamics(&ql, &vl, &al), &first_five(Kr5::inverse_dynamics(&q, &v, &a)));
        gravity.add(&Locked::gravity_forces(&ql), &first_five(Kr5::gravity_forces(&q)));
        let block = first_five(Kr5::mass_matrix(&q)).map(first_five);
        masses.add(Locked::mass_matrix(&ql).as_flattened(), block.as_flattened());
        let [locked, whole] = [Locked::energy(&ql, &vl), Kr5::energy(&q, &v)].map(|e| [e.kinetic, e.potential]);
        energies.add(&locked, &whole);

        let at = |[_, b, c, _, e, f]: [f64; 6], first, fourth| [first, b, c, fourth, e, f];
        let (q, v, a) = (at(q, -0.7, 0.3), at(v, 0.0, 0.0), at(a, 0.0, 0.0));
        let left = |[_, b, c, _, e, f]: [f64; 6]| [b, c, e, f];
        stump.add(&Stump::inverse_dynamics(&left(q), &left(v), &left(a)), &left(Kr5::inverse_dynamics(&q, &v, &a)));
    }
    // Measured: 1.3e-13, where a component nearly vanishes.
    [forces, gravity, masses, energies, stump].iter().for_each(|comparison| comparison.assert_within(1e-12));
}

/// A lock is a constraint force at the joint that keeps its acceleration zero: the other rows of M a + C v + g = τ,
/// solved by LU for the other accelerations.
#[test]
fn accelerations_are_those_under_the_constraint() {
    let mut random = Random::new(8);
    let mut accelerations = Comparison::new("accelerations");
    for _ in 0..200 {
        let ([q, v, _], [ql, vl, tau]) = states(&mut random);
        let mass = Matrix5::from_fn(|i, j| Kr5::mass_matrix(&q)[i][j]);
        let bias = Kr5::bias_forces(&q, &v);
        let drive = Vector5::from_fn(|i, _| tau[i] - bias[i]);
        let expected = mass.lu().solve(&drive).expect("a regular matrix");
        accelerations.add(&Locked::forward_dynamics(&ql, &vl, &tau), expected.as_slice());
    }
    accelerations.assert_within(1e-11);
}

/// `carriage`, `gripper` and `camera` are three of seven, about and along oblique axes.
#[test]
fn links_stand_and_move_where_the_whole_robot_has_them() {
    let mut random = Random::new(9);
    let mut links = Comparison::new("link kinematics");
    let mut forces = Comparison::new("joint forces");
    let values = |link: &LinkState<f64>| {
        let LinkState { rotation, origin, com, velocity, angular_velocity } = link;
        rotation.iter().chain([origin, com, velocity, angular_velocity]).flatten().copied().collect::<Vec<_>>()
    };
    let place = |name: &str| Gantry::JOINT_NAMES.iter().position(|joint| *joint == name).unwrap();
    let left = LockedGantry::JOINT_NAMES.map(place);
    for _ in 0..100 {
        let State { q, v, a } = random.state(Gantry::NV);
        let [mut q, mut v, mut a] = [q, v, a].map(|x| <[f64; Gantry::NV]>::try_from(x).unwrap());
        for (name, value) in [("along", 0.25), ("gripper", -0.8), ("camera", std::f64::consts::FRAC_PI_2)] {
            (q[place(name)], v[place(name)], a[place(name)]) = (value, 0.0, 0.0);
        }
        let [ql, vl, al] = [q, v, a].map(|x| left.map(|joint| x[joint]));
        let whole = Gantry::link_kinematics(&q, &v);
        for (locked, whole) in LockedGantry::link_kinematics(&ql, &vl).iter().zip(&whole) {
            links.add(&values(locked), &values(whole));
        }
        let whole = Gantry::inverse_dynamics(&q, &v, &a);
        forces.add(&LockedGantry::inverse_dynamics(&ql, &vl, &al), &left.map(|joint| whole[joint]));
    }
    [links, forces].iter().for_each(|comparison| comparison.assert_within(1e-12));
}

/// Rods in the plane, by hand: I = Σ (I_zz + m r²), τ = I a + g Σ m x.
#[test]
fn one_free_joint_is_a_pendulum() {
    let rods = [
        (0.4, 0.4 * 0.1 * 0.1 / 12.0, vec![(0.05, 0.0)]),
        (0.2, 0.2 * 0.05 * 0.05 / 12.0, vec![(0.1, 0.0), (0.025, 0.5)]),
        (0.2, 0.2 * 0.05 * 0.05 / 12.0, vec![(0.1, 0.0), (0.05, 0.5), (0.025, 0.5 - 0.9)]),
        (0.2, 0.2 * 0.05 * 0.05 / 12.0, vec![(0.05, 0.0), (0.025, 2.0)]),
    ];
    let mut torque = Comparison::new("torque of a pendulum");
    for q in [0.0, 0.4, 1.3, -2.0, 3.0] {
        let (v, a) = (1.7, -2.3);
        let (mut inertia, mut weight) = (0.0, 0.0);
        for (mass, moment, reaches) in &rods {
            let sum = |f: fn(f64) -> f64| reaches.iter().map(|(length, angle)| length * f(q + angle)).sum::<f64>();
            let (x, y) = (sum(f64::cos), sum(f64::sin));
            inertia += moment + mass * (x * x + y * y);
            weight += mass * 9.81 * x;
        }
        torque.add(&Pendulum::inverse_dynamics(&[q], &[v], &[a]), &[inertia * a + weight]);
        torque.add(&Pendulum::forward_dynamics(&[q], &[v], &[weight + 0.3]), &[0.3 / inertia]);
    }
    torque.assert_within(1e-12);
    // Two terms of gravity, the inertia, and their sum.
    assert!(Pendulum::OPS.inverse_dynamics.flops() <= 5, "{:?}", Pendulum::OPS.inverse_dynamics);
}

#[test]
fn locking_a_joint_saves_operations() {
    const {
        // Of 333, 591 and 159.
        assert!(Locked::OPS.inverse_dynamics.flops() <= 311);
        assert!(Locked::OPS.forward_dynamics.flops() <= 523);
        assert!(Locked::OPS.mass_matrix.flops() <= 142);
    }
}
