//! Names of crates.

use std::path::Path;

use crate::failure::Failure;
use redysim_toml::words::quoted;

/// What Cargo refuses: Rust's keywords, crates that every program has, folders of its own, and the crate that this one
/// depends on.
const TAKEN: &[&str] = &[
    "Self",
    "abstract",
    "alloc",
    "as",
    "async",
    "await",
    "become",
    "box",
    "break",
    "build",
    "const",
    "continue",
    "core",
    "crate",
    "deps",
    "do",
    "dyn",
    "else",
    "enum",
    "examples",
    "extern",
    "false",
    "final",
    "fn",
    "for",
    "gen",
    "if",
    "impl",
    "in",
    "incremental",
    "let",
    "loop",
    "macro",
    "match",
    "mod",
    "move",
    "mut",
    "override",
    "priv",
    "proc_macro",
    "pub",
    "redysim",
    "ref",
    "return",
    "self",
    "static",
    "std",
    "struct",
    "super",
    "test",
    "trait",
    "true",
    "try",
    "type",
    "typeof",
    "unsafe",
    "unsized",
    "use",
    "virtual",
    "where",
    "while",
    "yield",
];

/// The longest name, which leaves room for what Cargo adds to it in names of files.
const LONGEST: usize = 64;

/// The name of a crate in `folder`.
///
/// # Errors
/// If a crate cannot have that name.
pub fn of(folder: &Path) -> Result<String, Failure> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let Some(why) = why_not(&name) else { return Ok(name.into_owned()) };
    let suggested = folder.with_file_name(suggestion(&name));
    let failure =
        Failure::command_line(format!("a crate cannot be named {}: {why}", quoted(&folder.display().to_string())));
    Err(failure.help(format!("a valid name is {}", quoted(&suggested.display().to_string()))))
}

fn why_not(name: &str) -> Option<&'static str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if name.is_empty() {
        Some("that names no folder of its own")
    } else if TAKEN.contains(&name) {
        Some("Rust or Cargo means something else by it")
    } else if !name.chars().all(is_part) {
        Some("it has characters beside a to z, A to Z, 0 to 9, - and _")
    } else if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        Some("it does not begin with a letter")
    } else if name.len() > LONGEST {
        Some("it is longer than 64 characters")
    } else {
        None
    }
}

/// The nearest name that a crate can have.
fn suggestion(name: &str) -> String {
    let name = plain(name);
    if name.is_empty() {
        "robot".into()
    } else if TAKEN.contains(&name.as_str()) {
        format!("{name}-robot")
    } else if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
        format!("robot-{name}")
    } else {
        name
    }
}

/// `text` in the characters of a name, at most half as many as it may have.
pub fn plain(text: &str) -> String {
    let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '-'));
    let words: Vec<_> = words.map(|word| word.trim_matches(['-', '_'])).filter(|word| !word.is_empty()).collect();
    let joined: String = words.join("-").chars().take(LONGEST / 2).collect();
    joined.trim_end_matches(['-', '_']).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_suggested_name_is_one_that_a_crate_can_have() {
        let long = "a".repeat(99);
        let names =
            ["", "match", "3rrr", "my arm", "größe", "-x-", "..", "🤖", "_", "Self", "a.b", "_match", long.as_str()];
        for name in names.into_iter().chain(TAKEN.iter().copied()) {
            assert!(why_not(name).is_some(), "{name}");
            assert_eq!(why_not(&suggestion(name)), None, "{name}: {}", suggestion(name));
        }
        assert_eq!([suggestion("my arm"), suggestion("3rrr"), suggestion("fn")], ["my-arm", "robot-3rrr", "fn-robot"]);
        assert_eq!(why_not("my_arm-2"), None);
    }
}
