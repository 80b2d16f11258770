//! A result has all that is needed to do it again, to the last bit.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{WALKING, names, root, scenario, scratch, shipped, succeed};
use rayon::prelude::*;

/// Does the result `folder` again in `elsewhere`, without the files that its scenario named, and compares all tables.
fn again(command: &str, folder: &Path, elsewhere: &Path) {
    fs::rename(folder, elsewhere).unwrap();
    succeed(elsewhere, &[command, "run.toml", "-o", "second"]);
    let second = elsewhere.join("second");
    for name in names(&second) {
        let read = |folder: &Path| fs::read_to_string(folder.join(&name)).unwrap();
        if name == "run.toml" {
            let scenario = |text: String| text.split("# How it went.").next().unwrap().to_owned();
            assert_eq!(scenario(read(elsewhere)), scenario(read(&second)), "nothing is left open");
        } else {
            assert!(read(elsewhere) == read(&second), "{}: {name}", elsewhere.display());
        }
    }
    assert_eq!(names(elsewhere).len(), names(&second).len() + 1);
}

/// The energy that has come from nowhere, and the most that was exchanged, J.
fn balance(result: &Path) -> [f64; 2] {
    let run: toml::Table = fs::read_to_string(result.join("run.toml")).unwrap().parse().unwrap();
    ["energy_drift", "energy_exchanged"].map(|key| run["run"][key].as_float().unwrap())
}

/// A run of `command` in an empty folder, done again in another.
fn twice(name: &str, command: &str, path: &str) -> PathBuf {
    let (folder, elsewhere) = (scratch(name), scratch(&format!("{name}-elsewhere")));
    succeed(&folder, &[command, path, "-o", "first"]);
    again(command, &folder.join("first"), &elsewhere.join("run"));
    elsewhere.join("run")
}

/// The drift of a motion at the shipped tolerances, which are ReDySim's, is not to be seen: a line in a picture is a
/// two-hundredth of its height. That of inverse dynamics is what Gauss's rule leaves of the work: the forces are exact.
#[test]
fn every_shipped_scenario_runs_again_from_its_folder_alone_and_keeps_its_energy() {
    let mut runs = Vec::new();
    for name in names(&root().join("scenarios")).iter().filter_map(|name| name.strip_suffix(".toml")) {
        let text = fs::read_to_string(shipped(name)).unwrap();
        let has = |command: &str| text.contains(&format!("\n[{command}]\n"));
        let bounds = [("inverse", 1e-7), ("forward", 1.0 / 200.0)];
        runs.extend(bounds.into_iter().filter(|(command, _)| has(command)).map(|bound| (name.to_owned(), bound)));
    }
    assert!(runs.len() >= 20, "{} runs", runs.len());
    if cfg!(debug_assertions) {
        runs.retain(|(name, _)| !WALKING.contains(&name.as_str()));
        runs = runs.into_iter().step_by(8).collect();
    }
    runs.par_iter().for_each(|(name, (command, most))| {
        let [drift, exchanged] = balance(&twice(&format!("again-{name}-{command}"), command, &shipped(name)));
        assert!(drift <= most * exchanged, "{name}, {command}: {drift:e} of {exchanged} J");
    });
}

#[test]
fn a_run_with_a_table_of_forces_runs_again_from_its_folder_alone() {
    let folder = scratch("again-forces");
    fs::write(folder.join("forces.csv"), "t [s],tau joint1 [N m],tau joint2 [N m]\n0,0,0\n1,1,-1\n").unwrap();
    let rest = "initial = { q = { joint2 = '60 deg' } }\n[forward]\nend = 1.0\nstep = 0.1\ntorque = { law = 'csv', file = 'forces.csv' }\n";
    succeed(&folder, &["forward", &scenario(&folder, "two_link.toml", rest), "-o", "first"]);
    fs::remove_file(folder.join("forces.csv")).unwrap();
    let elsewhere = scratch("again-forces-elsewhere").join("run");
    again("forward", &folder.join("first"), &elsewhere);
    let run = fs::read_to_string(elsewhere.join("run.toml")).unwrap();
    assert!(run.contains("file = \"torque.csv\", joints = [\"joint1\", \"joint2\"] }"), "{run}");
}

#[test]
fn a_run_along_a_table_of_points_runs_again_from_its_folder_alone() {
    let folder = scratch("again-points");
    fs::write(folder.join("points.csv"), "t [s],q joint1 [rad],q joint2 [rad]\n0,0,0\n0.5,1,-1\n1,0,1\n").unwrap();
    let rest = "trajectory = { kind = 'csv', file = 'points.csv' }\n[inverse]\nend = 1.0\nstep = 0.1\n\
                [forward]\nend = 1.0\nstep = 0.1\ntorque = { law = 'tracking-pd', kp = 1, kd = 1 }\n";
    let path = scenario(&folder, "two_link.toml", rest);
    for command in ["inverse", "forward"] {
        succeed(&folder, &[command, &path, "-o", "first"]);
        let elsewhere = scratch(&format!("again-points-{command}")).join("run");
        again(command, &folder.join("first"), &elsewhere);
        let run = fs::read_to_string(elsewhere.join("run.toml")).unwrap();
        assert!(run.contains("through = \"minimum-jerk\""), "{run}");
    }
}

#[test]
fn a_run_whose_scenario_names_kinds_alone_runs_again_from_its_folder_alone() {
    let folder = scratch("again-kinds");
    let rest = "initial = { q = [0, 0.9844, 4.3144] }\n[forward]\nend = 0.2\nstep = 0.1\ntorque = 'free'\n\
                stabilisation = 'none'\nintegrator = 0\n";
    twice("again-kinds-alone", "forward", &scenario(&folder, "fourbar.toml", rest));
}
