//! `redysim check`, as a person and a program call it.

mod common;

use common::{call, model, root, scratch};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{Function, MassMatrix};
use serde_json::Value;

fn json(arguments: &[&str]) -> (Value, i32) {
    let run = call(&root(), &[&["check", "--json"], arguments].concat());
    (serde_json::from_str(&run.stdout).unwrap_or_else(|error| panic!("{error}: {}", run.stdout)), run.code)
}

#[test]
fn the_summary_of_the_fourbar_is_that_of_a_fourbar() {
    let (report, code) = json(&[&model("fourbar.toml")]);
    let summary = &report["summary"];
    assert_eq!(code, 0);
    assert_eq!(report["valid"], true);
    // Grübler: three moving links, four revolutes: 3·3 − 2·4 = 1.
    assert_eq!(summary["mobility"], 1);
    assert_eq!(summary["dof"], 3);
    assert_eq!((&summary["loop_rank"], &summary["loop_constraints"]), (&Value::from(2), &Value::from(2)));
    assert_eq!(summary["mass"], 1.5 + 3.0 + 5.0);
    assert_eq!(summary["actuated"], Value::from(vec!["crank"]));
    // In the plane, a revolute cut holds two coordinates of a point.
    assert_eq!(
        (&summary["loops"][0]["kind"], &summary["loops"][0]["constraints"]),
        (&Value::from("revolute"), &Value::from(2))
    );
}

/// A coupler on three parallel cranks: the third holds but its own angle that the others do not hold.
#[test]
fn the_rank_of_each_loop_is_what_it_adds_to_those_before() {
    let (report, _) = json(&[&model("test/three_cranks.toml")]);
    let summary = &report["summary"];
    let ranks: Vec<_> = summary["loops"].as_array().unwrap().iter().map(|each| each["rank"].clone()).collect();
    assert_eq!(ranks, [2, 1]);
    assert_eq!((&summary["loop_rank"], &summary["loop_constraints"]), (&Value::from(3), &Value::from(4)));
}

/// The rank is that of the closed position, however badly a few of the loops alone can be closed.
#[test]
fn a_small_loop_far_away_counts_as_any_other() {
    let (report, _) = json(&[&model("test/two_scales.toml")]);
    let summary = &report["summary"];
    let ranks: Vec<_> = summary["loops"].as_array().unwrap().iter().map(|each| each["rank"].clone()).collect();
    assert_eq!(ranks, [2, 0, 2]);
    assert_eq!((&summary["mobility"], &summary["loop_rank"]), (&Value::from(2), &Value::from(4)));
}

/// Bricard's linkage: six revolutes in space, which Grübler would have rigid, and which moves.
#[test]
fn the_mobility_of_bricards_linkage_is_one() {
    let (report, _) = json(&[&model("test/bricard.toml")]);
    let summary = &report["summary"];
    assert_eq!((&summary["mobility"], &summary["loop_rank"]), (&Value::from(1), &Value::from(4)));
    assert_eq!(report["warnings"][0]["file"], model("test/bricard.toml"));
    assert!(report["warnings"][0]["line"].is_number());
}

#[test]
fn operation_counts_are_those_of_the_compiled_functions() {
    let (report, _) = json(&[&model("kr5.toml")]);
    let operations = report["summary"]["operations"].as_array().unwrap();
    // README's table, which a test of the facade holds against the macro.
    let flops = |function: &str| operations.iter().find(|each| each["function"] == function).unwrap()["flops"].clone();
    assert_eq!(flops("inverse_dynamics"), 333);
    assert_eq!(flops("forward_dynamics"), 591);
    assert_eq!(flops("mass_matrix"), 159);
    let names: Vec<_> = operations.iter().map(|each| each["function"].as_str().unwrap()).collect();
    let of_a_tree = Function::ALL.iter().filter(|function| !function.needs_loops());
    assert_eq!(names, of_a_tree.map(|function| function.name()).collect::<Vec<_>>());
}

#[test]
fn every_faulty_model_has_its_faults_in_json_and_the_exit_code_1() {
    let folder = root().join("models/fail");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let (report, code) = json(&[path.to_str().unwrap()]);
        let faults = Model::load(&path).unwrap_err();
        assert_eq!(code, 1, "{}", path.display());
        assert_eq!((&report["valid"], &report["summary"]), (&Value::Bool(false), &Value::Null));
        let titles: Vec<_> = faults.errors().map(|error| Value::from(error.title())).collect();
        let found: Vec<_> = report["errors"].as_array().unwrap().iter().map(|error| error["title"].clone()).collect();
        assert_eq!(found, titles);
        for (error, found) in faults.errors().zip(report["errors"].as_array().unwrap()) {
            assert_eq!(error.position().map(|(line, _)| line as u64), found["line"].as_u64());
        }
        seen += 1;
    }
    assert!(seen > 20);
}

