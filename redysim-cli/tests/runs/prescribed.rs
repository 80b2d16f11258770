//! Motions in which some joints follow a trajectory, whatever force it takes, while the others are free or driven.

use std::fs;
use std::path::Path;

use redysim_cli::Scenario;

use crate::common::{AGAINST_CLOSED_FORMS, Table, call, deviation, fail, root, scenario, scratch, succeed};

/// The first of two links turns at a constant speed.
const LED: &str = "[trajectory]\nkind = 'constant-speed'\njoints = ['joint1']\nfrom = [0.2]\nspeed = [1.5]\n";
const RUN: &str = "[forward]\nend = 1.0\nstep = 0.05\n";
/// A spring and a damper for the joints that are not prescribed.
const DRIVEN: &str = "prescribed = ['joint1']\ntorque = { law = 'pd', target = [0.5], kp = 20, kd = 1 }\n";

/// A run of two links of which the first is prescribed, and the second driven.
fn led(folder: &Path) -> impl Fn(&str) -> Table + use<> {
    let start = "[initial]\nq = [9, 0.3]\nv = [9, -1]\n";
    let path = scenario(folder, "two_link.toml", &format!("{start}{LED}{RUN}{AGAINST_CLOSED_FORMS}{DRIVEN}"));
    succeed(folder, &["forward", &path, "-o", "run"]);
    let run = folder.join("run");
    move |name| Table::csv(&run.join(format!("{name}.csv")))
}

#[test]
fn a_prescribed_joint_starts_and_goes_on_as_its_trajectory_has_it() {
    let read = led(&scratch("prescribed-motion"));
    for row in &read("traj").rows {
        let expected = [0.2 + 1.5 * row[0], 1.5, 0.0];
        assert!(deviation(&[vec![row[1], row[3], row[5]]], &[expected.to_vec()]) < 1e-15, "{row:?}");
    }
    let state = read("statevar");
    assert_eq!((state.rows[0][2], state.rows[0][4]), (0.3, -1.0), "the other joint starts where the scenario has it");
}

#[test]
fn the_force_of_a_prescribed_joint_is_that_of_inverse_dynamics_and_the_law_drives_the_others() {
    let folder = scratch("prescribed-forces");
    let read = led(&folder);
    let (state, forces) = (read("statevar"), read("tor"));
    for (state, forces) in state.rows.iter().zip(&forces.rows) {
        let by_law = 20.0 * (0.5 - state[2]) - state[4];
        assert!((forces[2] - by_law).abs() < 1e-12, "{forces:?} instead of {by_law}");
    }
    let along = "trajectory = { kind = 'csv', file = 'run/traj.csv' }\n[inverse]\nend = 1.0\nstep = 0.05\n";
    succeed(&folder, &["inverse", &scenario(&folder, "two_link.toml", along), "-o", "again", "--quiet"]);
    let again = Table::csv(&folder.join("again/tor.csv"));
    assert!(deviation(&again.rows, &forces.rows) < 1e-12, "{}", deviation(&again.rows, &forces.rows));
    assert!(forces.rows.iter().any(|row| row[1].abs() > 0.1), "it takes some force");
    let drift = read("energy").column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-10), "{drift:?}");
}

#[test]
fn a_run_with_prescribed_joints_can_be_done_again_from_its_results_to_the_last_bit() {
    let folder = scratch("prescribed-again");
    let _ = led(&folder);
    let text = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    let torque = text.parse::<toml::Table>().unwrap()["forward"]["torque"]["joints"].to_string();
    assert_eq!(torque, "[\"joint2\"]", "the default is every actuated joint that does not follow the trajectory");
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let read = |run: &str, name: &str| fs::read_to_string(folder.join(run).join(name)).unwrap();
    for name in ["statevar.csv", "tor.csv", "energy.csv"] {
        assert_eq!(read("run", name), read("again", name), "{name}");
    }
}

#[test]
fn data_have_the_joints_that_a_file_prescribes() {
    let file = format!("{}/trial.toml", root().join("models").display());
    let read = Scenario::from_toml(format!("model = 'two_link.toml'\n{LED}{RUN}{DRIVEN}"), &file).unwrap();
    assert_eq!(read.forward.as_ref().unwrap().prescribed, Some(vec!["joint1".to_owned()]));
    assert_eq!(Scenario::from_toml(read.to_toml(), &file).unwrap(), read);
}

#[test]
fn joints_that_cannot_be_prescribed_are_refused_with_what_to_do() {
    let folder = scratch("prescribed-refused");
    let two = "two_link.toml";
    for (model, trajectory, keys, faults) in [
        (two, "", "prescribed = ['joint1']", ["does not define one", "add a table `[trajectory]`"]),
        (two, LED, "prescribed = ['joint2']", ["`joint2`, for which the trajectory has no motion", "`joints`"]),
        (two, LED, "prescribed = ['joint3']", ["joint3", "joint2"]),
        (two, LED, "prescribed = []", ["`forward.prescribed` names no joint", "leave the key out"]),
        (
            two,
            "trajectory = { from = [0, 0], to = [1, 1], duration = 1 }\n",
            "prescribed = ['joint1', 'joint2']",
            ["every joint is prescribed", "`redysim inverse`"],
        ),
        (
            two,
            LED,
            "prescribed = ['joint1']\ntorque = { law = 'p', joints = ['joint1'], target = [0], kp = 1 }",
            ["`joint1` is prescribed, and the torque law drives it", "`forward.prescribed`"],
        ),
        (
            two,
            "trajectory = { from = [0, 0], to = [1, 1], duration = 1 }\n",
            "prescribed = ['joint1']\ntorque = { law = 'computed-torque', kp = 1, kd = 1 }",
            ["`joint1` is prescribed, and computed torque moves it too", "`forward.prescribed`"],
        ),
        (
            "fourbar.toml",
            "trajectory = { kind = 'constant-speed', from = [0], speed = [1] }\n",
            "prescribed = ['crank']",
            ["1 degree of freedom (crank), as many as the loops leave free", "`redysim inverse`"],
        ),
        (
            "fourbar.toml",
            "trajectory = { kind = 'constant-speed', joints = ['crank', 'rocker'], from = [0, 1], speed = [1, 0] }\n",
            "prescribed = ['crank', 'rocker']",
            [
                "2 degrees of freedom (crank, rocker), but the loops leave 1 free",
                "one joint determines how all others move",
            ],
        ),
    ] {
        let shown = fail(&folder, &["forward", &scenario(&folder, model, &format!("{trajectory}{RUN}{keys}\n"))], 1);
        for fault in faults {
            assert!(shown.contains(fault), "{keys}: no {fault} in {shown}");
        }
        assert!(shown.contains("trial.toml:"), "{keys}: {shown}");
    }
}

