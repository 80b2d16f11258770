//! What is too slow for a debug build runs in `.ci/run`, in release, or compiled for the processor at hand: nothing is left
//! out.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::documented::read;

/// The Rust files in a folder and those in it.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let found = entries.flat_map(|path| match path.is_dir() {
        true => sources(&path),
        false => vec![path],
    });
    found.filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// The sources of tests of all packages, each with the name of its program: that of the file or folder in `tests`.
fn tests() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let packages = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().path().join("tests"));
    let folders = packages.filter(|tests| tests.is_dir()).chain([root.join("tests")]);
    folders
        .flat_map(|tests| sources(&tests).into_iter().map(move |path| (tests.clone(), path)))
        .map(|(tests, path)| {
            let program = path.strip_prefix(&tests).unwrap().components().next().unwrap();
            let program = Path::new(&program).file_stem().unwrap().to_str().unwrap().to_owned();
            (program, fs::read_to_string(path).unwrap())
        })
        .collect()
}

#[test]
fn what_a_debug_build_leaves_out_runs_in_release_or_natively() {
    let script = read(".ci/run").replace("\\\n", " ");
    let command = |start: &str, end: &str| {
        let found = script.lines().find_map(|line| line.split_once(start)?.1.strip_suffix(end));
        found.unwrap_or_else(|| panic!("`{start} ..{end}`, with all tests of its programs")).split_whitespace()
    };
    let release: Vec<&str> = command("cargo test --release --workspace ", "").collect();
    assert!(!release.contains(&"--"), "all tests of a program: {release:?}");
    // The cases of `compile_fail` require a feature.
    assert!(release.contains(&"--all-features"), "all features: {release:?}");
    // Unit tests of the crates with `test = false`.
    let unit_tests = "step cargo test --workspace --all-features --lib";
    assert!(script.lines().any(|line| line == unit_tests), "`{unit_tests}`");
    let words: Vec<&str> =
        release.into_iter().chain(command("native cargo test ", " -- --ignored c:: --skip deterministic::")).collect();
    let run: BTreeSet<&str> = words.windows(2).filter(|pair| pair[0] == "--test").map(|pair| pair[1]).collect();

    let condition = ["debug", "assertions"].join("_");
    let tests = tests();
    let needed: BTreeSet<&str> =
        tests.iter().filter(|(_, text)| text.contains(&condition)).map(|(program, _)| program.as_str()).collect();
    assert_eq!(
        needed, run,
        "programs whose tests depend on {condition}, and those that .ci/run runs in release or natively"
    );
}

#[test]
fn a_test_is_ignored_in_debug_builds_alone_or_since_it_needs_a_browser() {
    let attribute = ["#[", "ignore"].concat();
    let by_browser = [&attribute, " = \"needs node and Chromium: run redysim-cli/viewer/check\"]"].concat();
    let (mut count, tests) = (0, tests());
    for line in tests.iter().flat_map(|(_, text)| text.lines()).filter(|line| line.trim().starts_with(&attribute)) {
        assert_eq!(line.trim(), by_browser);
        count += 1;
    }
    assert!(count > 0);
}
