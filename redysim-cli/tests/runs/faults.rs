//! Bad input gives one clear message and the right exit code, and leaves nothing behind.

use std::fs;

use crate::common::{LIFT, SWING, fail, refuses, refuses_in, scenario, scratch, succeed};

#[test]
fn a_missing_scenario_is_reported_with_its_path() {
    let folder = scratch("faults-no-scenario");
    refuses_in(&folder, "forward", "nowhere.toml", 3, &["cannot read nowhere.toml", "help"]);
    fs::create_dir(folder.join("folder.toml")).unwrap();
    refuses_in(&folder, "forward", "folder.toml", 3, &["cannot read folder.toml", "it is a folder: name a file"]);
}

#[test]
fn a_missing_model_is_reported_at_the_key_that_names_it() {
    let folder = scratch("faults-no-model");
    fs::write(folder.join("trial.toml"), format!("model = 'nowhere.toml'\n{SWING}")).unwrap();
    refuses_in(
        &folder,
        "forward",
        "trial.toml",
        1,
        &["cannot read the model file", "nowhere.toml", "folder of the scenario", "trial.toml:1:9"],
    );
    fs::write(folder.join("trial.toml"), SWING).unwrap();
    refuses_in(&folder, "forward", "trial.toml", 1, &["`model` is missing", "trial.toml:1:1"]);
}

#[test]
fn a_model_in_the_place_of_a_scenario_is_recognised_and_the_other_way_round() {
    let folder = scratch("faults-place");
    let scenario = scenario(&folder, "two_link.toml", SWING);
    let model = crate::common::model("two_link.toml");
    refuses_in(&folder, "forward", &model, 1, &["is a model, not a scenario", "model = "]);
    refuses_in(&folder, "inverse", &model, 1, &["is a model, not a scenario"]);
    for command in ["check", "generate"] {
        let output = fail(&folder, &[command, &scenario], 1);
        assert!(output.contains("is a scenario, not a model") && output.contains("two_link.toml"), "{output}");
        assert_eq!(output.matches("error: ").count(), 1, "{output}");
    }
}

/// What cannot be read is outside, whoever asks for it.
#[test]
fn a_folder_in_the_place_of_a_model_is_refused() {
    let folder = scratch("faults-folder");
    for command in ["check", "generate"] {
        let output = fail(&folder, &[command, "."], 3);
        assert!(output.contains("it is a directory"), "{output}");
    }
}

#[test]
fn a_model_with_a_fault_is_reported_with_its_own_lines() {
    let folder = scratch("faults-model");
    fs::write(
        folder.join("model.toml"),
        "name = 'x'\ngravity = [0, 0, 0]\n[[link]]\nname = 'a'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\nmass = -1\n",
    )
    .unwrap();
    fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{SWING}")).unwrap();
    refuses_in(&folder, "forward", "trial.toml", 1, &["model.toml:8:8", "mass"]);
}

#[test]
fn text_that_is_not_toml_is_refused_where_it_stands() {
    refuses("toml", "forward", "[forward\nend = 1", 1, &["trial.toml:2:", "TOML"]);
}

#[test]
fn a_wrong_number_of_joints_is_refused_with_the_right_one() {
    let swing = SWING.replace("[0, 1]", "[0, 1, 2]");
    refuses(
        "joints",
        "forward",
        &swing,
        1,
        &["`initial.q` must have 2 values, one for each of joint1, joint2, found 3", "trial.toml:2:17", "^"],
    );
    let swing = SWING.replace("[0, 1]", "{ joint7 = 1 }");
    refuses("joint", "forward", &swing, 1, &["`joint7`", "joint1, joint2"]);
    let lift = LIFT.replace("from = [0, 0]", "from = [0]");
    refuses("from", "inverse", &lift, 1, &["`trajectory.from` must have 2 values", "trial.toml:3:8"]);
}

#[test]
fn values_that_are_not_angles_are_refused() {
    for (value, word) in [
        ("nan", "not a finite number"),
        ("'60 grad'", "unit"),
        ("'x'", "not a number with a unit"),
        ("true", "an angle"),
    ] {
        refuses("values", "forward", &SWING.replace("[0, 1]", &format!("[0, {value}]")), 1, &["`initial.q[1]`", word]);
    }
}

