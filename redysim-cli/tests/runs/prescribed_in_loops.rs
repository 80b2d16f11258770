//! Motions of closed loops in which some joints follow a trajectory, while the others are free or driven.

use std::fs;
use std::path::Path;

use crate::common::{AGAINST_CLOSED_FORMS, BALLS, Table, deviation, fail, root, scenario, scratch, succeed};

/// The 3-RRR robot, whose first crank is moved while a spring and a damper hold the third and all else falls.
fn three_rrr(folder: &Path, more: &str) -> impl Fn(&str) -> Table + use<> {
    let start = "[initial]\nq = [5, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869]\n";
    let motion = "[trajectory]\njoints = ['crank1']\nfrom = [1.05]\nto = [1.3]\nduration = 0.4\n";
    let run = "[forward]\nend = 0.5\nstep = 0.025\nprescribed = ['crank1']\n\
               torque = { law = 'pd', joints = ['crank3'], target = [5.7], kp = 60, kd = 5 }\n";
    let path = scenario(folder, "three_rrr.toml", &format!("{start}{motion}{run}{more}"));
    succeed(folder, &["forward", &path, "-o", "run"]);
    let run = folder.join("run");
    move |name| Table::csv(&run.join(format!("{name}.csv")))
}

/// Inverse dynamics of the recorded motion of all cranks is another way to their forces: by the loops' Jacobian by the
/// cranks, not by constraint forces.
#[test]
fn forces_in_closed_loops_are_those_of_inverse_dynamics_of_the_same_motion() {
    let folder = scratch("prescribed-loops-forces");
    let read = three_rrr(&folder, AGAINST_CLOSED_FORMS);
    let (state, forces) = (read("statevar"), read("tor"));
    let (crank1, crank3) = (forces.column("tau crank1 [N m]"), forces.column("tau crank3 [N m]"));
    let law = state.column("q crank3 [rad]").into_iter().zip(state.column("v crank3 [rad/s]"));
    for (force, (q, v)) in crank3.iter().zip(law) {
        assert!((force - (60.0 * (5.7 - q) - 5.0 * v)).abs() < 1e-12, "{force} is not that of the law");
    }
    for passive in ["rod1", "platform", "crank2", "rod2", "rod3"] {
        assert!(forces.column(&format!("tau {passive} [N m]")).iter().all(|force| *force == 0.0), "{passive}");
    }
    let held = "[initial]\nq = [1.05, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869]\n";
    let along = "trajectory = { kind = 'csv', file = 'run/traj.csv' }\n[inverse]\nend = 0.5\nstep = 0.025\n";
    succeed(
        &folder,
        &["inverse", &scenario(&folder, "three_rrr.toml", &format!("{along}{held}")), "-o", "again", "--quiet"],
    );
    let again = Table::csv(&folder.join("again/tor.csv"));
    let cranks = |table: &Table| {
        ["crank1", "crank2", "crank3"].map(|crank| table.column(&format!("tau {crank} [N m]"))).to_vec()
    };
    let worst = deviation(&cranks(&again), &cranks(&forces));
    assert!(worst < 1e-8, "off by {worst:e} N m");
    assert!(crank1.iter().any(|force| force.abs() > 10.0), "it takes some force: {crank1:?}");
}

/// The crank is where its trajectory has it at every row, the loops are closed, and energy comes from nowhere but the
/// joint forces, with every way to keep the loops closed.
#[test]
fn prescribed_joints_of_closed_loops_follow_their_trajectory_and_energy_is_balanced() {
    for (name, more, open) in [
        ("projection", AGAINST_CLOSED_FORMS.to_owned(), 1e-13),
        ("none", format!("{AGAINST_CLOSED_FORMS}stabilisation = 'none'\n"), 1e-9),
        ("gauss", "integrator = { method = 'Gauss6', step = 0.005 }\n".to_owned(), 1e-13),
    ] {
        let read = three_rrr(&scratch(&format!("prescribed-loops-{name}")), &more);
        let state = read("statevar");
        for (t, q) in state.column("t [s]").into_iter().zip(state.column("q crank1 [rad]")) {
            let share = (t / 0.4_f64).min(1.0);
            let turn = 2.0 * std::f64::consts::PI * share;
            let expected = 1.05 + 0.25 * (share - turn.sin() / (2.0 * std::f64::consts::PI));
            assert!((q - expected).abs() < 1e-14, "{name} at {t} s: {q} instead of {expected}");
        }
        let model = redysim_model::Model::load(root().join("models/three_rrr.toml")).unwrap().model;
        let mechanism = redysim_model::GenericMechanism::new(model);
        for row in &state.rows {
            let residual: Vec<f64> = redysim_runtime::LoopClosure::loop_residual(&mechanism, &row[1..8].to_vec());
            assert!(residual.iter().all(|component| component.abs() < open), "{name}: {residual:?}");
        }
        let drift = read("energy").column("drift [J]");
        assert!(drift.iter().all(|drift| drift.abs() < 1e-7), "{name}: {drift:?}");
    }
}

