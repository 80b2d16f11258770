//! Input that is refused.

use std::panic::Location;
use std::path::Path;

use super::{fail, names, scenario, scratch};

/// Runs a scenario of two links that must fail with `code`, print every one of `words`, and leave nothing.
/// Its folder is named for the file of the test.
#[track_caller]
pub fn refuses(name: &str, command: &str, rest: &str, code: i32, words: &[&str]) {
    let file = Path::new(Location::caller().file()).file_stem().unwrap().display();
    let folder = scratch(&format!("{file}-{name}"));
    refuses_in(&folder, command, &scenario(&folder, "two_link.toml", rest), code, words);
}

pub fn refuses_in(folder: &Path, command: &str, path: &str, code: i32, words: &[&str]) {
    let before = names(folder);
    let output = fail(folder, &[command, path], code);
    println!("{output}\n");
    for word in words {
        assert!(output.contains(word), "no `{word}` in: {output}");
    }
    assert_eq!(output.lines().filter(|line| line.starts_with("error")).count(), 1, "one message: {output}");
    assert_eq!(names(folder), before, "nothing is left");
}
