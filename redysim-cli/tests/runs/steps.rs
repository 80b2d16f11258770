//! `redysim forward` warns of steps that are too large.

use crate::common::{SWING, call, scenario, scratch};

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