#[test]
fn a_run_of_closed_loops_with_prescribed_joints_can_be_done_again_from_its_results_to_the_last_bit() {
    let folder = scratch("prescribed-loops-again");
    let _ = three_rrr(&folder, "");
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let read = |run: &str, name: &str| fs::read_to_string(folder.join(run).join(name)).unwrap();
    for name in ["statevar.csv", "tor.csv", "energy.csv"] {
        assert_eq!(read("run", name), read("again", name), "{name}");
    }
}

/// The four-bar and two pendulums on the ground, which its loop leaves alone.
fn with_pendulums(folder: &Path) {
    let fourbar = fs::read_to_string(root().join("models/fourbar.toml")).unwrap();
    let pendulum = |name: &str| {
        format!(
            "[[link]]\nname = '{name}'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\nmass = 1.0\n\
             com = [0.5, 0, 0]\ninertia = {{ xx = 0.001, yy = 0.02, zz = 0.02 }}\n"
        )
    };
    let (links, loops) = fourbar.split_once("[[loop]]").unwrap();
    let text = format!("{links}{}{}[[loop]]{loops}", pendulum("left"), pendulum("right"));
    fs::write(folder.join("model.toml"), text).unwrap();
}

#[test]
fn motions_that_contradict_the_loops_are_refused_where_the_scenario_prescribes_them() {
    let folder = scratch("prescribed-loops-refused");
    with_pendulums(&folder);
    let start = "model = 'model.toml'\ninitial = { q = [0.0, 0.9844, 4.3144, 0, 0] }\n";
    let file = |motion: &str, rest: &str| {
        fs::write(folder.join("trial.toml"), format!("{start}trajectory = {{ {motion} }}\n{rest}\n")).unwrap();
    };
    let run = "[forward]\nend = 2.0\nstep = 0.1\n";
    let refused = |motion: &str, prescribed: &str, words: &[&str]| {
        file(motion, &format!("{run}prescribed = [{prescribed}]"));
        let shown = fail(&folder, &["forward", "trial.toml", "-o", "run", "--force"], 1);
        for word in [words, &["trial.toml:"]].concat() {
            assert!(shown.contains(word), "no `{word}` in {shown}");
        }
    };
    refused(
        "kind = 'constant-speed', joints = ['crank', 'rocker'], from = [0, 0.9844], speed = [1, 0]",
        "'crank', 'rocker'",
        &["the loops determine how `", "other joints of `prescribed`", "out: it follows from the loops"],
    );
    refused(
        "kind = 'constant-speed', joints = ['rocker'], from = ['-120 deg'], speed = [0]",
        "'rocker'",
        &["where the prescribed joints (rocker) are at t = 0.0 s", "cannot be closed", "where the links reach"],
    );
    // The rocker goes on beyond where crank and coupler are in line.
    file(
        "kind = 'constant-speed', joints = ['rocker'], from = [0.9844], speed = [4]",
        &format!("{run}prescribed = ['rocker']"),
    );
    let shown = fail(&folder, &["forward", "trial.toml", "-o", "run", "--force"], 3);
    assert!(shown.contains("is kept") && shown.contains("`prescribed`") && shown.contains("reach"), "{shown}");
}

