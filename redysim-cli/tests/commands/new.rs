//! `redysim new`: crates that build, run and pass their tests, and nothing half-made.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{call, cargo, fail, model, names, root, scratch, succeed};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::InverseDynamics;

const URDF: &str = r#"<robot name="two rods"><link name="ground"/>
  <link name="upper"><inertial><origin xyz="0 0 0.3"/><mass value="2"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="slide"><inertial><mass value="1"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="continuous"><parent link="ground"/><child link="upper"/><axis xyz="0 1 0"/></joint>
  <joint name="rail" type="prismatic"><parent link="upper"/><child link="slide"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="1" effort="10" velocity="1"/></joint></robot>"#;

/// What a new crate prints, after its tests have passed. `name` is that of the crate.
fn tested(folder: &Path, name: &str, robot: &str) -> String {
    succeed(folder, &["new", name, "--robot", robot]);
    let crate_folder = folder.join(name);
    let test = cargo(&crate_folder, "test");
    assert_eq!(test.code, 0, "{robot}: {}", test.output());
    let run = cargo(&crate_folder, "run");
    assert_eq!((run.code, run.stderr.as_str()), (0, ""), "{robot}: {}", run.stdout);
    run.stdout
}

/// The number after `name` in the first line that begins with it.
fn number(printed: &str, name: &str) -> f64 {
    let line = printed.lines().find_map(|line| line.trim_start().strip_prefix(name)).expect(name);
    line.trim().parse().unwrap()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_new_crate_prints_the_forces_of_its_robot_and_passes_its_test() {
    let printed = tested(&scratch("new-kr5"), "new-kr5", "kr5");
    let kr5 = GenericMechanism::new(Model::load(model("kr5.toml")).unwrap().model);
    let forces = kr5.inverse_dynamics(&vec![0.1; 6], &vec![0.2; 6], &vec![1.0; 6]);
    for (joint, force) in ["joint1", "joint2", "joint3", "joint4", "joint5", "joint6"].iter().zip(forces) {
        assert!((number(&printed, joint) - force).abs() < 1e-4, "{joint}: {force} N m, {printed}");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn every_kind_of_robot_has_a_crate_that_passes_its_tests() {
    let folder = scratch("new-kinds");
    fs::write(folder.join("two rods.urdf"), URDF).unwrap();
    // Less than the program needs, and more than it gives.
    let asks = "functions = [\"mass_matrix\"]\nparameters = [\"gravity\"]\n";
    let text = fs::read_to_string(model("fourbar.toml")).unwrap();
    fs::write(folder.join("asks.toml"), format!("{asks}{text}")).unwrap();
    let loops = "forces in the cuts: [";
    for (name, robot, printed) in [
        ("new-gripper", "gripper", "joint4"),
        ("new-fourbar", "fourbar", loops),
        ("new-urdf", "two rods.urdf", "forces for accelerations of 1 rad/s² or m/s², N m or N"),
        ("new-asks", "asks.toml", loops),
        ("new-slider-crank", &model("slider_crank.toml"), loops),
        ("new-three-rrr", &model("three_rrr.toml"), loops),
        ("new-floating", &model("kr5_floating.toml"), "base.wz"),
    ] {
        let found = tested(&folder, name, robot);
        assert!(found.contains(printed), "{robot}: {found}");
    }
    assert!(folder.join("new-urdf/models/two-rods.toml").exists());
    let fourbar = fs::read_to_string(folder.join("new-fourbar/src/main.rs")).unwrap();
    assert!(fourbar.contains("determine all others: `crank`."), "its motor moves it: {fourbar}");
    let original = fs::read(model("slider_crank.toml")).unwrap();
    assert!(fs::read(folder.join("new-slider-crank/models/slider_crank.toml")).unwrap() == original);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_test_of_a_new_crate_fails_if_its_program_is_wrong() {
    let folder = scratch("new-wrong");
    for (robot, right, wrong, name) in [
        ("gripper", "forward_dynamics(&Q, &V, &forces)", "forward_dynamics(&Q, &A, &forces)", "new-wrong-tree"),
        ("fourbar", "motion.v, &forces)", "motion.a, &forces)", "new-wrong-loops"),
    ] {
        succeed(&folder, &["new", name, "--robot", robot]);
        let main = folder.join(name).join("src/main.rs");
        let program = fs::read_to_string(&main).unwrap();
        assert!(program.contains(right), "{program}");
        fs::write(&main, program.replace(right, wrong)).unwrap();
        assert!(cargo(&folder.join(name), "test").output().contains("gives_back"), "{robot}");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_program_of_the_readme_runs_in_a_new_crate_and_without_its_model_has_one_error() {
    let folder = scratch("new-readme");
    succeed(&folder, &["new", "new-readme"]);
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let section = readme.split("\n## In your program\n").nth(1).unwrap();
    let program = section.split("```rust\n").nth(1).unwrap().split("```").next().unwrap();
    let folder = folder.join("new-readme");
    fs::write(folder.join("src/main.rs"), program).unwrap();
    let run = cargo(&folder, "run");
    assert_eq!((run.code, run.stderr.as_str()), (0, ""));
    assert!(run.stdout.contains("q(1 s) = [1.000000, 1.000000, "), "{}", run.stdout);

    fs::rename(folder.join("models"), folder.join("modles")).unwrap();
    let faulty = cargo(&folder, "run").stderr;
    let errors: Vec<&str> = faulty.lines().filter(|line| line.starts_with("error")).collect();
    let searched = folder.canonicalize().unwrap();
    let first = format!(
        "error: cannot read the model file `models/kr5.toml`: the folder {} does not exist",
        searched.join("models").display()
    );
    assert_eq!(errors, [&first, "error: could not compile `new-readme` (bin \"new-readme\") due to 1 previous error"]);
    let base = format!("relative to the folder of the crate's Cargo.toml, {};", searched.display());
    assert!(faulty.contains(&base) && faulty.contains("did you mean \"modles/kr5.toml\"?"), "{faulty}");
}

#[test]
fn the_readme_of_a_new_crate_states_what_to_type_next() {
    let folder = scratch("new-next");
    let run = call(&folder, &["new", "arm"]);
    assert_eq!((run.code, run.stdout.as_str()), (0, ""));
    assert_eq!(run.stderr.trim(), "The crate is in arm: cd arm, then cargo run and cargo test");
    let readme = fs::read_to_string(folder.join("arm/README.md")).unwrap();
    assert!(["`cargo run`", "`cargo test`", "`models/kr5.toml`"].iter().all(|what| readme.contains(what)), "{readme}");
    let quiet = call(&folder, &["new", "hand", "--quiet"]);
    assert_eq!((quiet.code, quiet.output().as_str()), (0, ""));
    assert_eq!(names(&folder), ["arm", "hand"]);
}

/// The dependency in the manifest of a new crate.
fn dependency(folder: &Path) -> PathBuf {
    let manifest: toml::Table = fs::read_to_string(folder.join("Cargo.toml")).unwrap().parse().unwrap();
    PathBuf::from(manifest["dependencies"]["redysim"]["path"].as_str().unwrap())
}

#[test]
fn a_new_crate_depends_on_the_checkout_of_the_command_or_on_the_one_that_is_given() {
    let folder = scratch("new-checkout");
    succeed(&folder, &["new", "own"]);
    assert_eq!(dependency(&folder.join("own")), root().canonicalize().unwrap());
    let other = folder.join("it's \"another\" one");
    fs::create_dir(&other).unwrap();
    fs::write(other.join("Cargo.toml"), "[package]\nname = \"redysim\"\n").unwrap();
    succeed(&folder, &["new", "given", "--redysim", "it's \"another\" one"]);
    assert_eq!(dependency(&folder.join("given")), other.canonicalize().unwrap());
    fs::write(other.join("Cargo.toml"), "[package]\nname = \"other\"\n").unwrap();
    let refused = fail(&folder, &["new", "third", "--redysim", "it's \"another\" one"], 2);
    assert!(refused.contains("is not a checkout of redysim"), "{refused}");
    assert!(!folder.join("third").exists());
}

#[test]
fn names_that_a_crate_cannot_have_are_refused_with_one_that_it_can() {
    let folder = scratch("new-names");
    let names_and_suggestions =
        [("match", "`match-robot`"), ("my arm", "`my-arm`"), ("3rrr", "`robot-3rrr`"), ("redysim", "`redysim-robot`")];
    for (name, suggested) in names_and_suggestions {
        let refused = fail(&folder, &["new", name], 2);
        assert!(refused.contains(&format!("a crate cannot be named `{name}`")), "{refused}");
        assert!(refused.contains(suggested), "{refused}");
    }
    assert!(fail(&folder, &["new", "nowhere/arm"], 3).contains("nowhere"));
    assert!(fail(&folder, &["new", ".."], 2).contains("`../robot`"));
    assert!(names(&folder).is_empty(), "{:?}", names(&folder));
}

#[test]
fn what_is_there_is_never_overwritten() {
    let folder = scratch("new-exists");
    fs::create_dir(folder.join("empty")).unwrap();
    fs::write(folder.join("file"), "mine").unwrap();
    for name in ["empty", "file"] {
        let refused = fail(&folder, &["new", name], 3);
        assert!(refused.contains(&format!("{name} exists already")), "{refused}");
    }
    assert!(names(&folder.join("empty")).is_empty());
    assert_eq!(fs::read_to_string(folder.join("file")).unwrap(), "mine");
    assert_eq!(names(&folder), ["empty", "file"]);
}

#[test]
fn nothing_is_made_of_a_robot_with_faults() {
    let folder = scratch("new-faults");
    let write = |name: &str, text: String| fs::write(folder.join(name), text).unwrap();
    let fourbar = fs::read_to_string(model("fourbar.toml")).unwrap();
    write("apart.toml", fourbar.replace("point_b = [0.1152, 0.0, 0.0]", "point_b = [9.0, 0.0, 0.0]"));
    write("loose.toml", format!("tolerance = 1e-3\n{fourbar}"));
    write("faulty.toml", fourbar.replace("mass = 3.0", "mass = -3.0"));
    write("faulty.urdf", URDF.replace("<mass value=\"2\"/>", ""));
    let before = names(&folder);
    for (robot, code, message) in [
        ("kr6", 2, "did you mean `kr5`? The robots are: kr5, gripper, fourbar"),
        ("kr6.toml", 3, "cannot read the model file"),
        ("kr6.urdf", 3, "kr6.urdf"),
        ("faulty.toml", 1, "mass"),
        ("faulty.urdf", 1, "faulty.urdf:"),
        ("apart.toml", 1, "the loops stay open"),
        ("loose.toml", 1, "`tolerance`"),
    ] {
        let refused = fail(&folder, &["new", "arm", "--robot", robot], code);
        assert!(refused.contains(message), "{robot}: {refused}");
        assert_eq!(names(&folder), before, "{robot}");
    }
}
