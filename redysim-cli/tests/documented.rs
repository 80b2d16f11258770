//! Every command of the documentation does what it is there for.
#![cfg(unix)]

mod common;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use common::{root, scratch, succeed};

const PANDA: &str = "<robot name=\"panda\"><link name=\"base\"/><link name=\"arm\"><inertial><mass value=\"1\"/>\
    <origin xyz=\"0 0 0.3\"/><inertia ixx=\"0.1\" iyy=\"0.1\" izz=\"0.1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\
    <joint name=\"shoulder\" type=\"continuous\"><parent link=\"base\"/><child link=\"arm\"/></joint></robot>";

/// A folder with what the examples name.
fn folder_with_examples(name: &str) -> PathBuf {
    let folder = scratch(name);
    for shared in ["models", "scenarios"] {
        symlink(root().join(shared), folder.join(shared)).unwrap();
    }
    fs::create_dir(folder.join("src")).unwrap();
    fs::write(folder.join("panda.urdf"), PANDA).unwrap();
    folder
}

fn run(folder: &Path, command: &str) -> String {
    succeed(folder, &command.split_whitespace().collect::<Vec<_>>())
}

/// Runs the commands between backticks in the first column of a table, and those in blocks without their comments, in
/// the order in which they stand, for each uses what those before it have written.
fn run_all(name: &str, document: &str, least: usize) {
    let folder = folder_with_examples(name);
    let text = fs::read_to_string(root().join(document)).unwrap();
    let of_line = |line: &str| -> Option<String> {
        let in_table = line.strip_prefix("| `redysim ").and_then(|rest| rest.split('`').next());
        let in_block = || line.strip_prefix("redysim ").and_then(|rest| rest.split('#').next());
        in_table.or_else(in_block).filter(|command| !command.starts_with('=')).map(str::to_owned)
    };
    let commands: Vec<String> = text.lines().filter_map(of_line).collect();
    assert!(commands.len() >= least, "{commands:?}");
    for command in commands {
        run(&folder, &command);
    }
}

#[test]
fn the_commands_of_the_readme_run() {
    run_all("documented-readme", "README.md", 8);
}

#[test]
fn the_commands_of_the_scenarios_run() {
    run_all("documented-scenarios", "docs/scenarios.md", 3);
}

/// The examples that the help gives, but those that pipe into other programs.
#[test]
fn the_examples_of_the_help_run() {
    let folder = folder_with_examples("documented-help");
    // What `plot` and `animate` are shown with.
    run(&folder, "inverse scenarios/kuka.toml");
    run(&folder, "forward scenarios/kuka.toml");
    for command in ["check", "inverse", "forward", "plot", "animate", "show", "generate", "import"] {
        let help = run(&folder, &format!("{command} --help"));
        let examples = help.lines().filter_map(|line| line.strip_prefix("  redysim "));
        let alone: Vec<&str> = examples.filter(|example| !example.contains(['|', '>'])).collect();
        assert!(!alone.is_empty(), "{command} has an example");
        for example in alone {
            run(&folder, example);
        }
    }
}
