//! Closed loops under control, and what keeps them closed, against closed forms.

use crate::common::{AGAINST_CLOSED_FORMS, Table, call, deviation, fail, refuses_in, root, scenario, scratch, succeed};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::LoopClosure;

/// The motion of the four-bar by a scenario's `forward`, every 0.05 s for half a second.
fn fourbar(name: &str, top: &str, forward: &str) -> Table {
    let folder = scratch(name);
    let rest = format!("{top}\n[forward]\nend = 0.5\nstep = 0.05\n{AGAINST_CLOSED_FORMS}{forward}\n");
    succeed(&folder, &["forward", &scenario(&folder, "fourbar.toml", &rest), "-o", "run"]);
    Table::csv(&folder.join("run/statevar.csv"))
}

/// (e₀ + (ė₀ + ω e₀) t) exp(−ω t): what is left of an error that is critically damped.
fn damped(t: f64, rate: f64, e: f64, speed: f64) -> f64 {
    (e + (speed + rate * e) * t) * (-rate * t).exp()
}

#[test]
fn computed_torque_leaves_the_crank_the_error_of_a_damped_spring() {
    let top =
        "initial = { q = [0, 0.9844, 4.3144] }\ntrajectory = { kind = 'constant-speed', from = [0.1], speed = [4] }";
    let found = fourbar("loops-computed", top, "torque = { law = 'computed-torque', kp = 100, kd = 20 }");
    let crank: Vec<Vec<f64>> = found.column("q crank [rad]").into_iter().map(|q| vec![q]).collect();
    let exact = |t: f64| vec![0.1 + 4.0 * t - damped(t, 10.0, 0.1, 4.0)];
    let exact: Vec<Vec<f64>> = found.column("t [s]").into_iter().map(exact).collect();
    let worst = deviation(&crank, &exact);
    assert!(worst < 1e-9, "off by {worst:e}");
}

/// The rocker cannot go further than where crank and coupler are in line: there its speed no longer determines the
/// crank's.
#[test]
fn computed_torque_reports_where_the_prescribed_joint_determines_nothing() {
    let folder = scratch("loops-dead-point");
    let rest = "initial = { q = [0, 0.9844, 4.3144] }\n\
                trajectory = { kind = 'constant-speed', joints = ['rocker'], from = [0.9844], speed = [4] }\n\
                [forward]\nend = 2.0\nstep = 0.1\ntorque = { law = 'computed-torque', kp = 100, kd = 20 }\n";
    let output = fail(&folder, &["forward", &scenario(&folder, "fourbar.toml", rest), "-o", "run"], 3);
    assert!(output.contains("determine 1 of the 2 coordinates") && output.contains("is kept"), "{output}");
}

/// The four-bar has one joint to prescribe.
#[test]
fn as_many_joints_are_prescribed_as_the_loops_leave_free() {
    let folder = scratch("loops-prescribed");
    let runs = "[inverse]\nend = 1.0\nstep = 0.1\n[forward]\nend = 1.0\nstep = 0.1\n\
                torque = { law = 'computed-torque', kp = 1, kd = 1 }\n";
    for (joints, zeros, wrong) in [
        ("'crank', 'rocker'", "0, 0", "prescribes 2 degrees of freedom (crank, rocker), but the loops leave 1 free"),
        ("", "", "`trajectory.joints` names no joint"),
    ] {
        let motion = format!("kind = 'constant-speed', joints = [{joints}], from = [{zeros}], speed = [{zeros}]");
        let path = scenario(&folder, "fourbar.toml", &format!("trajectory = {{ {motion} }}\n{runs}"));
        for command in ["inverse", "forward"] {
            let output = fail(&folder, &[command, &path, "-o", "run"], 1);
            assert!(output.contains(wrong), "{output}");
        }
    }
}

