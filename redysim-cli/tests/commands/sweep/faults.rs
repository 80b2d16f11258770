//! Faults of a study, of what it varies and of the command line: each is one error where it stands.

use std::fs;

use super::{FALL, GRID, cells, study, sweep, text};
use crate::common::{call, fail, model, names, scenario, scratch, succeed};

#[test]
fn a_fault_of_a_study_is_one_error_before_anything_is_computed() {
    let folder = scratch("sweep-faults");
    for (rest, parts) in [
        ("[over]\n\"forward.torque.kp\" = [1.0, nan]", ["study.toml:3:29", "`over.forward.torque.kp[1]`", "nan"]),
        ("[over]\ninitial.q = [[0, 1], [0, 1, 2]]", ["`over.initial.q[1]` is an array of 3", "array of 2", "one form"]),
        ("[over]\ninitial.q = [[0, 1, 2]]", ["`initial.q`", "2 values", "joint1, joint2"]),
        (
            "[over]\nforward.torqe.kp = [1]",
            ["unknown key `forward.torqe`", "sample 0, scenario", "integrator, prescribed, torque"],
        ),
        (
            "[over]\nmodel.link.lnik2.mass = [1]",
            ["`model.link` has nothing of the name `lnik2`", "did you mean", "link2"],
        ),
        ("[over]\nmodel.link.link2.mas = [1]", ["link `link2`: unknown key `mas`", "sample 0, ", "mass"]),
        ("[over]\ninverse.end = [1]", ["`inverse.end` has no effect", "forward", "`run`"]),
        (
            "[over]\ninitial.q = [[0, 1]]\n\"initial.q.1\" = [1]",
            ["`initial.q.1` is a part of `initial.q`", "twice", "once"],
        ),
        ("[over]\ninitial.q = []", ["`over.initial.q` is empty", "at least one", "study.toml:3"]),
        (
            "[over]\ninitial.q.0 = { from = 0, to = 1, count = 3, step = 1 }",
            ["unknown key `over.initial.q.0.step`", "from, to, count", "study.toml:3"],
        ),
        ("[over]\ninitial.q.0 = { from = 0, to = 1, count = 1.5 }", ["count` is 1.5", "whole number", "study.toml:3"]),
        ("", ["`over` or `samples`", "not both", "write for example"]),
        ("[samples]\ninitial.q.0 = { normal = [0, 1] }", ["how many samples", "count = 1000", "[samples]"]),
        ("[samples]\ncount = 3\ninitial.q.0 = [1, 2]", ["`initial.q.0` has 2", "`samples.count` has 3", "as many"]),
        (
            "[samples]\ncount = 3\ninitial.q.0 = { normal = [0, -1] }",
            ["standard deviation", "not negative", "normal` is [0.0, -1.0]"],
        ),
        (
            "[samples]\ncount = 3\ninitial.q.0 = { gauss = [0, 1] }",
            ["unknown key `samples.initial.q.0.gauss`", "normal, uniform", "study.toml:4"],
        ),
        (
            "[samples]\ncount = 3\ninitial.q.0 = { unifrom = [0, 1] }",
            ["unknown key `samples.initial.q.0.unifrom`", "did you mean `uniform`", "study.toml:4"],
        ),
        (
            "[samples]\ncount = 3\ninitial.q.0 = { normal = [0, 1], uniform = [0, 1] }",
            ["`normal` or `uniform`, not both", "two distributions", "study.toml:4"],
        ),
        (
            "outcomes.peak = ['tua']\n[over]\ninitial.q.0 = [1]",
            ["no column `tua`", "did you mean `tau`", "it has q, v"],
        ),
        ("run = 'backward'\n[over]\ninitial.q.0 = [1]", ["`run`", "backward", "forward"]),
    ] {
        let error = fail(&folder, &["sweep", &study(&folder, rest), "--output", "rows"], 1);
        assert!(parts.iter().all(|part| error.contains(part)), "{rest}: {error}");
        assert_eq!(error.matches("error: ").count(), 1, "{rest}: {error}");
        assert!(error.contains("study.toml") || error.contains("sample 0, "), "which file is it? {error}");
    }
    fs::write(folder.join("samples.csv"), "initial.q.0,initial.q.1\n1,2\n3\n").unwrap();
    let error = fail(&folder, &["sweep", &study(&folder, "samples.file = 'samples.csv'")], 1);
    let begins = |error: &str| error.starts_with("error: ") && error.find("samples.csv:3: ") < error.find(": the row");
    assert!(begins(&error) && !error.contains("study.toml"), "{error}");
    assert!(error.contains("samples.csv:3: the row has 1 value, but the header names 2 columns"), "{error}");
    fs::write(folder.join("samples.csv"), "initial.q.0\n1\nNaN\n").unwrap();
    let error = fail(&folder, &["sweep", &study(&folder, "samples.file = 'samples.csv'")], 1);
    assert!(error.contains("samples.csv:3: `initial.q.0` must be a finite number, found `NaN`"), "{error}");
    let error = fail(&folder, &["sweep", &study(&folder, "samples.file = 'none.csv'")], 3);
    assert!(error.contains("none.csv") && error.contains("from the folder of the study"), "{error}");
    assert_eq!(names(&folder), ["samples.csv", "study.toml", "trial.toml"]);
}