#[test]
fn an_unknown_joint_is_reported_with_the_one_that_was_meant() {
    let words = ["unknown joint `jiont2`", "did you mean `joint2`?", "trial.toml:2:"];
    refuses("misspelt-joint", "forward", &SWING.replace("[0, 1]", "{ jiont2 = 1 }"), 1, &words);
    let several = SWING.replace("[0, 1]", "{ jiont2 = 1, joint1 = '10 dg' }");
    let folder = scratch("faults-misspelt-joints");
    let output = fail(&folder, &["forward", &scenario(&folder, "two_link.toml", &several)], 1);
    assert!(
        output.contains("unknown joint `jiont2`") && output.contains("the unit `dg`"),
        "every one of them: {output}"
    );
    let one = "torque = { law = 'p', joints = ['joint1'], target = { joint2 = 1 }, kp = 1 }\n";
    let words = ["`forward.torque.target` has nothing to do with the joint `joint2`"];
    refuses("foreign", "forward", &format!("{SWING}{one}"), 1, &words);
    let law = "torque = { law = 'p', joints = ['joint9'], target = [0], kp = 1 }\n";
    refuses(
        "driven",
        "forward",
        &format!("{SWING}{law}"),
        1,
        &["unknown joint `joint9`", "The joints are: joint1, joint2"],
    );
}

#[test]
fn an_unknown_key_is_reported_with_the_one_that_was_meant() {
    refuses(
        "key",
        "forward",
        &SWING.replace("step", "stepp"),
        1,
        &["unknown key `forward.stepp`", "did you mean `step`?"],
    );
    let lift = LIFT.replace("duration = 1.0", "duration = 1.0\nspeed = [1, 1]");
    refuses("kind", "inverse", &lift, 1, &["unknown key `trajectory.speed`", "A cycloid has:"]);
}

#[test]
fn an_unknown_integrator_is_refused() {
    let swing = |settings: &str| format!("{SWING}integrator = {{ {settings} }}\n");
    refuses(
        "integrator",
        "forward",
        &swing("method = 'Ode54'"),
        1,
        &["`forward.integrator.method` cannot be `Ode54`", "Ode45", "Radau5"],
    );
    refuses("step", "forward", &swing("method = 'Ode4'"), 1, &["`forward.integrator.step` is missing"]);
    let long = "method = 'Ode4', step = 1.1";
    refuses("long", "forward", &swing(long), 1, &["is 1.1 s, and the whole run takes 1.0 s", "trial.toml:6:40"]);
    refuses("tolerance", "forward", &swing("rtol = 0.0"), 1, &["`forward.integrator.rtol` is 0.0", "`rtol = 1e-6`"]);
    refuses("roundoff", "forward", &swing("rtol = 1e-18"), 1, &["between 2.2e-14", "1e-18"]);
}

#[test]
fn an_unknown_number_of_an_integrator_is_answered_with_the_numbers_of_redysim() {
    for setting in ["7", "{ method = 7 }"] {
        let folder = scratch("faults-number");
        let path = scenario(&folder, "two_link.toml", &format!("{SWING}integrator = {setting}\n"));
        let output = fail(&folder, &["forward", &path], 1);
        assert!(output.contains("cannot be `7`") && !output.contains("did you mean"), "{output}");
        assert!(output.contains("; or 0 (Ode45), 1 (Ode15s), 2 (Ode5)\n"), "{output}");
    }
    refuses("near", "forward", &format!("{SWING}integrator = 'Ode54'\n"), 1, &["did you mean", "Euler (SemiImplicit"]);
}

#[test]
fn decimal_commas_are_refused_with_the_number_that_is_meant() {
    let swing = |from: &str, to: &str| SWING.replace(from, to);
    let end = swing("end = 1.0", "end = 1,5");
    refuses("comma", "forward", &end, 1, &["`1,5` has a decimal comma", "with a point: 1.5"]);
    let q = swing("[0, 1]", "[0,5, 1,25]");
    refuses("commas", "forward", &q, 1, &["must have 2 values", "with a point: [0.5, 1.25]"]);
    let angle = swing("[0, 1]", "[0, '1,5 deg']");
    refuses("comma-angle", "forward", &angle, 1, &["`initial.q[1]` is \"1,5 deg\"", "with a point: \"1.5 deg\""]);
    let text = swing("end = 1.0", "end = '1,5'");
    refuses("comma-text", "forward", &text, 1, &["`forward.end` is \"1,5\"", "with a point: 1.5"]);
}

