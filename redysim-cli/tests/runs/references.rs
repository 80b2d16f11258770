//! What the program writes, against numbers that none of this project's code computed.

#[path = "../../../tests/common/andrews.rs"]
#[allow(dead_code, reason = "tests of the facade use the rest")]
mod andrews;

use std::fs;
use std::path::Path;

use crate::common::{Table, deviation, root, scratch, succeed};

/// What a fall may be off by, in every number of it.
const OFF: f64 = 1e-8;

/// Tolerances that leave hardly more than rounding.
const AGAINST_QUADRUPLE_PRECISION: &str = "method = \"Dop853\", rtol = 1e-13, atol = 1e-14";

/// A scenario of this repository with another integrator.
fn by(folder: &Path, name: &str, method: &str) -> String {
    let text = fs::read_to_string(root().join(format!("scenarios/{name}.toml"))).unwrap();
    let text = text.replace("../models", &root().join("models").display().to_string());
    let shipped = "method = \"Ode45\", rtol = 1e-4, atol = 1e-6";
    assert!(text.contains(shipped), "{name} has ReDySim's tolerances");
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text.replace(shipped, method)).unwrap();
    path.display().to_string()
}

/// The fall of a scenario by `method`, against a reference in quadruple precision: coordinates, velocities and
/// energies, and with loops the multipliers.
fn falls(scenario: &str, reference: &str, joints: usize, rows: usize, method: &str) {
    let folder = scratch(&format!("falls-{scenario}"));
    succeed(&folder, &["forward", &by(&folder, scenario, method), "-o", "run"]);
    let read = |name: &str| Table::csv(&folder.join("run").join(name));
    let reference = Table::reference(reference);
    let found = read("statevar.csv");
    assert!(deviation(&found.columns(0..1), &reference.columns(0..1)) < 1e-12, "the same instants");
    let near = |what: &str, found: &[Vec<f64>], expected: &[Vec<f64>]| {
        let off = deviation(found, expected);
        println!("{scenario}: {what} {off:e}");
        assert!(off < OFF, "{scenario}: {what} {off:e}");
    };
    near("states", &found.columns(1..1 + 2 * joints), &reference.columns(1..1 + 2 * joints));
    let energies = read("energy.csv").columns(1..3);
    near("energies", &energies, &reference.columns(2 * joints + 2..2 * joints + 4));
    if rows > 0 {
        let first = 2 * joints + 4;
        near("multipliers", &read("lambda.csv").columns(1..1 + rows), &reference.columns(first..first + rows));
    }
}

/// The motion is chaotic: what a step does to it grows by 10⁶ in the last second. No tolerance is tight enough for
/// that, but small steps of a method that keeps the energy are.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn kr5_falls_as_in_quadruple_precision() {
    falls("kuka", "golden_ref_kuka.csv", 6, 0, "method = \"Gauss6\", step = 2.5e-4");
}

#[test]
fn the_gripper_falls_as_in_quadruple_precision() {
    falls("gripper", "golden_ref_gripper_paper.csv", 4, 0, AGAINST_QUADRUPLE_PRECISION);
}

#[test]
fn two_links_fall_as_in_quadruple_precision() {
    falls("two_link", "golden_ref_link2.csv", 2, 0, AGAINST_QUADRUPLE_PRECISION);
}

#[test]
fn three_links_fall_as_in_quadruple_precision() {
    falls("three_link", "golden_ref_link3.csv", 3, 0, AGAINST_QUADRUPLE_PRECISION);
}

#[test]
fn the_fourbar_falls_as_in_quadruple_precision() {
    falls("fourbar", "golden_ref_hoken_rest_consistent.csv", 3, 2, AGAINST_QUADRUPLE_PRECISION);
}

/// The results of a shipped scenario's motion.
fn moves(scenario: &str) -> impl Fn(&str) -> Table {
    let folder = scratch(&format!("moves-{scenario}"));
    succeed(&folder, &["forward", &format!("{}/scenarios/{scenario}.toml", root().display()), "-o", "run"]);
    move |name| Table::csv(&folder.join("run").join(name))
}