/// Tables of arrays are parts of paths, whatever their keys are called.
#[test]
fn keys_of_a_grid_are_paths_where_their_values_are_arrays() {
    let folder = scratch("sweep-paths");
    let motion = "trajectory = { from = [0, 0], to = [1, 1], duration = 1.0 }\n[inverse]\nend = 1.0\nstep = 0.5\n";
    scenario(&folder, "two_link.toml", motion);
    let over = "[over]\ntrajectory.from = [[0, 0], [0.5, 0]]\ntrajectory.to = [[1, 1]]\n";
    fs::write(folder.join("study.toml"), format!("scenario = 'trial.toml'\n{over}")).unwrap();
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet"]);
    assert_eq!(cells(&folder, "trajectory.from.0"), ["0.0", "0.5"]);
}

#[test]
fn a_value_that_does_not_fit_is_reported_with_its_line_of_the_study() {
    let folder = scratch("sweep-value");
    fs::write(folder.join("masses.csv"), "model.link.link1.mas\n1.0\n").unwrap();
    for (rest, parts) in [
        (
            "[over]\nforward.end = [0.1]\nforward.integrator.rtoll = [1e-4]",
            ["unknown key `forward.integrator.rtoll`", "`forward.integrator.rtoll` is given at ", "study.toml:4"],
        ),
        (
            "[over]\nmodel.link.link1.mass = [-1.0]",
            ["`mass` is -1", "`model.link.link1.mass` is given at ", "study.toml:3"],
        ),
        (
            "[samples]\nfile = 'masses.csv'\nforward.end = [0.1]",
            ["unknown key `mas`", "`model.link.link1.mas` is given at ", "masses.csv"],
        ),
    ] {
        let error = fail(&folder, &["sweep", &study(&folder, rest), "--output", "rows"], 1);
        assert!(parts.iter().all(|part| error.contains(part)), "{rest}: {error}");
    }
}

#[test]
fn a_fault_of_the_scenario_of_a_study_is_reported_in_its_own_file() {
    let folder = scratch("sweep-scenario-fault");
    study(&folder, "[over]\nforward.end = [0.1, 0.2]");
    let faulty = fs::read_to_string(folder.join("trial.toml")).unwrap().replace("step = ", "stepp = 1\nstep = ");
    fs::write(folder.join("trial.toml"), &faulty).unwrap();
    let line = 1 + faulty.lines().position(|line| line.starts_with("stepp")).unwrap();
    let error = fail(&folder, &["sweep", "study.toml", "--output", "rows"], 1);
    assert!(error.contains(&format!("trial.toml:{line}:1")), "{error}");
    assert!(!error.contains("sample 0") && !error.contains("study.toml"), "{error}");
    // Also where the study mends the first of its faults.
    fs::write(folder.join("trial.toml"), faulty.replace("end = 0.1", "end = -1.0")).unwrap();
    let error = fail(&folder, &["sweep", "study.toml", "--output", "rows"], 1);
    assert!(error.contains("unknown key `forward.stepp`") && !error.contains("is given at"), "{error}");
}

