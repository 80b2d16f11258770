//! Runs of spherical and free joints: names and units of their components, how a scenario gives them, and their motion
//! against what does not depend on coordinates.

use std::fs;
use std::path::Path;

use redysim_cli::{Initial, Scenario, Values};

use crate::common::{AGAINST_CLOSED_FORMS, Table, call, deviation, fail, root, scenario, scratch, succeed};

const TOP: &str = "spherical_pendulum.toml";
const ROBOT: &str = "kr5_floating.toml";
const ARM: &str = "joints = ['joint1', 'joint2', 'joint3', 'joint4', 'joint5', 'joint6']";
const GAINS: &str = "kp = [2000, 2000, 1000, 20, 5, 0.05], kd = [300, 300, 150, 2, 0.5, 0.002]";

/// The table `name` of a forward run.
fn moved(folder: &Path, model: &str, rest: &str, name: &str) -> Table {
    let path = scenario(folder, model, rest);
    succeed(folder, &["forward", &path, "-o", "run", "--force", "--quiet"]);
    Table::csv(&folder.join("run").join(format!("{name}.csv")))
}

/// The first row of the states after the time, of a run that starts at `initial`.
fn start(folder: &Path, model: &str, initial: &str) -> Vec<f64> {
    let table =
        moved(folder, model, &format!("[initial]\n{initial}\n[forward]\nend = 0.01\nstep = 0.01\n"), "statevar");
    table.rows[0][1..].to_vec()
}

#[test]
fn components_of_joints_have_names_and_units_in_every_table() {
    let folder = scratch("in-space-names");
    let state = moved(&folder, ROBOT, "[forward]\nend = 0.01\nstep = 0.01\n", "traj");
    let forces = Table::csv(&folder.join("run/tor.csv"));
    let q = ["x [m]", "y [m]", "z [m]", "qx [1]", "qy [1]", "qz [1]", "qw [1]"];
    for (k, q) in q.iter().enumerate() {
        assert_eq!(state.headers[1 + k], format!("q base.{q}"));
    }
    let v = [
        ("vx", "m", "N"),
        ("vy", "m", "N"),
        ("vz", "m", "N"),
        ("wx", "rad", "N m"),
        ("wy", "rad", "N m"),
        ("wz", "rad", "N m"),
    ];
    for (k, (name, unit, force)) in v.iter().enumerate() {
        assert_eq!(state.headers[14 + k], format!("v base.{name} [{unit}/s]"));
        assert_eq!(state.headers[26 + k], format!("a base.{name} [{unit}/s^2]"));
        assert_eq!(forces.headers[1 + k], format!("tau base.{name} [{force}]"));
    }
    assert_eq!((state.headers.len(), forces.headers.len()), (1 + 13 + 12 + 12, 1 + 12));
}

