//! Nothing that is there is lost, whatever the options of a run and whatever happens meanwhile.

use std::fs;

use crate::common::{SWING, fail, names, scenario, scratch, succeed};

#[test]
fn an_empty_folder_is_a_place_for_a_result() {
    let folder = scratch("folders-empty");
    let path = scenario(&folder, "two_link.toml", SWING);
    fs::create_dir(folder.join("run")).unwrap();
    succeed(&folder, &["forward", &path, "-o", "run"]);
    assert!(names(&folder.join("run")).contains(&"run.toml".to_owned()));
    assert_eq!(names(&folder), ["run", "trial.toml"]);
}

#[test]
fn a_result_is_not_overwritten_unless_it_must_be() {
    let folder = scratch("folders-exists");
    let path = scenario(&folder, "two_link.toml", SWING);
    succeed(&folder, &["forward", &path]);
    assert_eq!(names(&folder), ["results", "trial.toml"]);
    let result = folder.join("results/trial/forward");
    let before = fs::read(result.join("run.toml")).unwrap();
    let output = fail(&folder, &["forward", &path], 3);
    assert!(output.contains("there already") && output.contains("--force"), "{output}");
    assert_eq!(fs::read(result.join("run.toml")).unwrap(), before);
    succeed(&folder, &["forward", &path, "--force"]);
    assert_ne!(fs::read(result.join("run.toml")).unwrap(), before, "the times differ");
    assert_eq!(names(&folder.join("results/trial")), ["forward"]);
}

#[test]
fn what_is_not_a_result_is_never_overwritten() {
    let folder = scratch("folders-mine");
    let path = scenario(&folder, "two_link.toml", SWING);
    fs::create_dir(folder.join("mine")).unwrap();
    fs::write(folder.join("mine/thesis.txt"), "years of work").unwrap();
    let output = fail(&folder, &["forward", &path, "-o", "mine", "--force"], 3);
    assert!(output.contains("it is not a result"), "{output}");
    assert_eq!(names(&folder.join("mine")), ["thesis.txt"]);
}

#[test]
fn a_folder_that_cannot_be_made_is_reported_and_leaves_nothing() {
    let folder = scratch("folders-unwritable");
    let path = scenario(&folder, "two_link.toml", SWING);
    let before = names(&folder);
    // A file is not a folder, whoever asks.
    let output = fail(&folder, &["forward", &path, "-o", "trial.toml/run"], 3);
    assert!(output.contains("cannot make the folder trial.toml/run"), "{output}");
    let output = fail(&folder, &["forward", &path, "-o", "/"], 3);
    assert!(output.contains("--output"), "{output}");
    assert_eq!(names(&folder), before);
}

#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_half_written() {
    let folder = scratch("folders-full");
    let path = scenario(&folder, "two_link.toml", &SWING.replace("step = 0.1", "step = 0.001"));
    let before = names(&folder);
    let output = crate::common::on_a_full_disk(&folder, 8, &["forward", &path]);
    assert!(output.contains("cannot write"), "{output}");
    assert_eq!(names(&folder), before, "{output}");
}

/// Somebody's project: their own scenario is called as the one of a result is.
#[test]
fn a_folder_with_a_scenario_of_ones_own_is_not_a_result() {
    let folder = scratch("folders-project");
    let path = scenario(&folder, "two_link.toml", SWING);
    fs::create_dir(folder.join("project")).unwrap();
    fs::copy(folder.join("trial.toml"), folder.join("project/run.toml")).unwrap();
    let output = fail(&folder, &["forward", &path, "-o", "project", "--force"], 3);
    assert!(output.contains("it is not a result"), "{output}");
    assert_eq!(names(&folder.join("project")), ["run.toml"]);
}

#[test]
fn notes_beside_a_result_are_not_lost() {
    let folder = scratch("folders-notes");
    let path = scenario(&folder, "two_link.toml", SWING);
    succeed(&folder, &["forward", &path, "-o", "run"]);
    fs::write(folder.join("run/notes.md"), "what I have seen").unwrap();
    let output = fail(&folder, &["forward", &path, "-o", "run", "--force"], 3);
    assert!(output.contains("run is not overwritten: it holds notes.md"), "{output}");
    assert!(folder.join("run/notes.md").exists());
}

/// Pictures of the earlier run would be wrong of the new one.
#[test]
fn pictures_of_a_result_go_with_it() {
    let folder = scratch("folders-pictures");
    let rest = "initial = { q = [0, 0.9844, 4.3144] }\n[forward]\nend = 0.2\nstep = 0.1\n";
    let path = scenario(&folder, "fourbar.toml", rest);
    succeed(&folder, &["forward", &path, "-o", "run", "--format", "dat"]);
    succeed(&folder, &["forward", &path, "-o", "run", "--force"]);
    let written = names(&folder.join("run"));
    succeed(&folder, &["plot", "run"]);
    succeed(&folder, &["animate", "run"]);
    assert!(names(&folder.join("run")).len() > written.len());
    succeed(&folder, &["forward", &path, "-o", "run", "--force"]);
    assert_eq!(names(&folder.join("run")), written);
}

