//! Torque laws with states, models, frames and limits in scenarios, against closed forms, and how their faults are
//! reported.

use std::fs;
use std::path::Path;

use crate::common::{AGAINST_CLOSED_FORMS, SWING, Table, names, refuses, refuses_in, root, scenario, scratch, succeed};

const GRAVITY: f64 = 9.81;

/// 2 kg on a level rail, pushed by at most 5 N.
const SLIDER: &str = "name = 'slider'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'slider'\nparent = 'base'\n\
                      joint = 'prismatic'\naxis = [1, 0, 0]\norigin = { xyz = [0, 0, 0] }\nmass = 2.0\n\
                      range = { position = [-9, 9], velocity = 9, force = 5.0 }\n";

/// The folder of the results of a forward run of the model in `text`.
fn run_of(folder: &Path, text: &str, rest: &str) -> std::path::PathBuf {
    fs::write(folder.join("model.toml"), text).unwrap();
    fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{rest}")).unwrap();
    succeed(folder, &["forward", "trial.toml", "-o", "run", "--force", "--quiet"]);
    folder.join("run")
}

fn pendulum(folder: &Path, law: &str) -> std::path::PathBuf {
    let rest = format!("[forward]\nend = 20.0\nstep = 0.05\n{AGAINST_CLOSED_FORMS}torque = {{ {law} }}\n");
    let path = scenario(folder, "simple_pendulum.toml", &rest);
    succeed(folder, &["forward", &path, "-o", "run", "--force", "--quiet"]);
    folder.join("run")
}

/// m (s + 1)(s + 2)(s + 3) = m s³ + kd s² + kp s + ki: from rest, ë(0) = −kp/m.
#[test]
fn pid_error_follows_its_characteristic_polynomial() {
    let folder = scratch("pid-polynomial");
    let law = "torque = { law = 'pid', target = [1], kp = 22, ki = 12, kd = 12 }\n";
    let run = run_of(&folder, SLIDER, &format!("[forward]\nend = 4.0\nstep = 0.1\n{AGAINST_CLOSED_FORMS}{law}"));
    let found = Table::csv(&run.join("statevar.csv"));
    for (t, q) in found.column("t [s]").into_iter().zip(found.column("q slider [m]")) {
        let error = -2.5 * (-t).exp() + 8.0 * (-2.0 * t).exp() - 4.5 * (-3.0 * t).exp();
        assert!((1.0 - q - error).abs() < 1e-9, "{q} at {t} s");
    }
    // Its rate of anti-windup, 1/s, and the joints that it drives stand in the copy.
    let text = fs::read_to_string(run.join("run.toml")).unwrap();
    assert!(text.contains("tracking_rate = [1.0]") && text.contains("joints = [\"slider\"]"), "{text}");
}