/// The tolerances of the integrator are 1e-10 for a step. The dampers take the errors of the fast motions away; those of
/// the angle of the shaft, which nothing holds, add up over a thousand steps.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_flyball_governor_moves_as_in_quadruple_precision() {
    let read = moves("flyball");
    let (found, reference) = (read("statevar.csv"), Table::reference("quad_flyball.csv"));
    for expected in &reference.rows {
        let nearest = |row: &&Vec<f64>| (row[0] - expected[0]).abs() < 1e-12;
        let row = found.rows.iter().find(nearest).expect("a row at this time");
        let off = deviation(&[row[1..9].to_vec()], &[expected[1..].to_vec()]);
        println!("flyball at {} s: {off:e}", expected[0]);
        assert!(off < 1e-9, "at {} s: {off:e}", expected[0]);
    }
}

/// The published positions are right to 1e-10 of themselves, velocities to 5e-8 and multipliers to 1e-6.
#[test]
fn andrews_mechanism_moves_as_published_with_its_spring_in_the_model() {
    let read = moves("andrews");
    let last = |table: &Table, columns: std::ops::Range<usize>| table.rows.last().unwrap()[columns].to_vec();
    let (states, multipliers) = (read("statevar.csv"), read("lambda.csv"));
    assert!((last(&states, 0..1)[0] - 0.03).abs() < 1e-15);
    for (what, found, published, off) in [
        ("positions", last(&states, 1..8), &andrews::END[..], 5e-10),
        ("velocities", last(&states, 8..15), &andrews::END_VELOCITIES, 2e-7),
        ("multipliers", last(&multipliers, 1..7), &andrews::END_MULTIPLIERS, 5e-6),
    ] {
        let shares = found.iter().zip(published).map(|(found, published)| found / published).collect();
        let worst = deviation(&[shares], &[vec![1.0; published.len()]]);
        println!("andrews: {what} {worst:e}");
        assert!(worst < off, "{what}: {worst:e}");
    }
}

/// The forces of a scenario's motion, against ReDySim's own: motion, forces of the actuated joints, and multipliers,
/// each as a part of the largest in its column.
fn takes(scenario: &str, reference: &str, joints: usize, actuated: &[usize], rows: usize) {
    let folder = scratch(&format!("takes-{scenario}"));
    succeed(&folder, &["inverse", &format!("{}/scenarios/{scenario}.toml", root().display()), "-o", "run"]);
    let read = |name: &str| Table::csv(&folder.join("run").join(name));
    let reference = Table::reference(reference);
    let motion = read("traj.csv");
    let worst = deviation(&motion.columns(0..3 * joints + 1), &reference.columns(0..3 * joints + 1));
    println!("{scenario}: motion {worst:e}");
    assert!(worst < 1e-11, "{scenario}: motion {worst:e}");
    let tau = read("tor.csv");
    let multipliers = (rows > 0).then(|| read("lambda.csv"));
    for (k, expected) in (3 * joints + 1..reference.rows[0].len()).enumerate() {
        let found = match (actuated.get(k), &multipliers) {
            (Some(joint), _) => tau.columns(joint + 1..joint + 2),
            (None, Some(lambda)) => lambda.columns(1 + k - actuated.len()..2 + k - actuated.len()),
            (None, None) => panic!("a force of no joint"),
        };
        let expected = reference.columns(expected..expected + 1);
        let peak = deviation(&expected, &vec![vec![0.0]; expected.len()]);
        let worst = deviation(&found, &expected) / peak;
        println!("{scenario}: force {k} {worst:e} of {peak}");
        assert!(worst < 1e-12, "{scenario}: force {k} is off by {worst:e} of its peak");
    }
}

#[test]
fn kr5_takes_the_torques_of_redysim() {
    takes("kuka", "golden_octave_ID_KUKA_Robot.csv", 6, &[0, 1, 2, 3, 4, 5], 0);
}

#[test]
fn the_gripper_takes_the_torques_of_redysim() {
    takes("gripper", "golden_octave_ID_Robotic_Gripper.csv", 4, &[0, 1, 2, 3], 0);
}

#[test]
fn the_fourbar_takes_the_torque_and_multipliers_of_redysim() {
    takes("fourbar", "golden_octave_ID_Hoken_Fourbar.csv", 3, &[0], 2);
}

#[test]
fn the_three_rrr_takes_the_torques_and_multipliers_of_redysim() {
    takes("three_rrr_circle", "golden_octave_ID_3-RRR_Parallel_robot.csv", 7, &[0, 3, 5], 4);
}