#[test]
fn joints_in_space_start_in_the_neutral_position() {
    let found = start(&scratch("in-space-neutral"), TOP, "");
    assert_eq!(found, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_start_may_be_given_by_a_quaternion_by_angles_or_by_an_axis() {
    let folder = scratch("in-space-start");
    let (sin, cos) = (0.25_f64).sin_cos();
    for given in [
        format!("q = [{sin}, 0, 0, {cos}]"),
        format!("q = [{}, 0, 0, {}]", 3.0 * sin, 3.0 * cos),
        format!("q = {{ pivot = [{sin}, 0, 0, {cos}] }}"),
        format!("q = {{ 'pivot.qx' = {sin}, 'pivot.qw' = {cos} }}"),
        format!("q = {{ pivot = {{ quaternion = [{sin}, 0, 0, {cos}] }} }}"),
        "q = { pivot = { rpy = [0.5, 0, 0] } }".to_owned(),
        format!("q = {{ pivot = {{ rpy = ['{} deg', 0, 0] }} }}", 0.5_f64.to_degrees()),
        "q = { pivot = { axis = [2, 0, 0], angle = 0.5 } }".to_owned(),
    ] {
        let found = start(&folder, TOP, &format!("{given}\nv = {{ pivot = [0, 0, '180 deg/s'] }}"));
        let expected = [sin, 0.0, 0.0, cos, 0.0, 0.0, std::f64::consts::PI];
        assert!(deviation(std::slice::from_ref(&found), &[expected.to_vec()]) < 1e-15, "{given}: {found:?}");
    }
}

#[test]
fn roll_pitch_and_yaw_are_those_of_models() {
    let folder = scratch("in-space-rpy");
    let start = "[initial]\nq = { base = { xyz = [1, 2, 3], rpy = [0.3, -0.4, 0.5] } }\n";
    let found = moved(&folder, ROBOT, &format!("{start}[forward]\nend = 0.01\nstep = 0.01\n"), "kinematics");
    let expected = redysim_model::rotation::roll_pitch_yaw([0.3, -0.4, 0.5]).0.concat();
    assert_eq!(found.rows[0][1..4], [1.0, 2.0, 3.0]);
    assert!(deviation(&[found.rows[0][7..16].to_vec()], &[expected]) < 1e-15);
}

#[test]
fn orientations_that_are_none_are_refused_with_what_to_do() {
    let folder = scratch("in-space-refused");
    for (model, initial, faults) in [
        (
            TOP,
            "q = [0, 0, 0, 0]",
            &["trial.toml:3:5", "`initial.q` gives the joint `pivot` the quaternion [0, 0, 0, 0]", "0, 0, 0, 1"][..],
        ),
        (TOP, "q = { pivot = { quaternion = [0, 0, 0, 0] } }", &["the quaternion [0, 0, 0, 0], which is invalid"]),
        (
            TOP,
            "q = { pivot = { quaternion = [0, 0, 1] } }",
            &["`initial.q.pivot.quaternion` must have 4 numbers: x, y, z, w"],
        ),
        (TOP, "q = [0, 0, 1]", &["4 values, one for each of pivot.qx, pivot.qy, pivot.qz, pivot.qw"]),
        (
            TOP,
            "q = { pivot = { rpy = [0, 0, 0], quaternion = [0, 0, 0, 1] } }",
            &["orientation twice, by `quaternion` and by `rpy`"],
        ),
        (TOP, "q = { pivot = { axis = [0, 0, 1] } }", &["`initial.q.pivot.angle`"]),
        (TOP, "q = { pivot = { angle = 1.0 } }", &["`initial.q.pivot.axis`"]),
        (TOP, "q = { pivot = { axis = [0, 0, 0], angle = 1.0 } }", &["no direction"]),
        (TOP, "q = { pivot = { xyz = [0, 0, 1] } }", &["unknown key `initial.q.pivot.xyz`"]),
        (TOP, "v = { pivot = [0, 0, 1], 'pivot.wx' = 2 }", &["`initial.v` gives `pivot.wx` twice"]),
        (TOP, "v = { pivot = { rpy = [0, 0, 1] } }", &["`initial.v.pivot` must be an array"]),
        (ROBOT, "q = { joint1 = { rpy = [0, 0, 1] } }", &["`initial.q.joint1` must be"]),
        (ROBOT, "q = { bass = [0, 0, 0, 0, 0, 0, 1] }", &["did you mean `base`?"]),
    ] {
        let path = scenario(&folder, model, &format!("[initial]\n{initial}\n[forward]\nend = 1.0\nstep = 0.1\n"));
        let shown = fail(&folder, &["forward", &path], 1);
        for fault in faults {
            assert!(shown.contains(fault), "{initial}: no {fault} in {shown}");
        }
    }
}

/// I about the pivot, kg m².
fn inertia_of_top() -> [[f64; 3]; 3] {
    let (mass, com) = (1.3, [0.11, -0.07, 0.23]);
    let own = [[0.031, 0.0011, 0.0005], [0.0011, 0.027, -0.0007], [0.0005, -0.0007, 0.022]];
    let square: f64 = com.iter().map(|c| c * c).sum();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| own[i][j] + mass * (if i == j { square } else { 0.0 } - com[i] * com[j]))
    })
}