#[test]
fn an_unknown_law_is_refused_and_so_is_one_without_its_trajectory() {
    let swing = |law: &str| format!("{SWING}torque = {{ {law} }}\n");
    refuses("law", "forward", &swing("law = 'PID'"), 1, &["cannot be `PID`", "did you mean `pid`?"]);
    refuses("gain", "forward", &swing("law = 'p', target = [0, 0]"), 1, &["`forward.torque.kp` is missing"]);
    let law = "law = 'tracking-pd', kp = 1, kd = 1";
    let words = ["follows a trajectory, but the scenario does not define one", "add a table `[trajectory]`"];
    refuses("untracked", "forward", &swing(law), 1, &words);
}

#[test]
fn a_name_that_leads_to_another_folder_is_refused() {
    for name in ["../elsewhere", "", "/tmp", "..", "a/b"] {
        refuses(
            "name",
            "forward",
            &format!("name = '{name}'\n{SWING}"),
            1,
            &["cannot be the name of a folder", "trial.toml:2:8"],
        );
    }
}

#[test]
fn a_run_without_length_is_refused() {
    refuses(
        "end",
        "forward",
        &SWING.replace("end = 1.0", "end = 0.0"),
        1,
        &["must end after its start", "trial.toml:4:7"],
    );
    refuses("short", "forward", &SWING.replace("end = 1.0", "end = 0.01"), 1, &["the first instant is the only one"]);
    refuses("many", "forward", &SWING.replace("end = 1.0", "end = 1e9"), 1, &["rows", "give a larger `step`"]);
    refuses("neither", "inverse", SWING, 1, &["does not state at which instants"]);
    refuses("nor", "forward", LIFT, 1, &["does not state which motion"]);
}

/// A table whose text has a fault.
fn refuses_table(name: &str, text: &str, words: &[&str]) {
    let folder = scratch(&format!("faults-table-{name}"));
    fs::write(folder.join("forces.csv"), text).unwrap();
    let rest = format!("{SWING}torque = {{ law = 'csv', file = 'forces.csv' }}\n");
    refuses_in(&folder, "forward", &scenario(&folder, "two_link.toml", &rest), 1, words);
}

#[test]
fn a_table_with_a_fault_is_refused_with_its_line() {
    const HEADER: &str = "t [s],tau joint1 [N m],tau joint2 [N m]\n";
    let with = |rows: &str| format!("{HEADER}{rows}");
    refuses_table("gap", &with("0,0,0\n1,,0\n"), &["forces.csv:3: `tau joint1 [N m]` must be a number, found nothing"]);
    refuses_table(
        "nan",
        &with("0,0,0\n1,0,NaN\n"),
        &["forces.csv:3: `tau joint2 [N m]` must be a finite number, found NaN"],
    );
    refuses_table("word", &with("0,0,x\n1,0,0\n"), &["forces.csv:2: `tau joint2 [N m]` must be a number, found `x`"]);
    refuses_table(
        "order",
        &with("0,0,0\n0.7,0,0\n0.5,0,0\n"),
        &["forces.csv:4: time runs backwards: t = 0.5 s comes after 0.7 s"],
    );
    refuses_table("short-row", &with("0,0,0\n1,0\n"), &["forces.csv:3", "2 values", "names 3"]);
    refuses_table("ends", &with("0,0,0\n0.5,0,0\n"), &["from 0.0 s to 0.5 s", "the run from 0.0 s to 1.0 s"]);
    refuses_table("one-row", &with("0,0,0\n"), &["1 row"]);
    refuses_table("empty", "", &["forces.csv:1", "`t [s]`"]);
    refuses_table("no-time", "tau joint1 [N m]\n0\n1\n", &["forces.csv:1", "the first column must be the time"]);
    refuses_table("column", "t [s],tau joint1 [N m]\n0,0\n1,0\n", &["the column `tau joint2 [N m]` is missing"]);
    refuses_table(
        "unit",
        "t [s],tau joint1 [N],tau joint2 [N m]\n0,0,0\n1,0,0\n",
        &["unit that is not understood", "`tau joint1 [N m]`"],
    );
    refuses_table("twice", "t [s],tau joint1 [N m],tau joint2 [N m],tau joint1 [N m]\n0,0,0,0\n1,0,0,0\n", &["twice"]);
    refuses_table("comma", &with("0,0,0\n\"0,5\",0,0\n"), &["forces.csv:3", "`0,5`", "with a point: 0.5"]);
    refuses_table("commas", &with("0,0,0,0,0,0\n1,0,0\n"), &["forces.csv:2", "with a point: 0.0,0.0,0.0"]);
    refuses_table("symbol", "t [s],q joint1 [rad]\n0,0\n1,0\n", &["no forces"]);
}

