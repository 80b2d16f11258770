//! `redysim generate`: source that compiles, is the macro's, and is never lost.

use crate::common::{call, model, names, root, scratch};
use std::fs;

/// The committed source is included and run against the macro by the facade's test `generated`.
#[test]
fn the_gripper_is_the_source_that_is_compiled_in_the_tests() {
    let run = call(&root(), &["generate", &model("gripper.toml")]);
    let committed = fs::read_to_string(root().join("tests/generated/gripper.rs")).unwrap();
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stdout == committed, "tests/generated/gripper.rs is another source");
}

#[test]
fn name_and_functions_are_those_asked_for() {
    let run = call(&root(), &["generate", &model("kr5.toml"), "--name", "Arm", "--functions", "mass_matrix,energy"]);
    assert!(run.stdout.contains("pub struct Arm;"));
    assert!(run.stdout.contains("pub fn mass_matrix<") && run.stdout.contains("pub fn energy<"));
    assert!(!run.stdout.contains("pub fn inverse_dynamics<"));
    let report = run.stdout.lines().filter(|line| line.contains(" flops, "));
    let listed: Vec<&str> = report.filter_map(|line| line.split_whitespace().nth(1)).collect();
    assert_eq!(
        listed,
        ["mass_matrix", "energy", "coordinate_rates", "integrate", "difference", "dissipated_power", "neutral"]
    );
}

#[test]
fn an_existing_file_stays_unless_forced() {
    let folder = scratch("generate-exists");
    let path = folder.join("kr5.rs");
    fs::write(&path, "mine").unwrap();
    let run = call(&folder, &["generate", &model("kr5.toml"), "-o", "kr5.rs"]);
    assert_eq!((run.code, fs::read_to_string(&path).unwrap().as_str()), (3, "mine"));
    assert!(run.stderr.contains("--force"), "{}", run.stderr);
    let run = call(&folder, &["generate", &model("kr5.toml"), "-o", "kr5.rs", "--force"]);
    assert_eq!(run.code, 0);
    assert!(fs::read_to_string(&path).unwrap().contains("pub struct Kr5;"));
    assert!(run.stderr.contains("inverse_dynamics") && run.stderr.contains("333 flops"), "{}", run.stderr);
    assert_eq!(names(&folder), ["kr5.rs"], "no draft is left");
}

#[test]
fn a_name_that_is_not_one_of_a_type_is_refused() {
    let run = call(&root(), &["generate", &model("kr5.toml"), "--name", "my robot"]);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""));
    assert!(run.stderr.contains("`my robot`") && run.stderr.contains("--name"), "{}", run.stderr);
}

#[test]
fn an_unknown_function_is_refused() {
    let run = call(&root(), &["generate", &model("kr5.toml"), "--functions", "mas_matrix"]);
    assert_eq!(run.code, 2);
    assert!(run.stderr.contains("mass_matrix"), "{}", run.stderr);
    let run = call(&root(), &["generate", &model("kr5.toml"), "--functions", "loop_bias"]);
    assert_eq!(run.code, 1);
    assert!(run.stderr.contains("loop_bias"), "{}", run.stderr);
}
