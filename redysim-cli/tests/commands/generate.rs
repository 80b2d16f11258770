//! `redysim generate`: source that compiles, is the macro's, and is never lost.

use crate::common::{call, model, names, root, scratch};
use std::fs;
use std::io::Read;
use std::path::Path;
use zip::ZipArchive;

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
    assert!(run.stderr.contains("inverse_dynamics") && run.stderr.contains("330 flops"), "{}", run.stderr);
    assert_eq!(names(&folder), ["kr5.rs"], "no draft is left");
}

#[test]
fn a_name_that_is_not_one_of_a_type_is_refused() {
    let run = call(&root(), &["generate", &model("kr5.toml"), "--name", "my robot"]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""));
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

#[test]
fn c_is_written_to_a_folder_whose_files_stay_unless_forced() {
    let folder = scratch("generate-c");
    let run = call(&folder, &["generate", "--language", "c", &model("gripper.toml"), "-o", "made/here"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let made = folder.join("made/here");
    assert_eq!(names(&made), ["gripper.c", "gripper.h", "gripper_check.c"]);
    assert!(
        run.stderr.contains("inverse_dynamics      67 flops") && run.stderr.contains("gripper_check.c"),
        "{}",
        run.stderr
    );
    assert!(fs::read_to_string(made.join("gripper.h")).unwrap().contains("void gripper_mass_matrix(const double q"));
    // One of three: none is written.
    fs::remove_file(made.join("gripper.h")).unwrap();
    fs::write(made.join("gripper.c"), "mine").unwrap();
    let again = ["generate", "--language", "c", "--scalar", "f32", &model("gripper.toml"), "-o", "made/here"];
    let run = call(&folder, &again);
    assert_eq!((run.code, names(&made).len()), (3, 2));
    assert!(run.stderr.contains("gripper.c is there already") && run.stderr.contains("--force"), "{}", run.stderr);
    let run = call(&folder, &[&again[..], &["--force", "--functions", "mass_matrix"]].concat());
    assert_eq!((run.code, names(&made).len()), (0, 3));
    let header = fs::read_to_string(made.join("gripper.h")).unwrap();
    assert!(header.contains("void gripper_mass_matrix(const float q") && !header.contains("inverse_dynamics("));
}

#[test]
fn cpp_is_written_with_its_header_and_a_package_of_cmake() {
    let folder = scratch("generate-cpp");
    let run = call(&folder, &["generate", "--language", "cpp", &model("gripper.toml"), "-o", "made"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let made = folder.join("made");
    assert_eq!(names(&made), ["CMakeLists.txt", "gripper.c", "gripper.h", "gripper.hpp", "gripper_check.c"]);
    let header = fs::read_to_string(made.join("gripper.hpp")).unwrap();
    assert!(header.contains("inline Matrix mass_matrix(const Coordinates &q) noexcept"), "{header}");
}

/// Octave compiles and runs it in `.ci/simulation_tools`.
#[test]
fn a_gateway_for_matlab_is_written_with_its_help_and_its_check() {
    let folder = scratch("generate-mex");
    let run = call(&folder, &["generate", "--mex", &model("gripper.toml"), "-o", "made"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("mex -output gripper gripper_mex.c gripper.c"), "{}", run.stderr);
    let made = folder.join("made");
    assert_eq!(names(&made), ["gripper.c", "gripper.h", "gripper.m", "gripper_check.m", "gripper_mex.c"]);
    let read = |name: &str| fs::read_to_string(made.join(name)).unwrap();
    let head: String = read("gripper_mex.c").lines().take_while(|line| !line.starts_with(" */")).collect();
    assert!(head.contains("mex -output gripper") && head.contains("mkoctfile --mex -o gripper.mex"), "{head}");
    let help = read("gripper.m");
    for line in ["%   tau = gripper('inverse_dynamics', q, v, a)", "%   - q, 4 by 1: joint1 (rad), joint2 (rad)"] {
        assert!(help.contains(line), "{help}");
    }
}

/// The entries of an archive, by their paths.
fn entries(archive: &Path) -> Vec<(String, String)> {
    let mut archive = ZipArchive::new(fs::File::open(archive).unwrap()).unwrap();
    let count = archive.len();
    let entry = |index| {
        let mut entry = archive.by_index(index).unwrap();
        let mut text = String::new();
        entry.read_to_string(&mut text).unwrap();
        (entry.name().unwrap().to_string(), text)
    };
    (0..count).map(entry).collect()
}

/// `.ci/simulation_tools` compiles, validates and simulates FMUs.
#[test]
fn an_fmu_has_its_description_and_its_sources_and_is_always_the_same() {
    let folder = scratch("generate-fmu");
    let make = |out: &str, version: &str| {
        let of = ["generate", "--fmu", "--source-only", "--fmi", version, &model("kr5_floating.toml"), "-o", out];
        let run = call(&folder, &of);
        assert_eq!(run.code, 0, "{}", run.stderr);
        folder.join(out).join("kr5_floating.fmu")
    };
    let of_3 = make("three", "3.0");
    assert!(fs::read(&of_3).unwrap() == fs::read(make("again", "3.0")).unwrap(), "the same model, other bytes");
    for (archive, variable, structure) in [
        (
            &of_3,
            "<Float64 name=\"q.base.qw\" valueReference=\"22\" description=\"Coordinate base.qw\" causality=\"output\" \
             variability=\"continuous\" initial=\"exact\" unit=\"1\" start=\"1.0\"/>",
            "<ContinuousStateDerivative valueReference=\"41\" dependencies=\"19 20 21 22 29 30 31\"/>",
        ),
        (
            &make("two", "2.0"),
            "<ScalarVariable name=\"tau.joint1\" valueReference=\"10\" description=\"Joint force along joint1\" \
             causality=\"input\" variability=\"continuous\"><Real unit=\"N.m\" start=\"0.0\"/></ScalarVariable>",
            "<Unknown index=\"42\" dependencies=\"20 21 22 23 30 31 32\"/>",
        ),
    ] {
        let entries = entries(archive);
        let (first, description) = &entries[0];
        assert_eq!(first, "modelDescription.xml");
        assert!(description.contains(variable) && description.contains(structure), "{description}");
        for name in ["sources/kr5_floating.h", "sources/kr5_floating.c", "sources/kr5_floating_fmu.c"] {
            assert!(entries.iter().any(|(path, _)| path == name), "{name}");
        }
    }
}

#[test]
fn c_needs_a_folder_and_a_name_of_c() {
    let folder = scratch("generate-c-faults");
    fs::write(folder.join("file"), "mine").unwrap();
    let generate = |arguments: &[&str]| {
        let run = call(&folder, &[&["generate", &model("gripper.toml")], arguments].concat());
        (run.code, run.stderr)
    };
    for (arguments, code, expected) in [
        (&["--language", "c"][..], 2, "name one with --output"),
        (&["--language", "c", "-o", "file"], 3, "is not a folder"),
        (&["--language", "c", "-o", "new", "--name", "6axis"], 2, "`6axis` cannot begin the names of C"),
        (&["--language", "c", "-o", "new", "--name", "stdio"], 2, "--name"),
        (&["--language", "cpp"], 2, "--language cpp writes several files"),
        (&["--language", "cpp", "-o", "new", "--name", "class"], 2, "`class` cannot begin"),
        (&["--scalar", "f32"], 2, "add --language c"),
        (&["--mex"], 2, "--mex writes several files"),
        (&["--mex", "-o", "new", "--name", "6axis"], 2, "`6axis` cannot begin the names of C"),
        (&["--mex", "--language", "c", "-o", "new"], 2, "'--mex' cannot be used with '--language <LANGUAGE>'"),
        (&["--mex", "--scalar", "f64", "-o", "new"], 2, "'--mex'"),
        (&["--fmu"], 2, "--fmu writes several files"),
        (&["--fmu", "-o", "file"], 3, "is not a folder"),
        (&["--fmu", "--mex", "-o", "new"], 2, "cannot be used with"),
        (&["--fmu", "--functions", "energy", "-o", "new"], 2, "cannot be used with"),
        (&["--fmi", "2.0", "-o", "new"], 2, "--fmu"),
        (&["--fmu", "--fmi", "1.0", "-o", "new"], 2, "possible values: 2.0, 3.0"),
        (&["--language", "ada"], 2, "possible values: rust, c, cpp"),
    ] {
        let (found, message) = generate(arguments);
        assert!(found == code && message.contains(expected), "{arguments:?}: {found} {message}");
    }
    assert_eq!(names(&folder), ["file"]);
}

#[test]
fn an_fmu_of_closed_loops_is_refused() {
    let folder = scratch("generate-fmu-loops");
    let run = call(&folder, &["generate", "--fmu", &model("fourbar.toml"), "-o", "made"]);
    assert_eq!((run.code, names(&folder).len()), (1, 0));
    assert!(
        run.stderr.contains("the loop `crank-coupler`") && run.stderr.contains("redysim forward"),
        "{}",
        run.stderr
    );
}