#[test]
fn a_run_with_pid_can_be_done_again_from_its_results() {
    let folder = scratch("pid-again");
    let run = pendulum(&folder, "law = 'pid', target = [1], kp = 50, ki = 30, kd = 20, limits = 12");
    succeed(&folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let read = |name: &str| fs::read_to_string(folder.join(name).join("statevar.csv")).unwrap();
    assert_eq!(read("run"), read("again"));
    assert!(names(&run).contains(&"statevar.csv".to_owned()));
}

#[test]
fn integral_action_carries_the_weight_at_the_target() {
    let run = pendulum(&scratch("pid-weight"), "law = 'pid', target = [1], kp = 50, ki = 60, kd = 20");
    let (q, tau) = (Table::csv(&run.join("statevar.csv")), Table::csv(&run.join("tor.csv")));
    let (q, tau) = (*q.column("q bar [rad]").last().unwrap(), *tau.column("tau bar [N m]").last().unwrap());
    assert!((q - 1.0).abs() < 1e-8 && (tau - GRAVITY * 1.0_f64.sin()).abs() < 1e-6, "{q} {tau}");
}

#[test]
fn limits_cut_off_the_forces_of_a_law_and_those_of_the_range_are_the_models() {
    for (name, limits) in [("number", "5"), ("array", "[5]"), ("name", "{ slider = 5.0 }"), ("range", "'range'")] {
        let folder = scratch(&format!("limits-{name}"));
        let law = format!("torque = {{ law = 'pd', target = [1], kp = 200, kd = 40, limits = {limits} }}\n");
        let run = run_of(&folder, SLIDER, &format!("[forward]\nend = 3.0\nstep = 0.05\n{law}"));
        let tau = Table::csv(&run.join("tor.csv")).column("tau slider [N]");
        assert_eq!(tau[0], 5.0, "{limits}");
        assert!(tau.iter().all(|tau| tau.abs() <= 5.0) && tau.contains(&-5.0), "{limits}: {tau:?}");
        // 5 N on 2 kg.
        let q = Table::csv(&run.join("statevar.csv")).column("q slider [m]")[4];
        assert!((q - 0.5 * 2.5 * 0.04).abs() < 1e-6, "{limits}: {q}");
    }
}

#[test]
fn pd_with_gravity_is_off_by_the_payload_that_it_assumes_over_its_gain() {
    let at = |name: &str, payload: &str| {
        let law = format!("law = 'pd-gravity', target = [1], kp = 40, kd = 20{payload}");
        let run = pendulum(&scratch(&format!("pd-gravity-{name}")), &law);
        *Table::csv(&run.join("statevar.csv")).column("q bar [rad]").last().unwrap()
    };
    let right = at("right", "");
    assert!((right - 1.0).abs() < 1e-9, "{right}");
    for (name, mass, com) in [("heavy", 0.8, 1.5), ("light", -0.5, 1.0)] {
        let q = at(name, &format!(", payload = {{ link = 'bar', mass = {mass}, com = [{com}, 0, 0] }}"));
        let excess = mass * com * GRAVITY * q.sin();
        assert!((40.0 * (q - 1.0) - excess).abs() < 1e-7 && (q - 1.0).abs() > 0.05, "{name}: {q}");
    }
}

/// KR5 with a tool in the origin of its last link.
fn kr5() -> String {
    let frame = "\n[[frame]]\nname = 'tool'\nlink = 'link6'\norigin = { xyz = [0, 0, 0] }\n";
    fs::read_to_string(root().join("models/kr5.toml")).unwrap() + frame
}

#[test]
fn impedance_leads_a_frame_to_its_target_along_its_spring() {
    let folder = scratch("impedance-target");
    let start = "initial = { q = [0.2, 0.9, -0.4, 0.3, 0.8, 0.1] }\n";
    let law = |target: &str| {
        format!(
            "{start}[forward]\nend = 4.0\nstep = 1.0\nintegrator = {{ method = 'Ode15s', rtol = 1e-8, atol = 1e-9 }}\n\
             torque = {{ law = 'impedance', frame = 'tool', {target}stiffness = [900, 700, 800], damping = 300, \
             angular_stiffness = 90, angular_damping = 30, null_space_damping = 1, compensation = 'bias' }}\n"
        )
    };
    let origin = |run: &Path, row: usize| {
        let table = Table::csv(&run.join("kinematics.csv"));
        ["x", "y", "z"].map(|axis| table.column(&format!("{axis} link6 [m]"))[row])
    };
    let held = run_of(&folder, &kr5(), &law(""));
    let from = origin(&held, 0);
    for (found, expected) in origin(&held, 4).iter().zip(from) {
        assert!((found - expected).abs() < 1e-9, "without a target it stays: {found} {expected}");
    }
    let to = [from[0] + 0.05, from[1] - 0.03, from[2] + 0.04];
    let led = origin(&run_of(&folder, &kr5(), &law(&format!("target = {{ xyz = {to:?} }}, "))), 4);
    for (found, expected) in led.iter().zip(to) {
        assert!((found - expected).abs() < 1e-4, "{led:?} instead of {to:?}");
    }
}

#[test]
fn laws_with_faults_are_refused_where_they_stand() {
    let law = |keys: &str| format!("{SWING}torque = {{ {keys} }}\n");
    let pid = |keys: &str| law(&format!("law = 'pid', target = [0, 0], kp = 9, kd = 3, {keys}"));
    refuses(
        "ki",
        "forward",
        &law("law = 'pid', target = [0, 0], kp = 9, kd = 3"),
        1,
        &["`forward.torque.ki` is missing"],
    );
    let words = ["`forward.torque.limits[1]` is -2.0, which is not above zero", "trial.toml:6:"];
    refuses("negative", "forward", &pid("ki = 1, limits = [3, -2]"), 1, &words);
    refuses("windup", "forward", &pid("ki = 1, tracking_rate = -2"), 1, &["a negative rate adds to the windup"]);
    refuses("count", "forward", &pid("ki = 1, limits = [3]"), 1, &["2 values, one for each of joint1, joint2"]);
    refuses(
        "word",
        "forward",
        &pid("ki = 1, limits = 'rnage'"),
        1,
        &["`forward.torque.limits` cannot be `rnage`", "range"],
    );
    let words =
        ["is \"range\", and the joint `joint1` has no `range.force`", "in the model, or write", "trial.toml:6:"];
    refuses("range", "forward", &pid("ki = 1, limits = 'range'"), 1, &words);

    let gravity =
        |payload: &str| law(&format!("law = 'pd-gravity', target = [0, 0], kp = 9, kd = 3, payload = {payload}"));
    refuses("payload", "forward", &gravity("{ mass = 1 }"), 1, &["`forward.torque.payload.link` is missing"]);
    refuses("link", "forward", &gravity("{ link = 'link3', mass = 1 }"), 1, &["unknown link `link3`", "link1, link2"]);
    let words =
        ["a payload of -0.7 kg", "`link1` of 0.5 kg has a negative mass", "take off 0.5 kg at most", "trial.toml:6:"];
    refuses("light", "forward", &gravity("{ link = 'link1', mass = -0.7 }"), 1, &words);

    let impedance = |keys: &str| law(&format!("law = 'impedance', frame = 'tool', {keys}"));
    let words = [
        "requires a frame, but the model does not have a `[[frame]]`",
        "add a table `[[frame]]`",
        "name = \"tool\"",
        "trial.toml:6:",
    ];
    refuses("frames", "forward", &impedance("stiffness = 9, damping = 3"), 1, &words);
    refuses("limits-of-free", "forward", &law("law = 'free', limits = 3"), 1, &["unknown key `forward.torque.limits`"]);
}

#[test]
fn a_frame_is_held_only_if_the_model_has_it_and_its_gains_are_not_negative() {
    let folder = scratch("impedance-faults");
    fs::write(folder.join("model.toml"), kr5()).unwrap();
    let refused = |keys: &str, words: &[&str]| {
        let text = format!(
            "model = 'model.toml'\n[forward]\nend = 1.0\nstep = 0.1\ntorque = {{ law = 'impedance', {keys} }}\n"
        );
        fs::write(folder.join("trial.toml"), text).unwrap();
        refuses_in(&folder, "forward", "trial.toml", 1, words);
    };
    refused("frame = 'tol', stiffness = 9, damping = 3", &["unknown frame `tol`", "`tool`", "trial.toml:5:"]);
    let words = ["`forward.torque.stiffness[2]` is -9.0, and must not be negative", "drives the frame away"];
    refused("frame = 'tool', stiffness = [9, 9, -9], damping = 3", &words);
    refused("frame = 'tool', stiffness = [9, 9], damping = 3", &["`forward.torque.stiffness`", "3 numbers", "found 2"]);
    refused("frame = 'tool', stiffness = 9", &["`forward.torque.damping` is missing"]);
    let words = ["`forward.torque.compensation` cannot be `all`", "gravity", "bias"];
    refused("frame = 'tool', stiffness = 9, damping = 3, compensation = 'all'", &words);
    let words = ["`forward.torque.target.xyz`", "3 numbers", "found 2"];
    refused("frame = 'tool', stiffness = 9, damping = 3, target = { xyz = [1, 2] }", &words);
}

#[test]
fn laws_that_carry_the_weight_of_a_tree_are_refused_for_closed_loops() {
    let folder = scratch("laws-loops");
    let law = "initial = { q = [0, 0.9844, 4.3144] }\n[forward]\nend = 1.0\nstep = 0.1\n\
               torque = { law = 'pd-gravity', target = [0], kp = 9, kd = 3 }\n";
    let words =
        ["the law `pd-gravity` requires a tree, but the model has closed loops", "computed-torque", "trial.toml:6:"];
    refuses_in(&folder, "forward", &scenario(&folder, "fourbar.toml", law), 1, &words);
}

/// A rod of which a wrong gain makes a motion that grows until it is ended.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_law_that_drives_away_is_named_and_not_the_tolerance() {
    let folder = scratch("laws-unstable");
    let output = |law: &str, integrator: &str| {
        let rest = format!("[forward]\nend = 2.0\nstep = 0.1\ntorque = {{ {law} }}\nintegrator = {{ {integrator} }}\n");
        let path = crate::common::scenario(&folder, "simple_pendulum.toml", &rest);
        crate::common::call(&folder, &["forward", &path, "-o", "run", "--force"]).stderr
    };
    let adaptive = "method = 'Ode45'";
    for (law, gain) in [
        ("law = 'p', target = [1], kp = -400", "`kp` has the sign that drives away"),
        ("law = 'pd', target = [1], kp = 4, kd = -20, limits = 1e9", "`kd` has the sign that drives away"),
        ("law = 'pid', target = [1], kp = 1, ki = 9000, kd = 0.1", "may be wrong in size"),
    ] {
        for integrator in [adaptive, "method = 'Ode4', step = 1e-4"] {
            let shown = output(law, integrator);
            assert!(shown.contains("the motion grows without bound: at t = "), "{law}, {integrator}: {shown}");
            assert!(shown.contains(gain), "{law}, {integrator}: {shown}");
            assert!(!shown.contains("below"), "{law}, {integrator}: {shown}");
        }
    }
    assert_eq!(output("law = 'pd', target = [1], kp = 40, kd = 4", adaptive), "");
    // A law that holds, in steps that are too large.
    let steps = output("law = 'pd', target = [1], kp = 4000, kd = 400", "method = 'Ode4', step = 0.05");
    assert!(steps.contains("take a `step` of the integrator below 0.05 s"), "{steps}");
}