#[test]
fn inverse_dynamics_of_a_part_of_the_joints_names_the_way_to_compute_it() {
    let folder = scratch("prescribed-inverse");
    let path = scenario(&folder, "two_link.toml", &format!("{LED}[inverse]\nend = 1.0\nstep = 0.1\n"));
    let shown = fail(&folder, &["inverse", &path], 1);
    assert!(shown.contains("does not prescribe the joint `joint2`"), "{shown}");
    assert!(shown.contains("by `prescribed` of `[forward]`"), "{shown}");
}

#[test]
fn a_prescribed_joint_without_an_actuator_is_warned_of() {
    let folder = scratch("prescribed-passive");
    let motion = "trajectory = { kind = 'constant-speed', joints = ['pole'], from = [0], speed = [1] }\n";
    let run = "[forward]\nend = 0.1\nstep = 0.1\nprescribed = ['pole']\n";
    let run = call(&folder, &["forward", &scenario(&folder, "cart_pole.toml", &format!("{motion}{run}")), "-o", "run"]);
    assert!(
        run.code == 0 && run.stderr.contains("the joint `pole` is prescribed, but has no actuator"),
        "{}",
        run.output()
    );
}

/// A body of 2 kg on a vertical rail, and on it a foot of 1 kg that is held: the foot carries the body.
#[test]
fn a_prescribed_joint_takes_the_force_of_the_ground() {
    let folder = scratch("prescribed-ground");
    let link = |name: &str, parent: &str, mass: f64, actuated: bool| {
        format!(
            "[[link]]\nname = '{name}'\nparent = '{parent}'\njoint = 'prismatic'\naxis = [0, 0, 1]\nmass = {mass:?}\n\
             inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\nactuated = {actuated}\n"
        )
    };
    let [body, foot] = [link("body", "base", 2.0, false), link("foot", "body", 1.0, true)];
    let head = "name = 'hopper'\ngravity = [0, 0, -9.81]\nallow = ['under-actuated']\n";
    fs::write(folder.join("hopper.toml"), format!("{head}{body}{foot}[[frame]]\nname = 'sole'\nlink = 'foot'\n"))
        .unwrap();
    let contact = "[[contact]]\nlaw = 'hunt-crossley'\nframe = 'sole'\nstiffness = 2e4\ndamping = 0.8\nfriction = 0.5\n\
                   slip_velocity = 0.01\n";
    let motion = "trajectory = { kind = 'constant-speed', joints = ['foot'], from = [-0.1], speed = [0] }\n";
    let start = "model = 'hopper.toml'\ninitial = { q = { body = 0.102 } }\n";
    let run = "[forward]\nend = 20.0\nstep = 5.0\nintegrator = { method = 'Dop853', rtol = 1e-10, atol = 1e-12 }\n\
               prescribed = ['foot']\n";
    fs::write(folder.join("trial.toml"), format!("{start}{motion}{run}{contact}")).unwrap();
    succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    let table = |name: &str| Table::csv(&folder.join("run").join(name));
    let last = table("tor.csv").rows.pop().unwrap();
    assert!(last[1].abs() < 1e-12 && (last[2] + 2.0 * 9.81).abs() < 1e-2, "{last:?}");
    let drift = table("energy.csv").column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-7), "{drift:?}");
}

/// The motion of a body in space without forces depends on where its joints go, not on how fast.
#[test]
fn a_prescribed_motion_that_is_short_beside_the_run_moves_the_base_as_a_slow_one_does() {
    let folder = scratch("prescribed-short");
    let text = fs::read_to_string(root().join("scenarios/floating_three_link_prescribed.toml")).unwrap();
    let text = text.replace("../models", root().join("models").to_str().unwrap());
    let base_at_the_end = |duration: &str| {
        assert!(text.contains("duration = 20.0"));
        fs::write(folder.join("trial.toml"), text.replace("duration = 20.0", duration)).unwrap();
        succeed(&folder, &["forward", "trial.toml", "-o", "run", "--force", "--quiet"]);
        Table::csv(&folder.join("run/statevar.csv")).rows.last().unwrap()[1..8].to_vec()
    };
    let slow = base_at_the_end("duration = 20.0");
    assert!(slow[0].abs() > 0.05 && slow[5].abs() > 0.4, "{slow:?}");
    for duration in ["duration = 0.5", "duration = 0.05"] {
        let found = base_at_the_end(duration);
        let apart = slow.iter().zip(&found).map(|(slow, found)| (slow - found).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-3, "{duration}: {found:?} instead of {slow:?}");
    }
}
