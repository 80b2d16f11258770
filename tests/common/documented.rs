//! Numbers that documents state, for the tests that repeat the runs which they come from.
#![allow(dead_code, reason = "each test uses a part")]

use std::fs;

/// A file of the repository.
pub fn read(path: &str) -> String {
    fs::read_to_string(format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))).expect("a file of the repository")
}

/// The cells of a row of a table.
fn cells_of(row: &str) -> Vec<String> {
    row.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect()
}

/// The cells of the row of `document` whose first cell is `head`, behind it.
pub fn cells(document: &str, head: &str) -> Vec<String> {
    let text = read(document);
    let row = text.lines().find_map(|line| line.strip_prefix(&format!("| {head} |")));
    cells_of(row.unwrap_or_else(|| panic!("{document} has a row `{head}`")))
}

/// The rows of the table of `document` that begins with `header`.
pub fn table(document: &str, header: &str) -> Vec<Vec<String>> {
    let text = read(document);
    let lines = text.lines().skip_while(|line| !line.starts_with(header)).skip(2);
    let rows: Vec<_> = lines.take_while(|line| line.starts_with('|')).map(cells_of).collect();
    assert!(!rows.is_empty(), "{document} has a table that begins with `{header}`");
    rows
}

/// The numbers in `text`, but for whole ones.
pub fn numbers(text: &str) -> Vec<f64> {
    let words =
        text.split(|c: char| !(c.is_ascii_alphanumeric() || ".-".contains(c))).map(|word| word.trim_end_matches('.'));
    words.filter(|word| word.contains(['.', '-'])).filter_map(|word| word.parse().ok()).collect()
}

/// The numbers in a row of the README, but for whole ones.
pub fn stated(head: &str) -> Vec<f64> {
    numbers(&cells("README.md", head).join(" "))
}

/// Fails unless each stated bound holds and is not stale.
pub fn assert_bounds(what: &str, stated: &[f64], measured: &[f64]) {
    println!("{what}: stated {stated:?}, measured {measured:?}");
    assert_eq!(stated.len(), measured.len(), "{what}: {stated:?}");
    for (stated, measured) in stated.iter().zip(measured) {
        assert!(measured <= stated, "{what}: {measured:e}, and the README states {stated:e}");
        assert!(*stated <= 10.0 * measured, "{what}: {measured:e}, and the README's {stated:e} is stale");
    }
}

/// The rows of a file of numbers.
pub fn rows(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(|number| number.parse().expect("a number")).collect()).collect()
}
