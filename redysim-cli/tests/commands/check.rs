//! `redysim check`, as a person and a program call it.

use std::path::Path;

use crate::common::{call, model, root, scratch, succeed};
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
fn the_summary_lists_springs_between_points() {
    let (report, _) = json(&[&model("test/springs.toml")]);
    let springs = report["summary"]["springs"].as_array().unwrap();
    assert_eq!(springs.len(), 4);
    assert_eq!((&springs[1]["name"], &springs[1]["link_b"]), (&Value::from("strut"), &Value::from("bracket")));
    assert_eq!((&springs[1]["stiffness"], &springs[1]["damping"]), (&Value::from(900.0), &Value::from(30.0)));
    assert_eq!((&springs[2]["name"], &springs[3]["link_a"]), (&Value::Null, &Value::from("base")));
    let run = call(&root(), &["check", &model("test/springs.toml")]);
    let strut = "  spring     strut: upper – bracket, 900 N/m, 30 N s/m, relaxed at 0.35 m\n";
    assert!(run.stdout.contains(strut), "{}", run.stdout);
}

#[test]
fn operation_counts_are_those_of_the_compiled_functions() {
    let (report, _) = json(&[&model("kr5.toml")]);
    let operations = report["summary"]["operations"].as_array().unwrap();
    // README's table, which a test of the facade holds against the macro.
    let flops = |function: &str| operations.iter().find(|each| each["function"] == function).unwrap()["flops"].clone();
    assert_eq!(flops("inverse_dynamics"), 330);
    assert_eq!(flops("forward_dynamics"), 581);
    assert_eq!(flops("mass_matrix"), 156);
    let names: Vec<_> = operations.iter().map(|each| each["function"].as_str().unwrap()).collect();
    // No frames, no loops, and an actuator in every joint.
    let of_an_arm = Function::ALL
        .iter()
        .filter(|function| !function.needs_loops() && !function.needs_frames() && !function.needs_passive_joints());
    assert_eq!(names, of_an_arm.map(|function| function.name()).collect::<Vec<_>>());
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
fn faults_of_a_urdf_are_in_json_with_their_lines() {
    let folder = scratch("check-json-urdf");
    std::fs::write(folder.join("two.urdf"), "<robot name=\"r\">\n<link name=\"a\"/>\n<link/></robot>").unwrap();
    let run = call(&folder, &["check", "--json", "two.urdf"]);
    let report: Value = serde_json::from_str(&run.stdout).expect("an object");
    assert_eq!((run.code, &report["valid"], &report["file"]), (1, &Value::from(false), &Value::from("two.urdf")));
    assert_eq!(report["errors"].as_array().map(Vec::len), Some(1), "{report}");
    let error = &report["errors"][0];
    assert_eq!((&error["title"], &error["line"]), (&Value::from("a <link> has no `name`"), &Value::from(3)));
}

#[test]
fn faults_are_shown_where_they_stand() {
    let run = call(&root(), &["check", &model("fail/bad_unit.toml")]);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""));
    assert!(run.stderr.contains("bad_unit.toml:9:25") && run.stderr.contains("^^^^"), "{}", run.stderr);
    assert!(run.stderr.ends_with("bad_unit.toml has 3 errors\n"), "{}", run.stderr);
}

/// Writes a model of `count` sliders, each with the keys `weights`, and a scenario of it.
fn write_many(folder: &Path, count: usize, weights: &str) {
    let link = |index: usize| {
        let parent = if index == 0 { "base".into() } else { format!("link{}", index - 1) };
        format!(
            "[[link]]\nname = 'link{index}'\nparent = '{parent}'\njoint = 'prismatic'\naxis = [0, 0, 1]\n{weights}\n"
        )
    };
    let links: String = (0..count).map(link).collect();
    std::fs::write(folder.join("many.toml"), format!("name = 'many'\ngravity = [0, 0, 0]\n{links}")).unwrap();
    let scenario = "model = 'many.toml'\n[forward]\nend = 1.0\nstep = 1.0\n";
    std::fs::write(folder.join("scenario.toml"), scenario).unwrap();
}

/// Each of 3,000 links has a fault.
#[test]
fn of_very_many_errors_the_first_20_are_shown() {
    let folder = scratch("check-many");
    write_many(&folder, 3000, "mass = -1");
    for arguments in [["check", "many.toml"], ["forward", "scenario.toml"]] {
        let output = crate::common::fail(&folder, &arguments, 1);
        assert_eq!(output.matches("= help: ").count(), 20, "{output}");
        assert!(output.contains("\n\nand 2980 more errors\n"), "{output}");
    }
    let output = crate::common::fail(&folder, &["check", "many.toml"], 1);
    assert!(output.ends_with("many.toml has 3000 errors\n"), "{output}");
}