#[test]
fn a_spherical_pendulum_keeps_its_energy_and_its_moment_of_momentum_about_the_vertical() {
    let folder = scratch("in-space-pendulum");
    let rest =
        "[initial]\nq = { pivot = { rpy = [1, 0.3, 0] } }\nv = [0.5, -1, 9]\n[forward]\nend = 10.0\nstep = 0.1\n";
    let state = moved(&folder, TOP, &format!("{rest}{AGAINST_CLOSED_FORMS}"), "statevar");
    let kinematics = Table::csv(&folder.join("run/kinematics.csv"));
    let inertia = inertia_of_top();
    let moment = |(state, placed): (&Vec<f64>, &Vec<f64>)| -> f64 {
        let (omega, down) = (&state[5..8], &placed[13..16]);
        (0..3).map(|i| down[i] * (0..3).map(|j| inertia[i][j] * omega[j]).sum::<f64>()).sum()
    };
    let moments: Vec<f64> = state.rows.iter().zip(&kinematics.rows).map(moment).collect();
    assert!(moments[0].abs() > 0.01, "{}", moments[0]);
    assert!(moments.iter().all(|moment| (moment - moments[0]).abs() < 1e-9), "{moments:?}");
    let drift = Table::csv(&folder.join("run/energy.csv")).column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-8), "{drift:?}");
    let lengths = state.rows.iter().map(|row| row[1..5].iter().map(|c| c * c).sum::<f64>());
    assert!(lengths.into_iter().all(|length| (length - 1.0).abs() < 1e-11));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_centre_of_mass_of_a_free_robot_falls_like_a_stone_under_every_law_on_its_arm() {
    let folder = scratch("in-space-fall");
    let masses = [50.0, 16.038, 7.988, 12.973, 2.051, 0.811, 0.008];
    let target = "target = [0.5, 0.6, 0.4, 0.3, 0.2, 0.1]";
    let trajectory =
        format!("[trajectory]\n{ARM}\nfrom = [0, 0, 0, 0, 0, 0]\nto = [1, 1, 1, 1, 1, 1]\nduration = 1.0\n");
    fs::write(folder.join("tau.csv"), "t [s],tau joint2 [N m]\n0,0\n1,50\n").unwrap();
    let laws = [
        "law = 'free'".to_owned(),
        format!("law = 'p', {target}, kp = [2000, 2000, 1000, 20, 5, 0.05]"),
        format!("law = 'pd', {target}, {GAINS}"),
        format!("law = 'pd', {target}, {GAINS}, limits = 30"),
        format!("law = 'pid', {target}, {GAINS}, ki = [10, 10, 10, 1, 1, 0.01]"),
        format!("law = 'pd-gravity', {target}, {GAINS}"),
        format!("law = 'tracking-pd', {GAINS}"),
        "law = 'csv', joints = ['joint2'], file = 'tau.csv'".to_owned(),
    ];
    for law in laws.into_iter().step_by(if cfg!(debug_assertions) { 3 } else { 1 }) {
        let start = "[initial]\nq = { base = { xyz = [0, 0, 1], rpy = [0.1, 0.2, 0.3] } }\nv = { 'base.vx' = 1 }\n";
        let run = "[forward]\nend = 1.0\nstep = 0.1\nintegrator = { method = 'Dop853', rtol = 1e-10, atol = 1e-11 }\n";
        let rest = format!("{start}{trajectory}{run}torque = {{ {law} }}\n");
        let table = moved(&folder, ROBOT, &rest, "kinematics");
        let total: f64 = masses.iter().sum();
        let center = |row: &[f64], axis: usize| {
            (0..7).map(|link| masses[link] * row[1 + 15 * link + 3 + axis]).sum::<f64>() / total
        };
        let velocity: Vec<f64> =
            (0..3).map(|axis| center(&table.rows[10], axis) - center(&table.rows[0], axis)).collect();
        for row in &table.rows {
            let t = row[0];
            for (axis, velocity) in velocity.iter().enumerate() {
                let fall = if axis == 2 { -0.5 * 9.81 * (t * t - t) } else { 0.0 };
                let expected = center(&table.rows[0], axis) + velocity * t + fall;
                let found = center(row, axis);
                assert!((found - expected).abs() < 1e-8, "{law}: {found}, not {expected} at {t} s");
            }
        }
        let tau = Table::csv(&folder.join("run/tor.csv"));
        assert!(tau.rows.iter().all(|row| row[1..7] == [0.0; 6]), "{law} drives the base");
        let drift = Table::csv(&folder.join("run/energy.csv")).column("drift [J]");
        assert!(drift.iter().all(|drift| drift.abs() < 1e-5), "{law}: {drift:?}");
    }
}

