//! Joint forces agree with ReDySim's own along whole trajectories, and with an evaluation in quadruple precision.
//!
//! Where the files come from: `tests/reference/README.md`.
#![cfg(feature = "generic")]

use crate::common::call::inverse_dynamics;
use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::robots::{Gripper, Kr5};
use redysim::InverseDynamics;

/// One row of a reference file.
struct Row {
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    tau: Vec<f64>,
}

/// The rows t, q, q̇, q̈, τ of a file for `dof` joints.
fn rows(text: &str, dof: usize) -> Vec<Row> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
            let column = |i: usize| numbers[1 + i * dof..1 + (i + 1) * dof].to_vec();
            assert_eq!(numbers.len(), 1 + 4 * dof, "columns of {line:?}");
            Row { q: column(0), v: column(1), a: column(2), tau: column(3) }
        })
        .collect()
}

fn assert_joint_forces(what: &str, mechanism: &impl InverseDynamics<f64>, rows: &[Row]) {
    let mut comparison = Comparison::new(what);
    for row in rows {
        comparison.add(&inverse_dynamics(mechanism, &row.q, &row.v, &row.a), &row.tau);
    }
    comparison.assert_within(1e-12);
}

/// In the last row the robot stands still, and nothing turns its vertical first joint but the roundoff of a row with
/// accelerations of 1e-15 rad/s². ReDySim has -1.32e-14 N m there, the same sum in double-double -1.12e-14: neither
/// has a digit to compare, so the force is held against the largest of the run, 211 N m.
fn assert_joint_forces_of_kr5(what: &str, mechanism: &impl InverseDynamics<f64>, rows: &[Row]) {
    let (last, rows) = rows.split_last().expect("rows");
    let mut comparison = Comparison::new(what);
    for row in rows {
        comparison.add(&inverse_dynamics(mechanism, &row.q, &row.v, &row.a), &row.tau);
    }
    let at_rest = inverse_dynamics(mechanism, &last.q, &last.v, &last.a);
    comparison.add(&at_rest[1..], &last.tau[1..]);
    comparison.assert_within(1e-12);
    assert!(at_rest[0].abs() <= 211.0 * f64::EPSILON, "{what}: {:e} N m at rest", at_rest[0]);
}

/// In one row the robot stands still, and nothing turns its vertical first joint. The weights of the wrist and the arm
/// cancel there to the roundoff of terms of 100 N m, which is what the force is held against.
fn assert_joint_forces_of_kr5_in_quadruple_precision(what: &str, mechanism: &impl InverseDynamics<f64>) {
    let mut comparison = Comparison::new(what);
    for row in kr5_in_quadruple_precision() {
        let mut tau = inverse_dynamics(mechanism, &row.q, &row.v, &row.a);
        if row.tau[0] == 0.0 {
            assert!(tau[0].abs() <= 100.0 * f64::EPSILON, "{what}: {:e} N m at rest", tau[0]);
            tau[0] = 0.0;
        }
        comparison.add(&tau, &row.tau);
    }
    comparison.assert_within(1e-12);
}

fn kr5_by_redysim() -> Vec<Row> {
    let rows = rows(include_str!("../reference/golden_octave_ID_KUKA_Robot.csv"), 6);
    assert_eq!(rows.len(), 1001);
    rows
}

fn gripper_by_redysim() -> Vec<Row> {
    let rows = rows(include_str!("../reference/golden_octave_ID_Robotic_Gripper.csv"), 4);
    assert_eq!(rows.len(), 101);
    rows
}

fn kr5_in_quadruple_precision() -> Vec<Row> {
    rows(include_str!("../reference/kane_quad_ID_kr5.csv"), 6)
}

fn gripper_in_quadruple_precision() -> Vec<Row> {
    rows(include_str!("../reference/kane_quad_ID_gripper.csv"), 4)
}

#[test]
fn compiled_kr5_follows_redysim() {
    assert_joint_forces_of_kr5("compiled kr5", &Kr5, &kr5_by_redysim());
}

#[test]
fn generic_kr5_follows_redysim() {
    assert_joint_forces_of_kr5("generic kr5", &generic("kr5"), &kr5_by_redysim());
}

#[test]
fn compiled_gripper_follows_redysim() {
    assert_joint_forces("compiled gripper", &Gripper, &gripper_by_redysim());
}

#[test]
fn generic_gripper_follows_redysim() {
    assert_joint_forces("generic gripper", &generic("gripper"), &gripper_by_redysim());
}

#[test]
fn kr5_agrees_with_quadruple_precision() {
    assert_joint_forces_of_kr5_in_quadruple_precision("compiled kr5, quad", &Kr5);
    assert_joint_forces_of_kr5_in_quadruple_precision("generic kr5, quad", &generic("kr5"));
}

#[test]
fn gripper_agrees_with_quadruple_precision() {
    assert_joint_forces("compiled gripper, quad", &Gripper, &gripper_in_quadruple_precision());
    assert_joint_forces("generic gripper, quad", &generic("gripper"), &gripper_in_quadruple_precision());
}
