//! The counts of operations and instructions that the documentation tells are those that tests and studies hold.

use std::collections::BTreeMap;

use crate::documented::read;
use redysim::Function;

const ROBOTS: [&str; 5] = ["peers/kr5", "peers/gripper", "peers/humanoid30", "peers/chain10", "test/kr5_origin_axis"];

/// From set of passes and robot to the operations of inverse dynamics, forward dynamics and the mass matrix, as
/// `tests/code_generation/passes.rs` has found them.
fn snapshot() -> BTreeMap<(String, &'static str), String> {
    let mut counts = BTreeMap::new();
    let mut robot = ROBOTS[0];
    for line in read("tests/code_generation/snapshots/code_generation__passes__the_operations_with_each_pass_are_those_of_the_snapshot.snap").lines() {
        let found = ROBOTS.into_iter().find(|robot| line.split_whitespace().next() == Some(robot));
        if let Some(found) = found {
            robot = found;
        } else if line.starts_with("all ") || line.starts_with("no") {
            let (set, numbers) = line.split_at(22);
            let numbers: Vec<&str> = numbers.split_whitespace().take(3).collect();
            counts.insert((set.trim().to_string(), robot), numbers.join(" / "));
        }
    }
    counts
}

#[test]
fn the_table_of_passes_is_that_of_the_snapshot() {
    let counts = snapshot();
    let documentation = read("docs/performance.md");
    let of_kr5 = counts.keys().filter(|(_, robot)| *robot == ROBOTS[0]);
    for (set, _) in of_kr5 {
        let cells = ROBOTS.map(|robot| counts[&(set.clone(), robot)].as_str());
        let set = match set.as_str() {
            "all" => "all passes".to_string(),
            "none" => "no pass".to_string(),
            without => format!("without `{}`", &without["no ".len()..]),
        };
        let row = format!("| {set} | {} |", cells.join(" | "));
        assert!(documentation.contains(&row), "docs/performance.md lacks the row\n{row}");
    }
}

#[test]
fn the_documentation_states_which_kr5_takes_how_many_operations() {
    let text = |path: &str| read(path).split_whitespace().collect::<Vec<_>>().join(" ");
    let counts = snapshot();
    let [of_peers, shipped] = [ROBOTS[0], ROBOTS[4]]
        .map(|robot| counts[&("all".to_string(), robot)].split(" / ").map(str::to_owned).collect::<Vec<_>>());
    let sentence = format!("(`models/kr5.toml`) it takes {}, {} and {}.", shipped[0], shipped[1], shipped[2]);
    assert!(text("docs/performance.md").contains(&sentence), "docs/performance.md lacks: {sentence}");
    let readme = text("README.md");
    for part in
        [format!("[{} for inverse dynamics](docs", of_peers[0]), format!("| inverse dynamics | {} | 5 |", shipped[0])]
    {
        assert!(readme.contains(&part), "README.md lacks: {part}");
    }
}

#[test]
fn the_readme_tells_of_every_function() {
    let readme = read("README.md");
    let table: Vec<&str> = readme
        .lines()
        .skip_while(|line| *line != "| function | gives |")
        .take_while(|line| line.starts_with('|'))
        .collect();
    for function in Function::ALL {
        let call = format!("`{function}(");
        assert!(table.iter().any(|row| row.contains(&call)), "README.md lacks {function} among the functions");
    }
}

#[test]
fn the_changelog_has_the_operations_of_the_snapshot() {
    let counts = snapshot();
    let [inverse, forward, matrix]: [&str; 3] =
        counts[&("all".to_string(), ROBOTS[0])].split(" / ").collect::<Vec<_>>().try_into().expect("three functions");
    let sentence = format!(
        "KR5 takes {inverse} operations for inverse dynamics, {forward} for forward dynamics and {matrix} for the mass matrix \
         (`models/{}.toml`)",
        ROBOTS[0]
    );
    let changelog = read("CHANGELOG.md").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(changelog.contains(&sentence), "CHANGELOG.md lacks: {sentence}");
}

/// The robots and functions of a study of instructions, with their names in its counts and in the documentation.
fn counted_functions() -> impl Iterator<Item = (String, String)> {
    let robots = [("kr5", "KR5"), ("gripper", "gripper"), ("humanoid30", "tree of 30")];
    robots.into_iter().flat_map(|(robot, called)| {
        [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix]
            .map(|function| (format!("{robot}_{function}"), format!("{called}, {}", function.name().replace('_', " "))))
    })
}

/// From processor and function to the counts of a study; `None` for what is not counted.
fn instructions(study: &str) -> BTreeMap<(String, String), Vec<Option<u32>>> {
    let count = |word: &str| (word != "-").then(|| word.parse().expect("a count"));
    let row = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        ((words[0].to_string(), words[1].to_string()), words[2..].iter().map(|word| count(word)).collect())
    };
    read(&format!("studies/{study}/counts.txt")).lines().filter(|line| !line.starts_with('#')).map(row).collect()
}

const PROCESSORS: [&str; 2] = ["x86-64", "x86-64-v3"];

fn written(count: Option<u32>) -> String {
    count.map_or("not counted".into(), |count| count.to_string())
}

#[test]
fn the_table_of_instructions_is_that_of_the_study() {
    let counts = instructions("instructions");
    let documentation = read("docs/performance.md");
    let mut rows = 0;
    for (function, called) in counted_functions() {
        let count = |processor: &str| counts.get(&(processor.into(), function.clone())).and_then(|of| of[0]);
        let counts = PROCESSORS.map(count);
        rows += counts.iter().flatten().count();
        let row = format!("\n| {called} | {} |\n", counts.map(written).join(" | "));
        assert!(documentation.contains(&row), "docs/performance.md lacks the row{row}");
    }
    assert_eq!(rows, counts.len(), "docs/performance.md has no row for some of the counts");
}

#[test]
fn the_table_of_instructions_in_c_is_that_of_the_studies() {
    let (in_c, in_rust) = (instructions("c"), instructions("instructions"));
    let documentation = read("docs/c.md");
    let mut rows = 0;
    for (function, called) in counted_functions() {
        let cells = PROCESSORS.map(|processor| {
            let key = (processor.to_string(), function.clone());
            let [c, rust] = in_c[&key][..] else { panic!("{function} has not two counts") };
            assert_eq!(
                rust,
                in_rust.get(&key).and_then(|of| of[0]),
                "{key:?}: studies/c/counts.txt has another count of Rust"
            );
            rows += 1;
            let more = c.zip(rust).map(|(c, rust)| (100.0 * (f64::from(c) / f64::from(rust) - 1.0)).round());
            let more = more.map(|more| match more {
                0.0 => " 0 %".into(),
                more => format!(" {}{} %", if more < 0.0 { '−' } else { '+' }, more.abs()),
            });
            format!("{} | {} |{}", written(c), written(rust), more.unwrap_or_default())
        });
        let row = format!("\n| {called} | {} |\n", cells.join(" | "));
        assert!(documentation.contains(&row), "docs/c.md lacks the row{row}");
    }
    assert_eq!(rows, in_c.len(), "docs/c.md has no row for some of the counts");
}