#[test]
fn computed_torque_leads_a_spherical_joint_along_its_trajectory() {
    let folder = scratch("in-space-led");
    let rest = format!(
        "[initial]\nq = {{ pivot = {{ rpy = [1, 0, 0] }} }}\n[trajectory]\nfrom = {{ pivot = {{ rpy = [1, 0, 0] }} }}\n\
         to = {{ pivot = {{ rpy = [-1, 0.5, 2] }} }}\nduration = 2.0\n[forward]\nend = 2.0\nstep = 0.1\n\
         {AGAINST_CLOSED_FORMS}torque = {{ law = 'computed-torque', kp = 100, kd = 20 }}\n\
         [inverse]\nend = 2.0\nstep = 0.1\n"
    );
    let led = moved(&folder, TOP, &rest, "traj");
    let path = folder.join("trial.toml");
    succeed(&folder, &["inverse", path.to_str().unwrap(), "-o", "wanted", "--quiet"]);
    let wanted = Table::csv(&folder.join("wanted/traj.csv"));
    assert!(deviation(&led.rows, &wanted.rows) < 1e-9, "{}", deviation(&led.rows, &wanted.rows));
}

#[test]
fn a_spring_and_a_damper_turn_a_spherical_joint_to_its_target() {
    let folder = scratch("in-space-spring");
    let law = "law = 'pd-gravity', target = { pivot = { rpy = [0.4, 0.3, 2.5] } }, kp = 20.0, kd = [5.0, 5.0, 5.0]";
    for law in [law.to_owned(), law.replace("pd-gravity', ", "pid', ki = 20.0, ")] {
        let rest = format!("[forward]\nend = 60.0\nstep = 20.0\n{AGAINST_CLOSED_FORMS}torque = {{ {law} }}\n");
        let found = moved(&folder, TOP, &rest, "kinematics");
        let expected = redysim_model::rotation::roll_pitch_yaw([0.4, 0.3, 2.5]).0.concat();
        assert!(deviation(&[found.rows[3][7..16].to_vec()], &[expected]) < 1e-6, "{law}: {:?}", found.rows[3]);
    }
}

#[test]
fn a_cycloid_of_a_spherical_joint_turns_about_a_fixed_axis() {
    let folder = scratch("in-space-cycloid");
    let rest = "[trajectory]\nfrom = { pivot = { axis = [1, 2, 2], angle = 0.5 } }\n\
                to = { pivot = { axis = [1, 2, 2], angle = 2.5 } }\nduration = 2.0\n[inverse]\nend = 2.0\nstep = 0.5\n";
    succeed(&folder, &["inverse", &scenario(&folder, TOP, rest), "-o", "run"]);
    let half = &Table::csv(&folder.join("run/traj.csv")).rows[2];
    let (sin, cos) = 0.75_f64.sin_cos();
    let third = sin / 3.0;
    let expected = [1.0, third, 2.0 * third, 2.0 * third, cos, 2.0 / 3.0, 4.0 / 3.0, 4.0 / 3.0];
    assert!(deviation(&[half[..8].to_vec()], &[expected.to_vec()]) < 1e-14, "{half:?}");
}

#[test]
fn a_constant_speed_of_a_free_joint_is_a_screw_motion() {
    let folder = scratch("in-space-screw");
    let rest = "[trajectory]\nkind = 'constant-speed'\nfrom = {}\nspeed = { base = [1, 0, 0.5, 0, 0, 1] }\n\
                [inverse]\nend = 2.0\nstep = 0.5\n";
    succeed(&folder, &["inverse", &scenario(&folder, ROBOT, rest), "-o", "run", "--quiet"]);
    for row in &Table::csv(&folder.join("run/statevar.csv")).rows {
        let t = row[0];
        let expected = [t.sin(), 1.0 - t.cos(), 0.5 * t, 0.0, 0.0, (0.5 * t).sin(), (0.5 * t).cos()];
        assert!(deviation(&[row[1..8].to_vec()], &[expected.to_vec()]) < 1e-14, "{row:?}");
    }
}

