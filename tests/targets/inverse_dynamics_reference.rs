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
    assert_joint_forces_but_at_rest(what, mechanism, rows, (&[], 0.0));
}

/// In the rows `at_rest` nothing turns the first joint, and what others exert on it cancels to the roundoff of terms of
/// `largest` N m: its force has no digit to compare and is held against that roundoff.
fn assert_joint_forces_but_at_rest(
    what: &str,
    mechanism: &impl InverseDynamics<f64>,
    rows: &[Row],
    (at_rest, largest): (&[usize], f64),
) {
    let mut comparison = Comparison::new(what);
    for (index, row) in rows.iter().enumerate() {
        let tau = inverse_dynamics(mechanism, &row.q, &row.v, &row.a);
        let first = usize::from(at_rest.contains(&index));
        comparison.add(&tau[first..], &row.tau[first..]);
        let roundoff = largest * f64::EPSILON;
        assert!(first == 0 || tau[0].abs() <= roundoff, "{what}: {:e} N m at rest in row {index}", tau[0]);
    }
    comparison.assert_within(1e-12);
}

/// In the last row the robot stands still, and nothing turns its vertical first joint but the roundoff of a row with
/// accelerations of 1e-15 rad/s². ReDySim has -1.32e-14 N m there, the same sum in double-double -1.12e-14: neither
/// has a digit to compare, so the force is held against the largest of the run, 211 N m.
fn assert_kr5_follows_redysim(what: &str, mechanism: &impl InverseDynamics<f64>) {
    assert_joint_forces_but_at_rest(what, mechanism, &kr5_by_redysim(), (&[1000], 211.0));
}

/// In the first and the last row nothing turns the vertical first joint. The weights of the wrist and the arm cancel
/// there to the roundoff of terms of 100 N m.
fn assert_kr5_agrees_with_quadruple_precision(what: &str, mechanism: &impl InverseDynamics<f64>) {
    assert_joint_forces_but_at_rest(what, mechanism, &kr5_in_quadruple_precision(), (&[0, 4], 100.0));
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
    assert_kr5_follows_redysim("compiled kr5", &Kr5);
}

#[test]
fn generic_kr5_follows_redysim() {
    assert_kr5_follows_redysim("generic kr5", &generic("kr5"));
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
    assert_kr5_agrees_with_quadruple_precision("compiled kr5, quad", &Kr5);
    assert_kr5_agrees_with_quadruple_precision("generic kr5, quad", &generic("kr5"));
}

#[test]
fn gripper_agrees_with_quadruple_precision() {
    assert_joint_forces("compiled gripper, quad", &Gripper, &gripper_in_quadruple_precision());
    assert_joint_forces("generic gripper, quad", &generic("gripper"), &gripper_in_quadruple_precision());
}
