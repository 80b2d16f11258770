//! What the index of the documentation shows of each item.

use std::fs;
use std::path::{Path, PathBuf};

/// The source files in a folder and those within.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let files = |path: PathBuf| if path.is_dir() { sources(&path) } else { vec![path] };
    entries.flat_map(files).filter(|path| path.extension().is_some_and(|extension| extension == "rs")).collect()
}

/// The first paragraph of the documentation of each public item in a text, with the item's line.
fn first_paragraphs(text: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut lines = text.lines().peekable();
    while let Some(line) = lines.next() {
        let Some(first) = line.strip_prefix("///") else { continue };
        let mut documentation = vec![first.trim()];
        while let Some(more) = lines.peek().and_then(|line| line.strip_prefix("///")) {
            documentation.push(more.trim());
            lines.next();
        }
        let is_attribute = |line: &&str| line.starts_with(['#', ' ', ')']);
        while lines.next_if(is_attribute).is_some() {}
        let paragraph: Vec<_> = documentation.into_iter().take_while(|line| !line.is_empty()).collect();
        found.extend(
            lines.peek().filter(|item| item.starts_with("pub ")).map(|item| (paragraph.join(" "), item.to_string())),
        );
    }
    found
}

/// The index has the first paragraph of an item alone: what goes on in the next one, as with a formula, is cut there.
#[test]
fn the_first_paragraph_of_each_public_item_ends_with_its_sentence() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut seen = 0;
    let crates = ["", "cli", "codegen", "figures", "macros", "model", "runtime", "toml"];
    let folders = crates.map(|name| if name.is_empty() { "src".into() } else { format!("redysim-{name}/src") });
    for path in folders.iter().flat_map(|folder| sources(&root.join(folder))) {
        for (paragraph, item) in first_paragraphs(&fs::read_to_string(&path).unwrap()) {
            assert!(paragraph.ends_with('.'), "{}: {item}: {paragraph}", path.display());
            seen += 1;
        }
    }
    assert!(seen > 900, "{seen}");
}