#[test]
fn the_forces_along_the_recorded_motion_of_a_free_robot_are_those_that_made_it() {
    let folder = scratch("in-space-inverse");
    let start =
        "[initial]\nq = { base = { rpy = [0.1, 0.2, 0.3] } }\nv = { base = [1, 0, 0, 0.5, 1, -1], joint2 = 2 }\n";
    let law = format!("law = 'pd', target = [0.5, 0.6, 0.4, 0.3, 0.2, 0.1], {GAINS}");
    let made =
        moved(&folder, ROBOT, &format!("{start}[forward]\nend = 1.0\nstep = 0.01\ntorque = {{ {law} }}\n"), "tor");
    let rest = "trajectory = { kind = 'csv', file = 'run/traj.csv' }\n[inverse]\nend = 1.0\nstep = 0.01\n";
    let run = call(&folder, &["inverse", &scenario(&folder, ROBOT, rest), "-o", "again"]);
    assert!(run.code == 0 && run.stderr.is_empty(), "{}", run.output());
    let again = Table::csv(&folder.join("again/tor.csv"));
    assert!(deviation(&made.rows, &again.rows) < 1e-9, "{}", deviation(&made.rows, &again.rows));
    let drift = Table::csv(&folder.join("again/energy.csv")).column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-2), "{drift:?}");
}

#[test]
fn points_about_one_axis_are_passed_by_the_polynomial_of_the_angle() {
    let folder = scratch("in-space-angle");
    let rest = "[trajectory]\nkind = 'minimum-jerk'\ntimes = [0, 2]\n\
                points = [{ pivot = [0, 0, 0, 1] }, { pivot = { axis = [1, 2, 2], angle = 2 } }]\n\
                [inverse]\nend = 2.0\nstep = 0.5\n";
    succeed(&folder, &["inverse", &scenario(&folder, TOP, rest), "-o", "run", "--quiet"]);
    let quarter = &Table::csv(&folder.join("run/traj.csv")).rows[1];
    // 2 (10 s³ − 15 s⁴ + 6 s⁵) at s = 1/4, and its rate.
    let (angle, rate) = (2.0 * 0.103_515_625_f64, 1.054_687_5);
    let (sin, cos) = (0.5 * angle).sin_cos();
    let third = sin / 3.0;
    let expected = [0.5, third, 2.0 * third, 2.0 * third, cos, rate / 3.0, 2.0 * rate / 3.0, 2.0 * rate / 3.0];
    assert!(deviation(&[quarter[..8].to_vec()], &[expected.to_vec()]) < 1e-14, "{quarter:?}");
}

#[test]
fn points_on_either_side_of_the_quaternions_are_passed_the_short_way() {
    let folder = scratch("in-space-points");
    let through = |last: &str| {
        let points = format!("[[0, 0, 0, 1], [0.1, 0, 0, 1], {last}]");
        let rest = format!(
            "trajectory = {{ kind = 'minimum-jerk', times = [0, 1, 2], points = {points} }}\n\
             [inverse]\nend = 2.0\nstep = 0.1\n"
        );
        succeed(&folder, &["inverse", &scenario(&folder, TOP, &rest), "-o", "run", "--force", "--quiet"]);
        Table::csv(&folder.join("run/traj.csv")).rows
    };
    assert!(deviation(&through("[0.3, 0, 0, 1]"), &through("[-0.3, 0, 0, -1]")) < 1e-15);
}

#[test]
fn a_zero_quaternion_in_a_table_of_motion_is_refused() {
    let folder = scratch("in-space-table");
    let columns = "t [s],q pivot.qx [1],q pivot.qy [1],q pivot.qz [1],q pivot.qw [1]\n";
    fs::write(folder.join("motion.csv"), format!("{columns}0,0,0,0,1\n1,0,0,0,0\n")).unwrap();
    let rest = "trajectory = { kind = 'csv', file = 'motion.csv' }\n[inverse]\nend = 1.0\nstep = 0.5\n";
    let shown = fail(&folder, &["inverse", &scenario(&folder, TOP, rest)], 1);
    assert!(shown.contains("motion.csv: at t = 1.0 s the quaternion of the joint `pivot` is zero"), "{shown}");
}

#[test]
fn a_run_of_a_free_robot_can_be_done_again_from_its_results_to_the_last_bit() {
    let folder = scratch("in-space-again");
    let rest = "[initial]\nq = { base = { xyz = [0, 0, 1], rpy = [1, 2, 3] } }\n[forward]\nend = 0.2\nstep = 0.01\n";
    moved(&folder, ROBOT, rest, "statevar");
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let read = |name: &str| fs::read_to_string(folder.join(name).join("statevar.csv")).unwrap();
    assert_eq!(read("run"), read("again"));
}