#[test]
fn a_sweep_shows_the_warnings_of_its_model_once() {
    let folder = scratch("sweep-warnings");
    let odd = fs::read_to_string(model("two_link.toml")).unwrap().replacen("com = [", "com = [900.0 , 0, 0] # [", 1);
    fs::write(folder.join("odd.toml"), odd).unwrap();
    fs::write(folder.join("trial.toml"), format!("model = 'odd.toml'\n{FALL}")).unwrap();
    fs::write(folder.join("study.toml"), "scenario = 'trial.toml'\n[over]\nforward.end = [0.1, 0.2]\n").unwrap();
    let run = call(&folder, &["sweep", "study.toml", "--output", "rows"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert_eq!(run.stderr.matches("warning[length-units]: link `link1`").count(), 1, "{}", run.stderr);
    assert!(run.stderr.contains("odd.toml:"), "{}", run.stderr);
    let quiet = call(&folder, &["sweep", "study.toml", "--output", "rows", "--force", "--quiet"]);
    assert_eq!(quiet.stderr, "");
}

#[test]
fn a_file_that_is_something_else_than_a_study_is_recognised_and_the_other_way_round() {
    let folder = scratch("sweep-kinds");
    study(&folder, "[over]\nforward.end = [0.1, 0.2]");
    let error = fail(&folder, &["forward", "study.toml"], 1);
    assert!(error.contains("study.toml is a study, not a scenario") && error.contains("redysim sweep"), "{error}");
    let error = fail(&folder, &["sweep", &model("two_link.toml")], 1);
    assert!(error.contains("two_link.toml is a model, not a study"), "{error}");
    fs::write(folder.join("table.csv"), "t [s],q joint1 [rad]\n0,1\n1,2\n").unwrap();
    for command in ["sweep", "check", "forward"] {
        let error = fail(&folder, &[command, "table.csv"], 1);
        assert!(error.contains("this is a table (CSV), not TOML"), "{error}");
        assert_eq!(error.matches("= help: ").count(), 1, "{error}");
    }
    fs::remove_file(folder.join("trial.toml")).unwrap();
    let error = fail(&folder, &["sweep", "study.toml"], 1);
    assert!(error.contains("cannot read the scenario") && error.contains("study.toml:1:12"), "{error}");
}

#[test]
fn a_sample_that_is_refused_leaves_nothing_behind() {
    let folder = sweep("sweep-sample-refused", "[over]\nforward.end = [0.1, 0.2]");
    let error = fail(&folder, &["sweep", "study.toml", "--sample", "0", "--output", "rows"], 2);
    assert!(error.contains("rows is the folder of the rows of a study") && error.contains("--output"), "{error}");
    fs::create_dir(folder.join("alone")).unwrap();
    fs::write(folder.join("alone/model.toml"), "mine").unwrap();
    let error = fail(&folder, &["sweep", "study.toml", "--sample", "0", "--output", "alone"], 3);
    assert!(error.contains("model.toml is there already"), "{error}");
    assert_eq!(names(&folder.join("alone")), ["model.toml"]);
}

#[test]
fn what_the_command_line_of_a_sweep_has_wrong_is_reported_with_exit_code_2() {
    let folder = scratch("sweep-command-line");
    study(&folder, "[over]\nforward.end = [0.1, 0.2]");
    let error = fail(&folder, &["sweep", "study.toml", "--jobs", "0"], 2);
    assert!(error.contains("'0' for '--jobs <COUNT>': a whole number is needed, 1 or more"), "{error}");
    let error = fail(&folder, &["sweep", "study.toml", "--sample", "2", "--output", "second"], 2);
    assert!(error.contains("no sample 2") && error.contains("0 to 1"), "{error}");
}

#[test]
fn another_study_and_what_is_no_study_are_kept() {
    let folder = sweep("sweep-other", GRID);
    let whole = text(&folder);
    study(&folder, &GRID.replace("20.0", "30.0"));
    let error = fail(&folder, &["sweep", "study.toml", "--output", "rows"], 3);
    assert!(error.contains("rows of another study: the samples differed") && error.contains("--force"), "{error}");
    assert_eq!(text(&folder), whole);
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--force", "--quiet"]);
    assert!(text(&folder).contains("\n5,30.0,2.0,"), "{}", text(&folder));
    let error = fail(&folder, &["sweep", "study.toml", "--output", "."], 3);
    assert!(error.contains("is not the folder of a study"), "{error}");
}

#[test]
fn a_scenario_in_place_of_a_study_is_one_error_that_names_both() {
    let folder = scratch("sweep-scenario");
    scenario(&folder, "two_link.toml", FALL);
    let shown = fail(&folder, &["sweep", "trial.toml"], 1);
    assert!(shown.contains("trial.toml is a scenario, not a study") && shown.contains("[over]"), "{shown}");
    assert_eq!(shown.matches("error: ").count(), 1, "{shown}");
}
