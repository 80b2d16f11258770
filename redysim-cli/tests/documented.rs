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
fn the_commands_of_the_guide_to_ones_own_robot_run() {
    run_all("documented-own-robot", "docs/own_robot.md", 5);
}

/// The names by which links lead to the headings of a document, as web pages of Markdown make them.
fn anchors(text: &str) -> Vec<String> {
    let headings =
        without_code(text).filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let of_heading = |heading: &str| -> String {
        let kept = heading.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
        kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
    };
    headings.map(of_heading).collect()
}

/// The lines outside blocks of code.
fn without_code(text: &str) -> impl Iterator<Item = &str> {
    let mut code = false;
    text.lines().filter(move |line| {
        let fence = line.trim_start().starts_with("```");
        code ^= fence;
        !code && !fence
    })
}

#[test]
fn every_link_of_the_documentation_leads_to_a_file_and_its_heading() {
    let docs = fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let docs = docs.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let others = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "peers/README.md", "tests/reference/README.md"];
    let (mut broken, mut count) = (Vec::new(), 0);
    for path in docs.chain(others.map(|name| root().join(name))) {
        let text = fs::read_to_string(&path).unwrap();
        let links =
            without_code(&text).flat_map(|line| line.split("](").skip(1)).filter_map(|rest| rest.split(')').next());
        for link in links.filter(|link| !link.contains("://")) {
            count += 1;
            let (file, anchor) = link.split_once('#').map_or((link, None), |(file, anchor)| (file, Some(anchor)));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name("").join(file) };
            let found = match anchor {
                None => target.exists(),
                Some(anchor) => {
                    fs::read_to_string(&target).is_ok_and(|text| anchors(&text).iter().any(|name| name == anchor))
                }
            };
            if !found {
                broken.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(count > 50, "{count}");
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
    for command in ["new", "check", "inverse", "forward", "plot", "animate", "show", "generate", "import"] {
        let help = run(&folder, &format!("{command} --help"));
        let examples = help.lines().filter_map(|line| line.strip_prefix("  redysim "));
        let alone: Vec<&str> = examples.filter(|example| !example.contains(['|', '>'])).collect();
        assert!(!alone.is_empty(), "{command} has an example");
        for example in alone {
            run(&folder, example);
        }
    }
}