#[test]
fn a_negative_gain_is_warned_of_before_it_does_harm() {
    let folder = scratch("laws-negative-gain");
    let shown = |gains: &str| {
        let law = format!("{{ law = 'pd', target = {{}}, {gains} }}");
        let path = scenario(&folder, "kr5.toml", &format!("[forward]\nend = 0.01\nstep = 0.01\ntorque = {law}\n"));
        crate::common::call(&folder, &["forward", &path, "-o", "run", "--force"]).stderr
    };
    let warned = shown("kp = 4, kd = { joint2 = -0.5 }");
    assert!(
        warned.contains("warning: the scenario: `forward.torque.kd.joint2` is -0.5, and a negative gain"),
        "{warned}"
    );
    assert!(warned.contains("trial.toml:5:"), "{warned}");
    assert_eq!(shown("kp = 0, kd = -0.0"), "");
}

/// A negative gain makes steps as small as a stiff equation does, for which an implicit method is no remedy.
#[test]
fn a_law_that_drives_away_is_not_called_stiff() {
    let folder = scratch("laws-not-stiff");
    for (model, target) in [("simple_pendulum.toml", "[1]"), ("kr5.toml", "[1, 1, 1, 1, 1, 1]")] {
        let law = format!("{{ law = 'pd', target = {target}, kp = -400, kd = 1 }}");
        let rest = format!("[forward]\nend = 3.0\nstep = 0.1\ntorque = {law}\nintegrator = {{ method = 'Ode45' }}\n");
        let path = scenario(&folder, model, &rest);
        let shown = crate::common::call(&folder, &["forward", &path, "-o", "run", "--force"]).stderr;
        assert!(shown.contains("`kp` has the sign that drives away") && !shown.contains("Ode15s"), "{shown}");
        // One for the warning of the gain, and one for the motion.
        assert_eq!(shown.matches("= help: ").count(), 2, "{shown}");
    }
}

