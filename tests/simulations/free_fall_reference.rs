//! A simulated free fall agrees with references in quadruple precision, and keeps its energy.
//!
//! Where the files come from: `tests/reference/README.md`.
#![cfg(feature = "generic")]

use redysim::Real;
use redysim::{ForwardSimulation, Integrator, Ode45, TreeDynamics, Vector, ZeroTorque, redysim};

redysim! { pub struct Kr5("models/kr5.toml"); }
redysim! { struct Gripper("models/gripper.toml"); }

/// t, then the coordinates and velocities there.
fn rows(text: &str, dof: usize) -> Vec<(f64, Vec<f64>)> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
            (numbers[0], numbers[1..=2 * dof].to_vec())
        })
        .take_while(|(t, _)| *t <= 1.0)
        .collect()
}

/// Largest errors over the first second.
struct Errors {
    coordinates: f64,
    coordinates_at_the_end: f64,
    energy: f64,
    work: f64,
}

/// Lets a mechanism fall from the first row of a reference, and compares it with the others.
fn free_fall<M: TreeDynamics<f64>>(mechanism: &M, reference: &str) -> Errors {
    let dof = mechanism.nv();
    let rows = rows(reference, dof);
    assert_eq!(rows.len(), 101);
    let q = M::Coordinates::from_fn(dof, |i| rows[0].1[i]);
    let v = M::Velocities::from_fn(dof, |i| rows[0].1[dof + i]);
    let at_rest = mechanism.energy(&q, &v).total();
    let mut fall = ForwardSimulation::new(mechanism, ZeroTorque);
    let start = fall.state(&q, &v);
    let copy = ForwardSimulation::new(mechanism, ZeroTorque);
    let mut errors = Errors { coordinates: 0.0, coordinates_at_the_end: 0.0, energy: 0.0, work: 0.0 };
    let times: Vec<f64> = rows.iter().map(|(t, _)| *t).collect();
    let mut expected = rows.iter();
    Ode45::new()
        .rtol(3e-14)
        .atol(1e-15)
        .solve(&mut fall, (0.0, 1.0), start, times, |t, state| {
            let (time, row) = expected.next().expect("a row for every time");
            assert_eq!(t, *time);
            let now = copy.split(state);
            let off = now
                .q
                .as_ref()
                .iter()
                .zip(row)
                .fold(0.0_f64, |worst, (q, exact)| Real::maximum(worst, (q - exact).abs()));
            errors.coordinates = errors.coordinates.max(off);
            errors.coordinates_at_the_end = off;
            errors.energy = errors.energy.max((mechanism.energy(&now.q, &now.v).total() - at_rest).abs());
            errors.work = errors.work.max(now.actuator_energy.abs());
        })
        .expect("the integration reaches the end");
    assert!(expected.next().is_none(), "every row was compared");
    errors
}

#[test]
fn kr5_falls_as_in_quadruple_precision() {
    let errors = free_fall(&Kr5, include_str!("../reference/golden_ref_kuka.csv"));
    assert!(errors.coordinates <= 5e-11, "{:e} rad", errors.coordinates);
    assert!(errors.coordinates_at_the_end <= 5e-12, "{:e} rad", errors.coordinates_at_the_end);
    assert!(errors.energy <= 1e-9, "{:e} J", errors.energy);
    assert_eq!(errors.work, 0.0, "actuators without torque do no work");
}

#[test]
fn the_gripper_falls_as_in_quadruple_precision() {
    for reference in [
        include_str!("../reference/golden_ref_gripper_paper.csv"),
        include_str!("../reference/golden_ref_gripper_paper_th4_90.csv"),
    ] {
        let errors = free_fall(&Gripper, reference);
        assert!(errors.coordinates <= 1e-12, "{:e} rad", errors.coordinates);
        assert!(errors.energy <= 1e-9, "{:e} J", errors.energy);
    }
}
