//! A closed pipe is not a fault: every subcommand ends as it would otherwise, whichever of its pipes is closed.
#![cfg(unix)]

use crate::common::{bash, root, scenario, scratch, succeed};
use rayon::prelude::*;

/// Calls the program in a folder with results, a model and a URDF, with a reader of `stream` that leaves at once: it
/// must end with `code`, and print nothing about it on the other stream. Returns what it does otherwise.
fn fault(stream: &str, arguments: &str, code: i32) -> Option<String> {
    let folder = scratch(&format!("pipes-{}", arguments.replace(|c: char| !c.is_alphanumeric(), "_") + stream));
    let swing = "initial = { q = [0, 1] }\nforward = { end = 0.1, step = 0.1 }\n";
    let lift = "trajectory = { from = [0, 0], to = [1, 1], duration = 0.1 }\ninverse = { end = 0.1, step = 0.1 }\n";
    scenario(&folder, "two_link.toml", &[swing, lift].concat());
    succeed(&folder, &["forward", "trial.toml", "-o", "run", "--quiet"]);
    std::fs::write(folder.join("robot.urdf"), ROBOT).unwrap();
    std::fs::copy(root().join("models/two_link.toml"), folder.join("model.toml")).unwrap();
    let away = if stream == "stdout" { "| true" } else { "2>&1 >/dev/null | true" };
    // The program starts when its reader is gone.
    let command = format!("(sleep 0.1; exec \"$0\" {arguments}) {away}; exit ${{PIPESTATUS[0]}}");
    let run = bash(&folder, &command, &[]);
    let right = run.code == code && !run.stderr.contains("panicked");
    (!right).then(|| format!("{arguments}, {stream}: exit code {}: {}", run.code, run.stderr))
}

const ROBOT: &str = "<robot name=\"r\"><material name=\"red\"/><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/>\
    <inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
    <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint></robot>";

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_reader_that_closes_the_pipe_is_not_a_failure() {
    for stream in ["stdout", "stderr"] {
        let calls = [
            "check model.toml",
            "check model.toml --json",
            "inverse trial.toml",
            "forward trial.toml",
            "generate model.toml",
            "generate model.toml -o model.rs",
            "import robot.urdf",
            "import robot.urdf -o imported.toml",
            "plot run",
            "animate run",
            "show model.toml",
            "show model.toml -o page.html",
            "completions bash",
            "--help",
            "--version",
        ];
        let faults: Vec<_> = calls.par_iter().filter_map(|arguments| fault(stream, arguments, 0)).collect();
        assert!(faults.is_empty(), "{faults:#?}");
    }
}

#[test]
fn a_failure_keeps_its_exit_code_when_the_pipe_is_closed() {
    for stream in ["stdout", "stderr"] {
        let calls = [
            ("check nowhere.toml", 3),
            ("forward robot.urdf", 1),
            ("inverse nowhere.toml", 3),
            ("generate nowhere.toml", 3),
            ("import model.toml", 1),
            ("plot nowhere", 3),
            ("animate nowhere", 3),
            ("show nowhere.toml", 3),
            ("completions cobol", 2),
        ];
        let faults: Vec<_> = calls.par_iter().filter_map(|(arguments, code)| fault(stream, arguments, *code)).collect();
        assert!(faults.is_empty(), "{faults:#?}");
    }
}