#[test]
fn a_missing_table_is_reported_at_the_key_that_names_it() {
    let rest = format!("{SWING}torque = {{ law = 'csv', file = 'nowhere.csv' }}\n");
    let words = ["cannot read", "nowhere.csv", "trial.toml:6:", "folder of the scenario"];
    refuses("no-table", "forward", &rest, 1, &words);
}

#[test]
fn every_fault_is_reported_at_once_and_none_that_follows_from_another() {
    let rest = "nonsense = 1\n[trajectory]\nkind = 'csv'\nfile = 'motion.csv'\n\
                [forward]\nend = 1.0\nstepp = 0.1\ntorque = { law = 'csv', file = 'forces.csv' }\n";
    let words = ["`nonsense`", "motion.csv", "`step`?", "forces.csv", "trial.toml:5:", "trial.toml:9:"];
    let folder = scratch("faults-all");
    let output = fail(&folder, &["forward", &scenario(&folder, "two_link.toml", rest)], 1);
    assert!(words.iter().all(|word| output.contains(word)), "{output}");
    let law = "torque = { law = 'tracking-pd', kp = 1, kd = 1 }\n";
    let misspelt = format!("[trajectory]\nfrom = [0, 0]\nto = [1, 1]\nduratoin = 1.0\n{SWING}{law}");
    let folder = scratch("faults-misspelt");
    let output = fail(&folder, &["forward", &scenario(&folder, "two_link.toml", &misspelt)], 1);
    assert!(output.contains("`duration`?") && !output.contains("does not define one"), "{output}");
}

/// What a run would write may be what the other run reads.
#[test]
fn inverse_dynamics_asks_nothing_of_the_forward_run() {
    let folder = scratch("faults-other-run");
    let rest = format!("{LIFT}[forward]\nend = 1.0\nstep = 0.1\ntorque = {{ law = 'csv', file = 'run/tor.csv' }}\n");
    let path = scenario(&folder, "two_link.toml", &rest);
    refuses_in(&folder, "forward", &path, 1, &["run/tor.csv"]);
    succeed(&folder, &["inverse", &path, "-o", "run"]);
    succeed(&folder, &["forward", &path, "-o", "again"]);
}

/// Another unit in its place would turn 90 degrees into 90 rad.
#[test]
fn degrees_under_another_name_are_called_by_theirs() {
    let folder = scratch("faults-degrees");
    let rest = "trajectory = { kind = 'csv', file = 'motion.csv' }\n[inverse]\nend = 1.0\nstep = 0.1\n";
    let path = scenario(&folder, "two_link.toml", rest);
    for (unit, called) in [("°", "deg"), ("Degrees", "deg"), ("radian", "rad")] {
        let table = format!("t [s],q joint1 [{unit}],q joint2 [rad]\n0,0,0\n1,90,0\n");
        fs::write(folder.join("motion.csv"), table).unwrap();
        let words = ["a unit that is not understood", &format!("call it `q joint1 [{called}]`")];
        refuses_in(&folder, "inverse", &path, 1, &words);
    }
}

#[test]
fn a_table_of_velocities_without_accelerations_is_refused() {
    let folder = scratch("faults-velocities");
    fs::write(
        folder.join("motion.csv"),
        "t [s],q joint1 [rad],q joint2 [rad],v joint1 [rad/s],v joint2 [rad/s]\n0,0,0,0,0\n1,0,0,0,0\n",
    )
    .unwrap();
    let rest = "[trajectory]\nkind = 'csv'\nfile = 'motion.csv'\n[inverse]\nend = 1.0\nstep = 0.1\n";
    refuses_in(
        &folder,
        "inverse",
        &scenario(&folder, "two_link.toml", rest),
        1,
        &["velocities, but no column `a <joint>"],
    );
}

#[test]
fn points_out_of_order_are_refused() {
    let rest = "[trajectory]\nkind = 'cubic'\ntimes = [0, 2, 1]\npoints = [[0, 0], [1, 1], [0, 0]]\n[inverse]\nend = 1.0\nstep = 0.1\n";
    refuses("order", "inverse", rest, 1, &["must follow each other in time", "trial.toml:4:9"]);
    refuses("count", "inverse", &rest.replace("[0, 2, 1]", "[0, 1]"), 1, &["3 points came with 2 times"]);
}