/// Each of 30 links has an inertia that no body has.
#[test]
fn of_very_many_warnings_the_first_20_are_shown() {
    let folder = scratch("check-warnings");
    write_many(&folder, 30, "mass = 1\ninertia = { xx = 0.1, yy = 0.1, zz = 0.3 }");
    for arguments in [["check", "many.toml"], ["forward", "scenario.toml"]] {
        let shown = crate::common::call(&folder, &arguments).stderr;
        assert_eq!(shown.matches("warning[inertia-triangle]").count(), 20, "{shown}");
        assert!(shown.contains("\n\nand 10 more warnings\n"), "{shown}");
    }
}

#[test]
fn a_minus_stands_for_a_model_on_the_standard_input() {
    let folder = scratch("check-input");
    let from_input = |options: &str, input: &str| {
        let run = crate::common::bash(&folder, &format!("printf '%s' \"$1\" | \"$0\" check - {options}"), &[input]);
        (run.code, run.stdout, run.stderr)
    };
    let text = std::fs::read_to_string(model("fourbar.toml")).unwrap();
    assert_eq!(from_input("", &text).1, succeed(&folder, &["check", &model("fourbar.toml")]));
    let (code, _, shown) = from_input("", &text.replace("mass", "mas"));
    assert!(code == 1 && shown.contains("--> <stdin>:") && shown.contains("did you mean `mass`?"), "{shown}");
    let (code, shown, _) = from_input("--json", "name = 1");
    assert!(code == 1 && shown.contains("\"file\": \"<stdin>\""), "{shown}");
    let run = crate::common::bash(&folder, "printf '\\377' | \"$0\" check -", &[]);
    assert!(run.code == 1 && run.stderr.contains("UTF-8"), "{}", run.stderr);
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

/// What `check --json` reports of a model, under a key of the report.
fn reported(report: &Value, key: &str) -> Vec<String> {
    report[key].as_array().unwrap().iter().map(|found| found["lint"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn lints_are_reported_with_their_names_where_they_stand_and_end_with_allow() {
    let path = scratch("check-units").join("slips.toml");
    std::fs::write(&path, SLIPS).unwrap();
    let (report, code) = json(&[path.to_str().unwrap()]);
    assert_eq!((code, &report["valid"]), (0, &Value::Bool(true)));
    let warnings = ["gravity-units", "mass-units", "length-units", "radius-of-gyration"];
    assert_eq!(reported(&report, "warnings"), warnings);
    assert_eq!(reported(&report, "notes"), ["under-actuated"]);
    assert_eq!((&report["warnings"][2]["line"], &report["warnings"][2]["column"]), (&Value::from(12), &Value::from(7)));
    let titles: Vec<_> = ["warnings", "notes"].iter().flat_map(|key| report[*key].as_array().unwrap()).collect();
    let titles: Vec<_> = titles.into_iter().map(|found| found["title"].clone()).collect();
    assert_eq!(report["summary"]["lints"], Value::Array(titles));

    let run = call(&root(), &["check", path.to_str().unwrap()]);
    assert!(
        run.stderr.contains("warning[gravity-units]: ") && run.stderr.contains("note[under-actuated]: "),
        "{}",
        run.stderr
    );
    assert_eq!(call(&root(), &["check", "--quiet", path.to_str().unwrap()]).stderr, "");

    std::fs::write(&path, format!("allow = ['{}', 'under-actuated']{SLIPS}", warnings.join("', '"))).unwrap();
    let (report, _) = json(&[path.to_str().unwrap()]);
    assert_eq!(report["summary"]["lints"], Value::Array(vec![]));
}

#[test]
fn a_warning_before_the_first_error_is_called_a_warning() {
    let folder = scratch("check-severity");
    let link = "[[link]]\nname = 'arm'\nparent = 'base'\njoint = 'revolute'\ndh = { alpha = 90 }\nmas = 1.0\n";
    std::fs::write(folder.join("slips.toml"), format!("name = 'arm'\ngravity = [0, 0, -9.81]\n{link}")).unwrap();
    std::fs::write(folder.join("swing.toml"), "name = 'swing'\nmodel = 'slips.toml'\n[forward]\nend = 1\nstep = 1\n")
        .unwrap();
    for command in [&["generate", "slips.toml"], &["forward", "swing.toml"], &["check", "slips.toml"]] {
        let run = call(&folder, command);
        assert_eq!(run.code, 1, "{command:?}: {}", run.stderr);
        let first = run.stderr.lines().find(|line| line.contains("angle-units"));
        assert!(first.is_some_and(|line| line.starts_with("warning[")), "{command:?}: {}", run.stderr);
    }
}

/// A run computes what the model says, so its warnings are shown there as well; notes are not.
#[test]
fn runs_show_the_lints_of_their_model() {
    let folder = scratch("check-runs");
    let scenario = "name = 'swing'\nmodel = 'slips.toml'\n[trajectory]\nkind = 'cycloid'\nfrom = [0, 0]\nto = [1e-3, 0]\n\
        duration = 1.0\n[inverse]\nend = 0.1\nstep = 0.05\n[forward]\nend = 1e-5\nstep = 1e-5\nintegrator = { method = 'Ode5', step = 1e-5 }\n\
        torque = { law = 'free' }\n";
    std::fs::write(folder.join("swing.toml"), scenario).unwrap();
    // Gravity of the Moon is a note.
    let model = SLIPS.replace("actuated = false\n", "").replace("[0.0, 0.0, -9810.0]", "[0.0, 0.0, -1.62]");
    std::fs::write(folder.join("slips.toml"), model).unwrap();
    for command in ["forward", "inverse"] {
        let run = call(&folder, &[command, "swing.toml", "-o", command]);
        assert_eq!(run.code, 0, "{command}: {}", run.stderr);
        assert!(run.stderr.contains("warning[mass-units]: "), "{command}: {}", run.stderr);
        assert!(!run.stderr.contains("note["), "{command}: {}", run.stderr);
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

/// One error names the folder that was searched and a file of similar name.
#[test]
fn a_missing_model_is_one_error() {
    let folder = scratch("check-missing");
    std::fs::copy(root().join("models/two_link.toml"), folder.join("two_link.toml")).unwrap();
    let output = crate::common::fail(&folder, &["check", "two_lnk.toml"], 3);
    assert!(output.contains("it does not exist in ") && output.contains("check-missing"), "{output}");
    assert!(output.contains("did you mean `two_link.toml`?") && !output.contains("os error"), "{output}");
    assert_eq!(output.matches("error").count(), 1, "{output}");
    let output = crate::common::fail(&folder, &["check", "nowhere/two_link.toml"], 3);
    assert!(output.contains("the folder nowhere does not exist"), "{output}");
}

/// Of the keys of another file none is a model's.
#[test]
fn another_toml_file_is_one_error() {
    let output = crate::common::fail(&root(), &["check", "Cargo.toml"], 1);
    assert!(output.contains("Cargo.toml is not a model: ") && output.contains("workspace"), "{output}");
    assert_eq!(output.matches("error").count(), 1, "{output}");
}

#[test]
fn a_urdf_is_checked_and_generated_as_the_model_file_that_it_becomes() {
    let folder = scratch("check-urdf");
    let arm = |ixx: &str| {
        format!(
            "<robot name='arm'><link name='foot'/><link name='arm'><inertial><origin xyz='0 0 0.3'/><mass value='2'/>\
             <inertia ixx='{ixx}' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>\
             <joint name='shoulder' type='revolute'><parent link='foot'/><child link='arm'/><axis xyz='0 1 0'/>\
             <origin xyz='0 0 0.5'/><limit lower='-1' upper='1' effort='9' velocity='2'/></joint></robot>"
        )
    };
    std::fs::write(folder.join("arm.urdf"), arm("0.1")).unwrap();
    succeed(&folder, &["import", "arm.urdf", "--output", "arm.toml", "--quiet"]);
    let [urdf, model] = ["arm.urdf", "arm.toml"].map(|file| succeed(&folder, &["check", file]));
    assert_eq!(urdf, model);
    let [urdf, model] = ["arm.urdf", "arm.toml"].map(|file| succeed(&folder, &["generate", file]));
    assert_eq!(urdf, model);
    // Findings stand in what `redysim import` prints, at its lines.
    std::fs::write(folder.join("flat.urdf"), arm("0.5")).unwrap();
    succeed(&folder, &["import", "flat.urdf", "--output", "flat.toml", "--quiet"]);
    let [urdf, model] = ["flat.urdf", "flat.toml"].map(|file| call(&folder, &["check", file]).stderr);
    assert!(model.contains("warning[inertia-triangle]: link `arm`"), "{model}");
    assert_eq!(urdf.replace("redysim import flat.urdf", "flat.toml"), model);
    // A fault of the URDF is one error.
    std::fs::write(folder.join("flat.urdf"), arm("much")).unwrap();
    let run = call(&folder, &["check", "flat.urdf"]);
    assert_eq!((run.code, run.stderr.matches("error: ").count()), (1, 1), "{}", run.stderr);
}

#[test]
fn names_may_be_longer_than_any_line() {
    let folder = scratch("check-long-name");
    let name = "x".repeat(70_000);
    let link = format!(
        "name = '{name}'\nparent = 'base'\njoint = 'revolute'\norigin = {{}}\naxis = [0, 0, 1]\nmass = 1.0\ncom = [1, 0, 0]\n"
    );
    std::fs::write(folder.join("long.toml"), format!("name = 'arm'\ngravity = [0, 0, -9.81]\n[[link]]\n{link}"))
        .unwrap();
    let run = call(&folder, &["check", "long.toml"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout.contains(&format!("\n  {name}  base")), "{}", run.stdout);
}