#[cfg(unix)]
#[test]
fn a_link_is_refused_before_anything_is_computed() {
    let folder = scratch("folders-link");
    let path = scenario(&folder, "two_link.toml", SWING);
    std::os::unix::fs::symlink("nowhere", folder.join("run")).unwrap();
    for force in [&[][..], &["--force"]] {
        let output = fail(&folder, &[&["forward", &path, "-o", "run"], force].concat(), 3);
        assert!(output.contains("a file or a link") && !output.contains("computed"), "{output}");
    }
    assert_eq!(names(&folder), ["run", "trial.toml"]);
}

#[cfg(unix)]
mod meanwhile {
    use super::*;
    use crate::common::running::{Running, interrupted};

    #[test]
    fn a_folder_that_appears_is_kept_and_so_is_the_run() {
        for options in [&[][..], &["--force"]] {
            let folder = scratch(&format!("folders-appears{}", options.concat()));
            let path = scenario(&folder, "two_link.toml", crate::common::LONG);
            let run = Running::begin(&folder, &[&["forward", &path, "-o", "run"], options].concat());
            fs::create_dir(folder.join("run")).unwrap();
            fs::write(folder.join("run/notes.md"), "not a result").unwrap();
            let (code, output) = interrupted(run);
            assert_eq!(code, Some(3), "{output}");
            assert!(output.contains("what was computed is in run-2"), "{output}");
            assert_eq!(names(&folder), ["run", "run-2", "trial.toml"]);
            assert_eq!(names(&folder.join("run")), ["notes.md"]);
            assert!(names(&folder.join("run-2")).contains(&"run.toml".to_owned()));
        }
    }

    #[test]
    fn two_runs_into_one_folder_do_not_harm_each_other() {
        let folder = scratch("folders-two");
        let path = scenario(&folder, "two_link.toml", crate::common::LONG);
        let runs = [(); 2].map(|()| Running::begin(&folder, &["forward", &path, "-o", "run"]));
        let [first, second] = runs.map(interrupted);
        assert_eq!((first.0, second.0), (Some(130), Some(3)), "{} {}", first.1, second.1);
        assert_eq!(names(&folder), ["run", "run-2", "trial.toml"]);
        for run in ["run", "run-2"] {
            assert!(names(&folder.join(run)).contains(&"run.toml".to_owned()));
        }
    }

    #[test]
    fn a_model_that_is_changed_or_deleted_leaves_the_run_what_it_was() {
        let folder = scratch("folders-model");
        let model = fs::read_to_string(crate::common::root().join("models/two_link.toml")).unwrap();
        fs::write(folder.join("model.toml"), &model).unwrap();
        fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{}", crate::common::LONG)).unwrap();
        let run = Running::begin(&folder, &["forward", "trial.toml", "-o", "run"]);
        fs::remove_file(folder.join("model.toml")).unwrap();
        let (code, output) = interrupted(run);
        assert_eq!(code, Some(130), "{output}");
        assert_eq!(fs::read_to_string(folder.join("run/model.toml")).unwrap(), model);
    }
}

/// A folder is not a table of a run, whatever it is called.
#[test]
fn a_folder_within_a_result_is_not_of_a_run() {
    let folder = scratch("folders-within");
    let path = scenario(&folder, "two_link.toml", SWING);
    succeed(&folder, &["forward", &path, "-o", "run"]);
    fs::remove_file(folder.join("run/tor.csv")).unwrap();
    fs::create_dir(folder.join("run/tor.csv")).unwrap();
    fs::write(folder.join("run/tor.csv/thesis.txt"), "years of work").unwrap();
    let output = fail(&folder, &["forward", &path, "-o", "run", "--force"], 3);
    assert!(output.contains("it holds tor.csv, which is of no run"), "{output}");
}

#[test]
fn a_page_takes_no_place_of_a_table() {
    let folder = scratch("folders-page");
    let path = scenario(&folder, "two_link.toml", SWING);
    succeed(&folder, &["forward", &path, "-o", "run"]);
    let before = fs::read(folder.join("run/statevar.csv")).unwrap();
    for name in ["run/statevar.csv", "run/model.toml", "./run/../run/run.toml"] {
        let output = fail(&folder, &["animate", "run", "-o", name, "--force"], 2);
        assert!(output.contains("is a file of the results"), "{output}");
    }
    assert_eq!(fs::read(folder.join("run/statevar.csv")).unwrap(), before);
}