#[test]
fn a_tree_that_is_only_half_prescribed_is_refused() {
    let lift = LIFT.replace("from = [0, 0]\nto = [1, 1]", "joints = ['joint2']\nfrom = [0]\nto = [1]");
    refuses("half", "inverse", &lift, 1, &["does not prescribe the joint `joint1`", "trial.toml:"]);
}

#[test]
fn loops_that_cannot_close_are_reported_by_name() {
    let folder = scratch("faults-loops");
    let open = "initial = { q = [0, 0.9844, 4.3144], assemble = false }\n[forward]\nend = 1.0\nstep = 0.1\n";
    refuses_in(&folder, "forward", &scenario(&folder, "fourbar.toml", open), 1, &["open", "crank-coupler"]);
    let held = open.replace("assemble = false", "held = ['crank', 'rocker', 'coupler']");
    refuses_in(&folder, "forward", &scenario(&folder, "fourbar.toml", &held), 1, &["the start", "crank-coupler"]);
}

#[test]
fn a_trajectory_of_loops_that_begins_or_goes_out_of_reach_is_reported_with_its_joint() {
    let folder = scratch("faults-reach");
    let beyond = "initial = { q = [0, 0.9844, 4.3144] }\n[trajectory]\njoints = ['rocker']\nfrom = [FROM]\nto = [2.9]\n\
                  duration = 1.0\n[inverse]\nend = 1.0\nstep = 0.01\n";
    let begins = beyond.replace("FROM", "2.8");
    let words =
        ["cannot be closed at the start", "where the trajectory places `rocker`", "stay open by 0.", "`initial.q`"];
    refuses_in(&folder, "inverse", &scenario(&folder, "fourbar.toml", &begins), 1, &words);
    let path = scenario(&folder, "fourbar.toml", &beyond.replace("FROM", "0.9844"));
    let output = fail(&folder, &["inverse", &path, "-o", "run"], 3);
    let words = ["cannot be closed at t = 0.4", "places `rocker`", "within reach of the links", "instants, until 0."];
    assert!(words.iter().all(|word| output.contains(word)), "{output}");
}

#[test]
fn a_gain_in_quotes_is_refused_with_all_that_may_stand_there() {
    let quoted = format!("{SWING}torque = {{ law = 'pd', target = [0, 0], kp = '100', kd = 1 }}\n");
    let words = ["must be a number, an array with one for each joint, or a table", "found the string \"100\""];
    refuses("quoted-gain", "forward", &quoted, 1, &words);
}

#[test]
fn a_law_that_drives_no_joint_is_refused() {
    let none = format!("{SWING}torque = {{ law = 'pd', joints = [], target = [], kp = 1, kd = 1 }}\n");
    let words = ["`forward.torque.joints` names no joint", "name at least one, or leave the key out", "trial.toml:6:"];
    refuses("no-joint", "forward", &none, 1, &words);
}

/// An unbounded force ends the motion; what was computed before is kept, and the reason is reported.
#[test]
fn a_motion_that_cannot_go_on_is_kept_as_far_as_it_went() {
    let folder = scratch("faults-singular");
    // Springs that push: the coordinates grow like exp(10⁴ t).
    let rest = format!(
        "{SWING}torque = {{ law = 'p', target = [0, 0], kp = -1e6 }}\nintegrator = {{ method = 'Ode4', step = 0.1 }}\n"
    );
    let output = fail(
        &folder,
        &["forward", &scenario(&folder, "two_link.toml", &rest.replace("end = 1.0", "end = 100.0")), "-o", "run"],
        3,
    );
    assert!(output.contains("infinite or not a number") && output.contains("is kept"), "{output}");
    let run = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    assert!(run.contains("ended = \"failed\""), "{run}");
    assert!(run.contains("reason = \"component ") && run.contains("\nsteps = "), "{run}");
    assert!(!run.contains("rejected"), "an integration that fails does not report it: {run}");
    assert!(!fs::read_to_string(folder.join("run/statevar.csv")).unwrap().contains("NaN"));
}

