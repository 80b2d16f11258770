//! The operation counts that `docs/performance.md` tells are those that the tests hold.

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
