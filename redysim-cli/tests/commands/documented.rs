//! Every command of the documentation does what it is there for.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

use crate::common::{Table, WALKING, all_tools, bash, cargo, root, scratch, skip, succeed};

/// What takes five to ten seconds in a debug build: robots that walk, and hundreds of four-bars.
const SLOW: [&str; 4] = [WALKING[0], WALKING[1], WALKING[2], "fourbar_tolerances"];

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
    let inertial = &PANDA[PANDA.find("<inertial>").unwrap()..PANDA.find("</link><joint").unwrap()];
    let root = format!("<link name=\"base\">{inertial}</link>");
    fs::write(folder.join("satellite.urdf"), PANDA.replace("<link name=\"base\"/>", &root)).unwrap();
    folder
}

fn run(folder: &Path, command: &str) -> String {
    succeed(folder, &command.split_whitespace().collect::<Vec<_>>())
}

/// What a document asks its reader to do.
#[derive(Debug)]
enum Step {
    /// To write a file: a block of code whose first line is a comment with its path alone, `# swing.toml` or
    /// `// src/main.rs`.
    Write { path: String, text: String },
    /// To call `redysim`: a command between backticks in the first column of a table, or in a block.
    Redysim(String),
    /// To change the folder.
    Enter(String),
    /// `cargo run` or `cargo test`, in a new crate.
    Cargo(String),
    /// To call the C compiler, CMake, or what they have made.
    Compiled(String),
}

/// The steps of a document, in the order in which they stand.
fn steps(text: &str) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.starts_with("```") {
            let block: Vec<&str> = lines.by_ref().take_while(|line| !line.starts_with("```")).collect();
            let first = block.first().copied().unwrap_or_default();
            let path = ["# ", "// "].iter().find_map(|mark| first.strip_prefix(mark));
            match path.filter(|path| !path.contains(' ') && path.contains('.')) {
                Some(path) => steps.push(Step::Write { path: path.to_owned(), text: block.join("\n") }),
                None => steps.extend(block.iter().filter_map(|line| of_line(line))),
            }
        } else if let Some(command) = line.strip_prefix("| `").and_then(|rest| rest.split('`').next()) {
            steps.extend(of_line(command).filter(|step| matches!(step, Step::Redysim(_))));
        }
    }
    steps
}

/// The step of a line of a block, if it is one.
fn of_line(line: &str) -> Option<Step> {
    let command = line.split(" #").next().unwrap_or(line).trim_end();
    if let Some(arguments) = command.strip_prefix("redysim ") {
        return Some(Step::Redysim(arguments.to_owned())).filter(|_| !arguments.starts_with('='));
    }
    if ["cc ", "cmake ", "./"].iter().any(|start| command.starts_with(start)) {
        return Some(Step::Compiled(command.to_owned()));
    }
    match command.split_once(' ') {
        Some(("cd", folder)) if !folder.contains(' ') => Some(Step::Enter(folder.to_owned())),
        Some(("cargo", of @ ("run" | "test"))) => Some(Step::Cargo(of.to_owned())),
        _ => None,
    }
}

fn is_by_cmake(command: &str) -> bool {
    ["cmake ", "./build/"].iter().any(|start| command.starts_with(start))
}

/// Takes all steps of a document, each of which uses what those before it have written. Returns the folder and the
/// text.
pub fn run_all(name: &str, document: &str, least: usize) -> (PathBuf, String) {
    let mut folder = folder_with_examples(name);
    let text = fs::read_to_string(root().join(document)).unwrap();
    let steps = steps(&text);
    assert!(steps.len() >= least, "{steps:?}");
    for step in steps {
        match step {
            Step::Write { path, text } => {
                let path = folder.join(path);
                fs::create_dir_all(path.parent().unwrap()).unwrap();
                fs::write(path, text).unwrap();
            }
            Step::Redysim(command) if cfg!(debug_assertions) && SLOW.iter().any(|slow| command.contains(slow)) => {}
            Step::Redysim(command) => drop(run(&folder, &command)),
            Step::Enter(inner) => folder.push(inner),
            // To build the crates that a new one depends on takes half a minute.
            Step::Cargo(_) if cfg!(debug_assertions) => {}
            Step::Cargo(command) => {
                let run = cargo(&folder, &command);
                assert_eq!(run.code, 0, "{document}: cargo {command}: {}", run.output());
            }
            Step::Compiled(command) if is_by_cmake(&command) && !all_tools() => skip("CMake is not used"),
            Step::Compiled(command) => {
                let run = bash(&folder, &command, &[]);
                assert_eq!(run.code, 0, "{document}: {command}: {}", run.output());
            }
        }
    }
    (folder, text)
}

#[test]
fn the_commands_of_the_readme_run() {
    run_all("documented-readme", "README.md", 8);
}

#[test]
fn the_commands_of_the_guide_to_ones_own_robot_run() {
    run_all("documented-own-robot", "docs/own_robot.md", 5);
}