/// ReDySim's gains for its gripper are stiff.
#[test]
fn a_stiff_motion_asks_for_another_integrator() {
    let folder = scratch("faults-stiff");
    let text = fs::read_to_string(crate::common::root().join("scenarios/gripper_tracking.toml")).unwrap();
    let models = crate::common::root().join("models").display().to_string();
    fs::write(folder.join("trial.toml"), text.replace("../models", &models).replace("Ode15s", "Ode45")).unwrap();
    refuses_in(&folder, "forward", "trial.toml", 3, &["stiff at t = ", "method = \"Ode15s\""]);
}

/// The rocker is driven on where the four-bar cannot follow: beyond the first of two instants.
#[test]
fn forces_are_kept_from_the_first_instant_on() {
    let folder = scratch("faults-one-row");
    let rest = "initial = { q = [0, 0.9844, 4.3144] }\n[inverse]\nend = 2.0\nstep = 1.0\n\
                [trajectory]\nkind = 'constant-speed'\njoints = ['rocker']\nfrom = [0.9844]\nspeed = [4]\n";
    let output = fail(&folder, &["inverse", &scenario(&folder, "fourbar.toml", rest), "-o", "run"], 3);
    assert!(output.contains("is kept: 1 instants"), "{output}");
    assert_eq!(crate::common::Table::csv(&folder.join("run/tor.csv")).rows.len(), 1);
}

#[test]
fn a_wrong_command_line_ends_with_exit_code_2() {
    let folder = scratch("faults-command");
    for arguments in [&["forward"][..], &["inverse", "x.toml", "--format", "xml"], &["backward", "x.toml"]] {
        fail(&folder, arguments, 2);
    }
    succeed(&folder, &["forward", "--help"]);
}

#[test]
fn missing_files_are_reported_with_the_folder_and_the_nearest_name() {
    let folder = scratch("faults-nearest");
    fs::copy(crate::common::model("two_link.toml"), folder.join("two_link.toml")).unwrap();
    fs::write(folder.join("trial.toml"), format!("model = 'two_lnk.toml'\n{SWING}")).unwrap();
    let words = ["it does not exist in ", "faults-nearest", "did you mean `two_link.toml`?", "folder of the scenario"];
    refuses_in(&folder, "forward", "trial.toml", 1, &words);
    let words = ["cannot read tril.toml: it does not exist in ", "faults-nearest", "did you mean `trial.toml`?"];
    for command in ["forward", "inverse", "sweep"] {
        refuses_in(&folder, command, "tril.toml", 3, &words);
    }
    fs::write(folder.join("arm.urdf"), "").unwrap();
    refuses_in(&folder, "import", "amr.urdf", 3, &["cannot read amr.urdf", "did you mean `arm.urdf`?"]);
    fs::write(folder.join("motion.csv"), "").unwrap();
    let table =
        "model = 'two_link.toml'\n[trajectory]\nkind = 'csv'\nfile = 'moton.csv'\n[inverse]\nend = 1.0\nstep = 0.1\n";
    fs::write(folder.join("trial.toml"), table).unwrap();
    refuses_in(&folder, "inverse", "trial.toml", 1, &["did you mean `motion.csv`?", "folder of the scenario"]);
}

/// Names of other tools, and keys in another table, are one error that says what to write.
#[test]
fn keys_of_other_tools_lead_to_those_of_a_scenario() {
    for (name, rest, words) in [
        ("dt", SWING.replace("step", "dt"), ["unknown key `forward.dt`", "did you mean `step`?"]),
        ("T", SWING.replace("end", "T"), ["unknown key `forward.T`", "did you mean `end`?"]),
        (
            "solver",
            format!("{SWING}solver = 'Ode45'\n"),
            ["unknown key `forward.solver`", "did you mean `integrator`?"],
        ),
        ("gravity", format!("{SWING}gravity = [0, 0, 0]\n"), ["unknown key `forward.gravity`", "that of the model"]),
        ("law", format!("{SWING}law = 'pd'\n"), ["unknown key `forward.law`", "did you mean `torque`?"]),
        (
            "type",
            format!("{SWING}torque = {{ type = 'pd', kp = 3 }}\n"),
            ["unknown key `forward.torque.type`", "did you mean `law`?"],
        ),
        (
            "kind",
            format!("{SWING}torque = {{ target = [0, 0], kp = 3 }}\n"),
            ["`forward.torque.law` is missing", "p, pd, pid, pd-gravity"],
        ),
    ] {
        refuses(&format!("hints-{name}"), "forward", &rest, 1, &words);
    }
}