/// What is warned of in a run that goes well.
fn warned(name: &str, model: &str, rest: &str) -> String {
    let folder = scratch(name);
    let run = call(&folder, &["forward", &scenario(&folder, model, rest), "-o", "run"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    run.stderr
}

/// The feedback does work while it closes the loops: that is no fault of the motion.
#[test]
fn the_work_of_baumgartes_feedback_is_not_called_wrong() {
    let open = "initial = { q = [0, 1.5, 4.0], assemble = false }\n[forward]\nend = 0.5\nstep = 0.1\n\
                integrator = { method = 'Ode45', rtol = 1e-8, atol = 1e-8 }\n";
    let output =
        warned("loops-work", "fourbar.toml", &format!("{open}stabilisation = {{ kind = 'baumgarte', alpha = 20 }}\n"));
    assert_eq!(output, "");
}

#[test]
fn computed_torque_of_loops_with_redundant_constraints_needs_them_closed() {
    let rest = |stabilisation: &str| {
        format!(
            "initial = {{ q = [0, 0.9844, 4.3144] }}\ntrajectory = {{ kind = 'constant-speed', from = [0], speed = [1] }}\n\
             [forward]\nend = 0.02\nstep = 0.01\ntorque = {{ law = 'computed-torque', kp = 100, kd = 20 }}\n\
             stabilisation = {stabilisation}\n"
        )
    };
    let output = warned("loops-redundant", "test/fourbar_spatial.toml", &rest("'none'"));
    assert!(
        output.contains("3 constraints 2 are independent, for which computed torque needs closed loops"),
        "{output}"
    );
    let output = warned("loops-redundant-closed", "test/fourbar_spatial.toml", &rest("'projection'"));
    assert!(!output.contains("computed torque"), "{output}");
}

#[test]
fn settings_of_loops_have_no_effect_on_a_tree_and_are_warned_of() {
    // `alpha` is not required either.
    let rest = "initial = { assemble = false, held = ['joint1'] }\n[forward]\nend = 0.2\nstep = 0.1\n\
                stabilisation = { kind = 'baumgarte' }\n";
    let output = warned("loops-none", "two_link.toml", rest);
    for key in ["initial.assemble", "initial.held", "forward.stabilisation"] {
        assert!(
            output.contains(&format!("`{key}` applies only to closed loops, and the model has no loops")),
            "{key}: {output}"
        );
    }
}

/// r̈ + 2 α ṙ + α² r = 0, whatever the mechanism does meanwhile.
#[test]
fn baumgartes_feedback_closes_a_loop_that_starts_open() {
    let top = "initial = { q = [0, 0.9844, 4.3144], assemble = false }";
    let found = fourbar("loops-baumgarte", top, "stabilisation = { kind = 'baumgarte', alpha = 10 }");
    let mechanism = GenericMechanism::new(Model::load(root().join("models/fourbar.toml")).unwrap().model);
    let residuals: Vec<Vec<f64>> = found.columns(1..4).iter().map(|q| mechanism.loop_residual(q)).collect();
    let expected = |t: f64| residuals[0].iter().map(|&open| damped(t, 10.0, open, 0.0)).collect();
    let expected: Vec<Vec<f64>> = found.column("t [s]").into_iter().map(expected).collect();
    assert!(residuals[0].iter().any(|open| open.abs() > 1e-6), "it starts open: {:?}", residuals[0]);
    let worst = deviation(&residuals, &expected);
    assert!(worst < 1e-10, "off by {worst:e}");
}

#[test]
fn baumgartes_feedback_needs_its_rate() {
    let folder = scratch("loops-no-rate");
    let rest = "[forward]\nend = 1.0\nstep = 0.1\nstabilisation = 'baumgarte'\n";
    let output = fail(&folder, &["forward", &scenario(&folder, "fourbar.toml", rest), "-o", "run"], 1);
    assert!(output.contains("alpha") && output.contains("alpha = 20.0"), "{output}");
}

#[test]
fn what_assembly_changes_of_the_start_is_reported() {
    let folder = scratch("loops-start");
    let rest = "initial = { q = [0, 0.9844, 4.3144], v = [4.7124, 99, -77] }\n[forward]\nend = 0.1\nstep = 0.1\n";
    let output = succeed(&folder, &["forward", &scenario(&folder, "fourbar.toml", rest), "-o", "run"]);
    assert!(output.contains("the start moves rocker by -2.694e-5 rad"), "{output}");
    // The rocker turns at 1.4045 rad/s when the crank is at zero and turns at 4.7124 rad/s; the coupler then stands.
    assert!(output.contains("its speeds change: rocker by -97.6 rad/s, coupler by 77 rad/s"), "{output}");
}

/// One error names the loop, in numbers that a person reads, and what to do.
#[test]
fn a_start_whose_loops_stay_open_is_one_error() {
    for (initial, words) in [
        (
            "assemble = false",
            ["the start leaves the loop `crank-coupler` open by 0.038 m", "leave `initial.assemble` out"],
        ),
        ("held = ['crank', 'rocker']", ["the loop `crank-coupler` is closed: it stays open by", "`initial.held`"]),
    ] {
        let rest = format!("initial = {{ q = [0, 1.5, 4.0], {initial} }}\n[forward]\nend = 0.1\nstep = 0.1\n");
        let folder = scratch("loops-open");
        refuses_in(&folder, "forward", &scenario(&folder, "fourbar.toml", &rest), 1, &words);
    }
}