#[test]
fn the_first_steps_can_be_taken() {
    let (folder, _) = run_all("documented-first-steps", "docs/first_steps.md", 15);
    assert!(["fall/forward", "lift/inverse"].iter().all(|run| folder.join("results").join(run).is_dir()));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_commands_of_the_chapter_on_closed_loops_run_and_print_what_it_shows() {
    let (folder, text) = run_all("documented-closed-loops", "docs/closed_loops.md", 8);
    let shown = text.split("```text\n").nth(1).unwrap().split("```").next().unwrap();
    let printed = run(&folder, "check models/fourbar.toml");
    assert!(shown.lines().count() == 3 && shown.lines().all(|line| printed.contains(line)), "{shown}{printed}");
}

/// A C compiler is there: Rust links with it.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_commands_of_the_chapter_on_c_run() {
    let (folder, _) = run_all("documented-c", "docs/c.md", 7);
    assert!(["gripper.o", "hold", "check"].iter().all(|made| folder.join("controller").join(made).is_file()));
}

/// `.ci/run` calls a script that compiles and runs what they write.
#[test]
fn the_commands_of_the_chapter_on_simulation_tools_run() {
    let (folder, text) = run_all("documented-tools", "docs/simulation_tools.md", 2);
    assert!(folder.join("matlab/kr5_check.m").is_file() && folder.join("fmus/kr5.fmu").is_file());
    let ci = fs::read_to_string(root().join(".ci/run")).unwrap();
    assert!(text.contains("`.ci/simulation_tools`") && ci.contains("step .ci/simulation_tools\n"));
}

/// `.ci/run` calls the script of the chapter, which needs compilers for microcontrollers.
#[test]
fn the_commands_of_the_chapter_on_microcontrollers_run() {
    let (folder, text) = run_all("documented-embedded", "docs/embedded.md", 1);
    assert!(folder.join("firmware/kr5.c").is_file());
    let script = "examples/embedded/run";
    let ci = fs::read_to_string(root().join(".ci/run")).unwrap();
    assert!(text.contains(&format!("```sh\n{script}\n")) && ci.contains(&format!("step {script}\n")));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_commands_of_the_chapter_on_robots_that_float_and_walk_run() {
    run_all("documented-floating", "docs/floating_and_walking.md", 7);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_scenarios_of_the_chapter_on_controllers_end_where_its_table_has_them() {
    let (folder, text) = run_all("documented-controllers", "docs/controllers.md", 15);
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `redysim forward ")?.split_once(".toml`"));
    let mut count = 0;
    for (name, rest) in rows {
        let shown = rest.rsplit('|').nth(1).unwrap().trim();
        let table = Table::csv(&folder.join("results").join(name).join("forward/statevar.csv"));
        let found = *table.column("q joint2 [rad]").last().unwrap();
        assert_eq!(shown, format!("{found:.4}"), "{name}");
        count += 1;
    }
    assert_eq!(count, 4);
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

/// Where the links and pictures of a document lead.
fn links(text: &str) -> impl Iterator<Item = &str> {
    without_code(text).flat_map(|line| line.split("](").skip(1)).filter_map(|rest| rest.split(')').next())
}

/// The documents of the folder `docs`.
fn documents() -> impl Iterator<Item = PathBuf> {
    let docs = fs::read_dir(root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    docs.filter(|path| path.extension().is_some_and(|extension| extension == "md"))
}

#[test]
fn every_document_is_a_chapter_of_the_book_and_every_chapter_a_document() {
    let summary = fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    let mut chapters: Vec<_> = links(&summary).map(|link| root().join("docs").join(link)).collect();
    let mut documents: Vec<_> = documents().filter(|path| !path.ends_with("SUMMARY.md")).collect();
    chapters.sort();
    documents.sort();
    assert_eq!(chapters, documents);
}

#[test]
fn every_link_of_the_documentation_leads_to_a_file_and_its_heading() {
    let others = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "peers/README.md", "tests/reference/README.md"];
    let (mut broken, mut count) = (Vec::new(), 0);
    for path in documents().chain(others.map(|name| root().join(name))) {
        let text = fs::read_to_string(&path).unwrap();
        for link in links(&text).filter(|link| !link.contains("://")) {
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
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_commands_of_the_scenarios_run() {
    run_all("documented-scenarios", "docs/scenarios.md", 3);
}

#[test]
fn the_commands_of_the_chapter_on_sweeps_run() {
    let (folder, _) = run_all("documented-sweeps", "docs/sweeps.md", 7);
    let rows = fs::read_to_string(folder.join("results/swings/rows.csv")).unwrap();
    assert_eq!(rows.lines().count(), 11);
    assert!(folder.join("results/sample_7/forward/run.toml").is_file());
}

/// The examples that the help gives, but those that pipe into other programs.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_examples_of_the_help_run() {
    let folder = folder_with_examples("documented-help");
    // What `plot` and `animate` are shown with.
    run(&folder, "inverse scenarios/kuka.toml");
    run(&folder, "forward scenarios/kuka.toml");
    for command in ["new", "check", "inverse", "forward", "sweep", "plot", "animate", "show", "generate", "import"] {
        let help = run(&folder, &format!("{command} --help"));
        let examples = help.lines().filter_map(|line| line.strip_prefix("  redysim "));
        let alone: Vec<&str> = examples.filter(|example| !example.contains(['|', '>'])).collect();
        assert!(!alone.is_empty(), "{command} has an example");
        for example in alone {
            run(&folder, example);
        }
    }
}
