//! Helical joints: rotation and translation in proportion.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use redysim::{ForwardDynamics, ForwardSimulation, Integrator, InverseDynamics, MassMatrix, ZeroTorque};
use redysim::{Ode45, redysim};

redysim! { struct Spindle("models/test/spindle.toml"); }

const PITCH: f64 = 0.0007957747154594768;

/// With the arm locked away the nut alone has τ = (J + m p²) a + m g p.
#[test]
fn a_nut_on_a_screw_moves_as_its_closed_form() {
    redysim! { struct Nut("models/test/spindle.toml", locked = { arm = 0 }, functions = [gravity_forces, inverse_dynamics, mass_matrix]); }
    // The arm's axis crosses the screw's at a right angle, 0.3 m off, and the arm stands 30° and −0.05 · 30° along.
    let [[inertia]] = Nut::mass_matrix(&[0.4]);
    let [gravity] = Nut::gravity_forces(&[0.4]);
    let mass = 2.0 + 1.5;
    assert!((gravity - mass * 9.81 * PITCH).abs() < 1e-15);
    let [tau] = Nut::inverse_dynamics(&[0.4], &[3.0], &[2.0]);
    assert!((tau - (inertia * 2.0 + gravity)).abs() < 1e-14);
    let [[kinetic]] = Nut::mass_matrix(&[-2.0]);
    assert!((kinetic - inertia).abs() < 1e-15 && inertia > 0.006 + mass * PITCH * PITCH);
}

#[test]
fn a_helical_joint_lifts_its_link_by_the_pitch() {
    let height = |turns: f64| {
        let [nut, _] = Spindle::link_kinematics(&[turns * std::f64::consts::TAU, 0.0], &[2.0, 0.0]);
        (nut.origin[2], nut.velocity[2], nut.angular_velocity[2])
    };
    let [low, high] = [0.0, 1.0].map(height);
    assert!((high.0 - low.0 - 0.005).abs() < 1e-16 && (low.0 - 0.2).abs() < 1e-16);
    assert!((low.1 - 2.0 * PITCH).abs() < 1e-18 && low.2 == 2.0);
}

/// Denavit-Hartenberg: Rx(alpha) Tx(a) Rz(theta + q) Tz(b + pitch q).
#[test]
fn theta_is_an_angle_at_which_the_link_stands_at_b() {
    let at = |q: f64| Spindle::link_kinematics(&[0.0, q], &[0.0, 0.0])[1];
    // The joint's axis is −y of the base.
    let close = |found: [f64; 3], expected: [f64; 3]| found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-15);
    assert!(close(at(0.0).origin, [0.3, -0.1, 0.2]));
    assert!(close(at(1.0).origin, [0.3, -0.1 + 0.05, 0.2]));
    let (sin, cos) = (30.0_f64).to_radians().sin_cos();
    assert!(close(at(0.0).rotation.map(|row| row[0]), [cos, 0.0, sin]));
}

#[test]
fn free_motion_of_screws_keeps_its_energy_and_both_paths_agree() {
    let (q, v): ([f64; 2], [f64; 2]) = ([0.3, -0.8], [1.5, -2.0]);
    let mut simulation = ForwardSimulation::new(&Spindle, ZeroTorque);
    let start = simulation.state(&q, &v);
    let end = Ode45::new().rtol(1e-11).atol(1e-12).integrate(&mut simulation, (0.0, 2.0), start).unwrap().y;
    let [before, after]: [f64; 2] =
        [(q, v), ([end[0], end[1]], [end[2], end[3]])].map(|(q, v)| Spindle::energy(&q, &v).total());
    assert!((after - before).abs() < 1e-9, "{}", after - before);

    let path = generic("test/spindle");
    let tau: [f64; 2] = Spindle::inverse_dynamics(&q, &v, &[0.7, -0.3]);
    let found: Vec<f64> = path.forward_dynamics(&q.to_vec(), &v.to_vec(), &tau.to_vec());
    let compiled = ForwardDynamics::forward_dynamics(&Spindle, &q, &v, &tau);
    for (joint, expected) in [0.7_f64, -0.3].into_iter().enumerate() {
        assert!((found[joint] - expected).abs() < 1e-12 && (compiled[joint] - expected).abs() < 1e-12);
    }
    let matrix: Vec<Vec<f64>> = MassMatrix::mass_matrix(&path, &q.to_vec());
    for (row, compiled) in matrix.iter().zip(Spindle::mass_matrix(&q)) {
        assert!(row.iter().zip(compiled).all(|(x, y)| (x - y).abs() < 1e-15));
    }
    let forces: Vec<f64> = InverseDynamics::inverse_dynamics(&path, &q.to_vec(), &v.to_vec(), &vec![0.7, -0.3]);
    assert!(forces.iter().zip(tau).all(|(x, y)| (x - y).abs() < 1e-13));
}