#[test]
fn faults_are_shown_where_they_stand() {
    let run = call(&root(), &["check", &model("fail/bad_unit.toml")]);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""));
    assert!(run.stderr.contains("bad_unit.toml:9:25") && run.stderr.contains("^^^^"), "{}", run.stderr);
    assert!(run.stderr.ends_with("bad_unit.toml has 3 errors\n"), "{}", run.stderr);
}

#[test]
fn a_missing_file_ends_with_exit_code_3() {
    let run = call(&root(), &["check", "nowhere.toml"]);
    assert_eq!(run.code, 3);
    assert!(run.stderr.contains("nowhere.toml"), "{}", run.stderr);
    let (report, code) = json(&["nowhere.toml"]);
    assert_eq!((code, &report["errors"][0]["line"]), (3, &Value::Null));
}

#[test]
fn quiet_prints_nothing_of_a_good_model() {
    let run = call(&root(), &["check", "--quiet", &model("kr5_table2.toml")]);
    assert_eq!((run.code, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
    let run = call(&root(), &["check", &model("kr5_table2.toml")]);
    assert!(run.stderr.contains("triangle inequality") && run.stdout.contains("39.83 kg"));
}

const SLIPS: &str = r#"
name = "slips"
gravity = [0.0, 0.0, -9810.0]

[[link]]
name = "upper"
parent = "base"
joint = "revolute"
origin = { xyz = [0.0, 0.0, 0.3] }
axis = [0.0, 1.0, 0.0]
mass = 2000.0
com = [150.0, 0.0, 0.0]
inertia = { xx = 0.1, yy = 20.0, zz = 20.0 }

[[link]]
name = "fore"
parent = "upper"
joint = "revolute"
origin = { xyz = [0.4, 0.0, 0.0] }
axis = [0.0, 1.0, 0.0]
actuated = false
mass = 0.01
com = [0.1, 0.0, 0.0]
inertia = { xx = 10.0, yy = 1000.0, zz = 1000.0 }
"#;

/// The exit code, and what is suspicious of a model.
fn lints(name: &str, text: &str) -> (i32, Vec<String>) {
    let path = scratch(&format!("check-{name}")).join("slips.toml");
    std::fs::write(&path, text).unwrap();
    let (report, code) = json(&[path.to_str().unwrap()]);
    let lines = report["summary"]["lints"].as_array().unwrap();
    (code, lines.iter().map(|line| line.as_str().unwrap().to_owned()).collect())
}

#[test]
fn links_of_very_different_lengths_and_points_of_mass_have_lints() {
    let arm = SLIPS.replace("2000.0", "2.0").replace("-9810.0", "-9.81").replace("[150.0, ", "[0.15, ");
    let (_, found) = lints("lengths", &arm.replace("[0.4, ", "[400.0, "));
    let words =
        "link `fore` is placed 400 m from the one that carries it, and the next, `upper`, only 0.3 m: m and mm?";
    assert!(found.contains(&words.to_owned()), "{found:#?}");
    let (_, found) = lints("reach", &arm.replace("[0.4, ", "[400.0, ").replace("0.3]", "300.0]"));
    assert!(found.contains(&"the mechanism reaches 700 m: m and mm?".to_owned()), "{found:#?}");
    let points: String =
        arm.lines().filter(|line| !line.starts_with("inertia")).map(|line| format!("{line}\n")).collect();
    let (_, found) = lints("points", &points);
    assert_eq!(found[0], "no link has an `inertia`: all masses are points", "{found:#?}");
}

#[test]
fn slips_of_units_have_lints() {
    let (code, lints) = lints("units", SLIPS);
    let wanted = [
        "gravity is 9810 m/s²",
        "kg and g?",
        "`upper`: its centre of mass is 150 m",
        "`fore`",
        "an actuator at 1 joint",
    ];
    assert_eq!((code, lints.len()), (0, wanted.len()), "{lints:#?}");
    for (line, wanted) in lints.iter().zip(wanted) {
        assert!(line.contains(wanted), "`{wanted}` in `{line}`");
    }
}

#[test]
fn shipped_models_have_no_lints() {
    for name in ["kr5.toml", "gripper.toml", "fourbar.toml", "three_rrr.toml", "leg.toml", "slider_crank.toml"] {
        let (report, _) = json(&[&model(name)]);
        assert_eq!(report["summary"]["lints"], Value::Array(vec![]), "{name}");
    }
}

#[test]
fn links_are_those_of_the_model() {
    let (report, _) = json(&[&model("test/puma560.toml")]);
    let mechanism = GenericMechanism::new(Model::load(model("test/puma560.toml")).unwrap().model);
    let links = report["summary"]["links"].as_array().unwrap();
    assert_eq!(links.len(), mechanism.model().links.len());
    assert_eq!(mechanism.mass_matrix(&vec![0.0; mechanism.tree().nv()]).len(), report["summary"]["dof"]);
    for (link, found) in mechanism.model().links.iter().zip(links) {
        assert_eq!((found["name"].as_str(), found["mass"].as_f64()), (Some(link.name.as_str()), Some(link.mass)));
    }
}