/// An arm whose light wrist is driven away: the steps become so small that the end would never come.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_motion_without_bound_whose_end_would_never_come_is_ended() {
    let folder = scratch("laws-endless");
    let rest = "initial = { q = [0, 0, 0, 0, 0, 0] }\n[forward]\nend = 3.0\nstep = 0.01\nintegrator = { method = 'Ode45' }\n\
                torque = { law = 'pd', target = [1, 1, 1, 1, 1, 1], kp = -400, kd = -40 }\n";
    let run = crate::common::call(&folder, &["forward", &scenario(&folder, "kr5.toml", rest), "-o", "run"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    for part in [
        "the motion grows without bound: at t = ",
        "the rest would take",
        "`kp` and `kd` have the sign that drives away",
    ] {
        assert!(run.stderr.contains(part), "{part}: {}", run.stderr);
    }
    let (_, error) = run.stderr.split_once("error: ").unwrap();
    assert_eq!(error.matches("= help: ").count(), 1, "one error has both: {}", run.stderr);
}

/// The crank rests where it was sent, and the loops stay closed.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn pid_drives_closed_loops() {
    let folder = scratch("pid-loops");
    let rest = "initial = { q = [0, 0.9844, 4.3144] }\n[forward]\nend = 20.0\nstep = 1.0\n\
                integrator = { method = 'Ode45', rtol = 1e-7, atol = 1e-9 }\n\
                torque = { law = 'pid', target = [0.5], kp = 60, ki = 60, kd = 20, limits = 20 }\n";
    let path = scenario(&folder, "fourbar.toml", rest);
    succeed(&folder, &["forward", &path, "-o", "run", "--quiet"]);
    let q = Table::csv(&folder.join("run/statevar.csv")).column("q crank [rad]");
    assert!((q.last().unwrap() - 0.5).abs() < 1e-4, "{q:?}");
}

#[test]
fn a_push_of_a_table_gives_its_impulse_however_short_it_is_beside_the_run() {
    let folder = scratch("laws-push");
    for width in [1.0, 1e-2, 1e-4] {
        // A triangle of 4 N s.
        let (middle, end, top) = (1.0 + width / 2.0, 1.0 + width, 8.0 / width);
        let rows = format!("0,0\n1,0\n{middle},{top}\n{end},0\n20,0\n");
        fs::write(folder.join("push.csv"), format!("t [s],tau slider [N]\n{rows}")).unwrap();
        let law = "torque = { law = 'csv', file = 'push.csv' }\n";
        let run = run_of(&folder, SLIDER, &format!("[forward]\nend = 20.0\nstep = 1.0\n{law}"));
        let found = Table::csv(&run.join("statevar.csv"));
        let (q, v) = (found.column("q slider [m]")[20], found.column("v slider [m/s]")[20]);
        let expected = 2.0 * (20.0 - middle);
        assert!((v - 2.0).abs() < 2e-3 && (q - expected).abs() < 1e-3 * expected, "{width} s: {q} m, {v} m/s");
    }
}