/// Of a mechanism whose loops leave a pendulum alone, the crank's force is that of the four-bar by itself.
#[test]
fn what_the_loops_leave_alone_does_not_change_the_force_of_a_prescribed_joint() {
    let folder = scratch("prescribed-loops-alone");
    with_pendulums(&folder);
    let motion = "trajectory = { kind = 'constant-speed', joints = ['crank'], from = [0], speed = [4] }\n";
    let text = format!(
        "model = 'model.toml'\ninitial = {{ q = [0.0, 0.9844, 4.3144, 0.3, -0.2] }}\n{motion}[forward]\nend = 1.0\n\
         step = 0.05\nprescribed = ['crank']\n{AGAINST_CLOSED_FORMS}"
    );
    fs::write(folder.join("led.toml"), text).unwrap();
    succeed(&folder, &["forward", "led.toml", "-o", "run"]);
    let inverse = format!("initial = {{ q = [0.0, 0.9844, 4.3144] }}\n{motion}[inverse]\nend = 1.0\nstep = 0.05\n");
    succeed(&folder, &["inverse", &scenario(&folder, "fourbar.toml", &inverse), "-o", "alone", "--quiet"]);
    let force = |run: &str| vec![Table::csv(&folder.join(run).join("tor.csv")).column("tau crank [N m]")];
    let worst = deviation(&force("run"), &force("alone"));
    assert!(worst < 1e-9, "off by {worst:e} N m");
}

/// The rocker of the crank and the rocker with a ball at either end of their coupler may also tilt: by a universal joint, or by two
/// revolute ones.
#[test]
fn one_velocity_of_a_joint_in_closed_loops_follows_its_trajectory_while_the_other_moves_as_the_loops_leave_it() {
    let folder = scratch("prescribed-loops-velocity");
    let rocker = "joint = 'revolute'\naxis = [0, 1, 0]\norigin = { xyz = [1, 0, 0] }";
    let tilting = BALLS.replace(rocker, "joint = 'universal'\norigin = { xyz = [1, 0, 0] }");
    let name = "[[link]]\nname = 'rocker'\nparent = 'base'\n";
    let tilt = "[[link]]\nname = 'tilt'\nparent = 'base'\njoint = 'revolute'\naxis = [1, 0, 0]\norigin = { xyz = [1, 0, 0] }\nmass = 0\n\
                inertia = { xx = 0, yy = 0, zz = 0 }\nactuated = false\n[[link]]\nname = 'rocker'\nparent = 'tilt'\n";
    let on_two = BALLS.replace(rocker, "joint = 'revolute'\naxis = [0, 1, 0]\norigin = {}").replace(name, tilt);
    assert!(tilting.contains("universal") && on_two.contains("'tilt'"));
    let run = |model: &str, tilts: &str| {
        fs::write(
            folder.join("model.toml"),
            model.replace("allow = [", "allow = ['point-masses', 'missing-inertia', "),
        )
        .unwrap();
        let text = format!(
            "model = 'model.toml'\ninitial = {{ q = {{ coupler = {{ rpy = [0, -0.6435, 0] }} }} }}\n[trajectory]\njoints = ['{tilts}']\n\
             from = [0.05]\nto = [0.25]\nduration = 0.4\n[forward]\nend = 0.4\nstep = 0.05\nprescribed = ['{tilts}']\n\
             {AGAINST_CLOSED_FORMS}"
        );
        fs::write(folder.join("trial.toml"), text).unwrap();
        succeed(&folder, &["forward", "trial.toml", "-o", "run", "--force", "--quiet"]);
        ["statevar", "tor"].map(|name| Table::csv(&folder.join("run").join(format!("{name}.csv"))).rows)
    };
    let [states, forces] = run(&tilting, "rocker.phi");
    let [other_states, other_forces] = run(&on_two, "tilt");
    let off = [deviation(&states, &other_states), deviation(&forces, &other_forces)];
    assert!(off[0] < 1e-10 && off[1] < 1e-9, "{off:?}");
    let (first, last) = (&states[0], &states[8]);
    assert!((first[2], last[2]) == (0.05, 0.25), "the tilt follows: {first:?}, {last:?}");
    assert!((last[3] - first[3]).abs() > 0.01 && (last[1] - first[1]).abs() > 0.01, "the others move: {last:?}");
    assert!(forces.iter().all(|row| row[3] == 0.0) && forces.iter().any(|row| row[2].abs() > 0.1), "{forces:?}");
}
