//! `redysim forward` warns of steps that are too large.

use std::fs;

use crate::common::{SWING, call, root, scenario, scratch};

/// What a run of two links prints beside its results.
fn output(name: &str, rest: &str, options: &[&str]) -> String {
    let folder = scratch(name);
    let path = scenario(&folder, "two_link.toml", rest);
    call(&folder, &[&["forward", &path, "-o", "run"], options].concat()).stderr
}

fn with(settings: &str) -> String {
    format!("{SWING}integrator = {{ {settings} }}\n")
}

#[test]
fn steps_that_are_not_stable_are_warned_of_before_the_run() {
    let held = |step: &str| {
        let law = "torque = { law = 'pd', target = [0, 1], kp = 1000, kd = 100 }\n";
        with(&format!("method = 'Ode4', step = {step}")) + law
    };
    let long = output("steps-unstable", &held("0.02"), &[]);
    for word in ["with steps of 0.02 s Ode4 is not stable", "joint `joint2`", "method = \"Ode4\", step = ", "Ode15s"] {
        assert!(long.contains(word), "no `{word}` in: {long}");
    }
    let most = long.split("step = ").nth(1).unwrap().split(' ').next().unwrap();
    assert_eq!(output("steps-stable", &held(most), &[]), "");
}

/// The springs of one joint of the bushing are a thousand times as stiff or more, so that its motion is the fastest. It starts
/// where springs are relaxed: where they are not, such stiff ones make motions that grow by themselves.
#[test]
fn steps_that_are_not_stable_for_the_springs_of_a_joint_of_several_freedoms_are_warned_of_with_its_name() {
    const RELAXED: &str = "0.02, -0.03, 0.05, 0.1, 0.2, -0.1, 0.95, 0, 0.3, 0, 0.9, '20 deg', -0.1";
    let model = fs::read_to_string(root().join("models/test/bushing.toml")).unwrap();
    for (joint, soft, stiff) in [
        ("hull", "[300.0, 400.0, 500.0, 12.0, 15.0, 18.0]", "[3e5, 4e5, 5e5, 12.0, 15.0, 18.0]"),
        ("hull", "[300.0, 400.0, 500.0, 12.0, 15.0, 18.0]", "[300.0, 400.0, 500.0, 1.2e5, 1.5e5, 1.8e5]"),
        ("ball", "stiffness = 6.0", "stiffness = 6e4"),
        ("cross", "[3.0, 4.0]", "[3e4, 4e4]"),
    ] {
        let folder = scratch(&format!("steps-bushing-{joint}"));
        assert!(model.contains(soft), "{soft}");
        fs::write(folder.join("bushing.toml"), model.replacen(soft, stiff, 1)).unwrap();
        let warned = |method: &str, step: &str| {
            let run = format!(
                "model = 'bushing.toml'\n[initial]\nq = [{RELAXED}]\n[forward]\nend = 0.1\nstep = 0.1\nintegrator = {{ method = '{method}', step = \
                 {step} }}\n"
            );
            fs::write(folder.join("trial.toml"), run).unwrap();
            call(&folder, &["forward", "trial.toml", "-o", "run", "--force"]).stderr
        };
        for method in ["Ode4", "SemiImplicitEuler"] {
            let long = warned(method, "0.05");
            for word in [format!("with steps of 0.05 s {method} is not stable"), format!("of the joint `{joint}`")] {
                assert!(long.contains(&word), "no `{word}` in: {long}");
            }
            let most = long.split("step = ").nth(1).unwrap().split(' ').next().unwrap().to_owned();
            let short = warned(method, &most);
            assert!(!short.contains("not stable") && !short.contains("wrong"), "{method}, {most}: {short}");
        }
    }
}

/// A double pendulum in two steps: the energy grows to 10¹⁷⁷ J.
#[test]
fn a_motion_whose_energy_comes_from_nowhere_is_called_wrong() {
    let wild = with("method = 'Ode4', step = 0.5");
    let warned = output("steps-wild", &wild, &[]);
    assert!(warned.contains("the motion is wrong") && warned.contains("below 0.5 s"), "{warned}");
    assert_eq!(output("steps-wild-quiet", &wild, &["--quiet"]), "");
    assert_eq!(output("steps-right", &with("method = 'Ode4', step = 0.01"), &[]), "");
}

/// The forces of each instant are right, but between rows that are far apart nothing is computed.
#[test]
fn work_between_rows_that_are_too_far_apart_is_called_wrong() {
    let folder = scratch("steps-work");
    let lift = |step: f64| {
        let motion = "trajectory = { from = [0, 0], to = [1, 1], duration = 0.05 }\n";
        let path = scenario(&folder, "two_link.toml", &format!("{motion}[inverse]\nend = 1.8\nstep = {step}\n"));
        let run = call(&folder, &["inverse", &path, "-o", "run", "--force"]);
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    let output = lift(0.3);
    assert!(
        output.contains("too far apart") && output.contains("the forces are right") && output.contains("`step`"),
        "{output}"
    );
    assert_eq!(lift(0.001), "");
}
