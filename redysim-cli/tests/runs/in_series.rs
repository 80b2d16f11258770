//! Runs of joints that are several joints in series: names and units, how a scenario gives them, and their motion.

use redysim_runtime::Real;
use std::fs;

use crate::common::{Table, call, fail, scenario, scratch, succeed};

const MODEL: &str = "test/joints_in_series.toml";

#[test]
fn coordinates_are_given_by_the_name_of_the_joint_or_of_the_component() {
    let folder = scratch("in-series-start");
    let initial = "[initial]\nq = { swivel = ['30 deg', -0.4], 'sleeve.displacement' = 0.2, 'probe.theta' = '-45 deg', 'wrist.theta' = 0.8 }\n\
                   v = { carriage = [0.1, 0.2, '90 deg/s'] }\n";
    let path = scenario(&folder, MODEL, &format!("{initial}[forward]\nend = 0.01\nstep = 0.01\n"));
    succeed(&folder, &["forward", &path, "-o", "run", "--quiet"]);
    let table = Table::csv(&folder.join("run/traj.csv"));
    let at = |header: &str| {
        let column = table.headers.iter().position(|other| other == header).unwrap_or_else(|| panic!("no {header}"));
        table.rows[0][column]
    };
    assert_eq!((at("q swivel.phi [rad]"), at("q swivel.theta [rad]")), (30f64.to_radians(), -0.4));
    assert_eq!((at("q sleeve.displacement [m]"), at("q sleeve.angle [rad]")), (0.2, 0.0));
    assert_eq!((at("q probe.x [m]"), at("q probe.theta [rad]")), (0.0, (-45f64).to_radians()));
    assert_eq!((at("v carriage.y [m/s]"), at("v carriage.angle [rad/s]")), (0.2, 90f64.to_radians()));
    let forces = fs::read_to_string(folder.join("run/tor.csv")).unwrap();
    assert!(
        forces.starts_with("t [s],tau swivel.phi [N m],tau swivel.theta [N m],tau sleeve.displacement [N],"),
        "{forces}"
    );
}

/// A spring and a damper along every velocity that has an actuator, by default; the others swing freely.
#[test]
fn joints_in_series_keep_the_balance_of_energy_under_a_law() {
    let folder = scratch("in-series-law");
    let rest = "[initial]\nq = { wrist = [0, 0.8, 0] }\n[forward]\nend = 0.5\nstep = 0.05\nintegrator = { method = \"Dop853\", rtol = 1e-11, atol = 1e-12 }\n\
                torque = { law = \"pd\", kp = 40.0, kd = 4.0, target = { swivel = [0.3, -0.2], carriage = [0.1, 0.2, 0.3] } }\n";
    let path = scenario(&folder, MODEL, rest);
    succeed(&folder, &["forward", &path, "-o", "run", "--quiet"]);
    let energy = Table::csv(&folder.join("run/energy.csv"));
    let exchanged = energy.rows.iter().map(|row| row[4].abs()).fold(0.0, Real::maximum);
    let drift = energy.rows.iter().map(|row| row[5].abs()).fold(0.0, Real::maximum);
    assert!(exchanged > 1.0, "the law works: {exchanged} J");
    assert!(drift < 1e-9 * exchanged, "{drift:e} of {exchanged} J");
    // The wrist has no actuator, and the probe three.
    let forces = Table::csv(&folder.join("run/tor.csv"));
    let column = |header: &str| forces.headers.iter().position(|other| other.starts_with(header)).expect("a column");
    for name in ["tau wrist.phi", "tau wrist.psi", "tau probe.x", "tau probe.z", "tau probe.psi"] {
        assert!(forces.rows.iter().all(|row| row[column(name)] == 0.0), "{name}");
    }
    for name in ["tau carriage.y", "tau probe.y", "tau probe.phi", "tau probe.theta"] {
        assert!(forces.rows.iter().any(|row| row[column(name)] != 0.0), "{name}");
    }
}

#[test]
fn a_law_of_a_joint_with_actuators_for_some_velocities_only_is_warned_of() {
    let folder = scratch("in-series-partly");
    let rest =
        "[forward]\nend = 0.01\nstep = 0.01\ntorque = { law = \"pd\", kp = 1.0, kd = 1.0, joints = [\"probe\"] }\n";
    let path = scenario(&folder, MODEL, rest);
    let run = call(&folder, &["forward", &path, "-o", "run"]);
    let expected = "the torque law drives the joint `probe`, which has actuators for some of its velocities only";
    assert!(run.stderr.contains(expected), "{}", run.stderr);
}

/// The first and the third axis of zxz are parallel at zero.
#[test]
fn a_start_in_the_gimbal_of_euler_angles_is_reported() {
    let folder = scratch("in-series-gimbal");
    let path = scenario(&folder, MODEL, "[forward]\nend = 0.01\nstep = 0.01\n");
    let fault = fail(&folder, &["forward", &path, "-o", "run"], 3);
    assert!(fault.contains("is NaN") && fault.contains("look for a singular position"), "{fault}");
}