#[test]
fn data_have_the_components_of_a_joint_that_a_file_gives_by_one_name() {
    let file = format!("{}/trial.toml", root().join("models").display());
    let text = "model = 'kr5_floating.toml'\n[initial]\nq = { base = { xyz = [1, 2, 3], axis = [0, 0, 1], angle = '180 deg' } }\n\
                v = { base = [1, 2, 3, 4, 5, 6], joint1 = 7 }\n[forward]\nend = 1.0\nstep = 0.1\n";
    let read = Scenario::from_toml(text, &file).unwrap();
    let Some(Initial { q: Some(Values::Named(q)), v: Some(Values::Named(v)), .. }) = &read.initial else {
        panic!("{read:?}");
    };
    assert_eq!((q.len(), q["base.y"], q["base.qz"]), (7, 2.0, 1.0));
    assert_eq!((v.len(), v["base.wz"], v["joint1"]), (7, 6.0, 7.0));
    assert_eq!(Scenario::from_toml(read.to_toml(), &file).unwrap(), read);
}

/// The error of every joint obeys ë + 20 ė + 100 e = 0, so that e = e₀ (1 + 10 t) exp(−10 t), however the platform moves.
#[test]
fn computed_torque_moves_the_arm_of_a_robot_whose_platform_floats() {
    let folder = scratch("in-space-computed-torque");
    let rest = format!(
        "trajectory = {{ {ARM}, from = [0, 0, 0, 0, 0, 0], to = [0, 0, 0, 0, 0, 0], duration = 1.0 }}\n\
         initial = {{ q = {{ joint1 = 0.3, joint2 = -0.2, joint5 = 0.4 }} }}\n[forward]\nend = 0.5\nstep = 0.05\n\
         torque = {{ law = 'computed-torque', kp = 100, kd = 20 }}\n{AGAINST_CLOSED_FORMS}"
    );
    let state = moved(&folder, ROBOT, &rest, "statevar");
    let start = [0.3, -0.2, 0.0, 0.0, 0.4, 0.0];
    for row in &state.rows {
        let decay = (1.0 + 10.0 * row[0]) * (-10.0 * row[0]).exp();
        for (found, start) in row[8..14].iter().zip(start) {
            assert!((found - start * decay).abs() < 1e-10, "{found} instead of {}", start * decay);
        }
    }
    let forces = Table::csv(&folder.join("run/tor.csv"));
    assert!(forces.rows.iter().all(|row| row[1..7] == [0.0; 6] && row[8] != 0.0), "nothing drives the platform");
    assert!(state.rows.last().unwrap()[4..7].iter().any(|component| component.abs() > 0.01), "it turns");
}

#[test]
fn computed_torque_that_cannot_move_what_the_trajectory_prescribes_is_refused() {
    let folder = scratch("in-space-computed-torque-faults");
    let trial = |joints: &str, count: usize| {
        let zeros = vec![0; count];
        let rest = format!(
            "trajectory = {{ {joints}, from = {zeros:?}, to = {zeros:?}, duration = 1.0 }}\n[forward]\nend = 0.5\n\
             step = 0.05\ntorque = {{ law = 'computed-torque', kp = 100, kd = 20 }}\n"
        );
        fail(&folder, &["forward", &scenario(&folder, ROBOT, &rest)], 1)
    };
    let output = trial("joints = ['joint1', 'joint2', 'joint3', 'joint4', 'joint5']", 5);
    assert!(output.contains("the trajectory does not prescribe the joint `joint6`, and computed torque"), "{output}");
    let with_base = ARM.replace("['joint1'", "['base', 'joint1'").replace("joints = ", "");
    let rest = format!(
        "trajectory = {{ kind = 'constant-speed', joints = {with_base}, from = {{ joint1 = 0 }}, speed = {{ joint1 = 0 }} }}\n\
         [forward]\nend = 0.5\nstep = 0.05\ntorque = {{ law = 'computed-torque', kp = 100, kd = 20 }}\n"
    );
    let output = fail(&folder, &["forward", &scenario(&folder, ROBOT, &rest)], 1);
    assert!(output.contains("but the joint `base` has no actuator") && output.contains("tracking-pd"), "{output}");
}
