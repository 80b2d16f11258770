//! Whatever is done to a file, reading it ends in a model or in errors with places in it, never in a panic.

use proptest::prelude::*;
use proptest::sample::Index;
use redysim_model::{Diagnostic, Model};

const FILES: [&str; 3] = [
    include_str!("../../../models/kr5.toml"),
    include_str!("../../../models/gripper.toml"),
    include_str!("../../../models/fail/many_faults.toml"),
];

/// Pieces that mean something in a model file.
const PIECES: [&str; 24] = [
    "[[link]]",
    "[link]",
    "[[loop]]",
    "=",
    "\"",
    "{",
    "}",
    "[",
    "]",
    "\n",
    "\r",
    "nan",
    "-1e999",
    "0x1F",
    "\"base\"",
    "name = \"link1\"",
    "parent = \"link6\"",
    "joint = \"fixed\"",
    "axis = [0, 0, 0]",
    "ß°\u{0}",
    "functions = [\"energy\"]",
    "locked = { link1 = 0.1 }",
    "tolerance = 1e-3",
    "range = { position = [0, 1], velocity = 1, acceleration = 1 }",
];

#[derive(Clone, Debug)]
enum Mutation {
    DeleteLine(Index),
    DuplicateLine(Index, Index),
    DeleteCharacters(Index, usize),
    InsertPiece(Index, Index),
    ReplaceCharacter(Index, char),
    Truncate(Index),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let index = any::<Index>;
    prop_oneof![
        index().prop_map(Mutation::DeleteLine),
        (index(), index()).prop_map(|(from, to)| Mutation::DuplicateLine(from, to)),
        (index(), 1..20_usize).prop_map(|(at, count)| Mutation::DeleteCharacters(at, count)),
        (index(), index()).prop_map(|(at, piece)| Mutation::InsertPiece(at, piece)),
        (index(), any::<char>()).prop_map(|(at, character)| Mutation::ReplaceCharacter(at, character)),
        index().prop_map(Mutation::Truncate),
    ]
}

fn mutated(text: &str, mutation: &Mutation) -> String {
    let mut lines: Vec<_> = text.split_inclusive('\n').collect();
    let mut characters: Vec<_> = text.chars().collect();
    match mutation {
        _ if text.is_empty() => return String::new(),
        Mutation::DeleteLine(at) => _ = lines.remove(at.index(lines.len())),
        Mutation::DuplicateLine(from, to) => lines.insert(to.index(lines.len()), lines[from.index(lines.len())]),
        Mutation::DeleteCharacters(at, count) => {
            let start = at.index(characters.len());
            characters.drain(start..(start + count).min(characters.len()));
            return characters.into_iter().collect();
        }
        Mutation::InsertPiece(at, piece) => {
            let at = at.index(characters.len());
            let (before, after) = characters.split_at(at);
            return before
                .iter()
                .copied()
                .chain(PIECES[piece.index(PIECES.len())].chars())
                .chain(after.iter().copied())
                .collect();
        }
        Mutation::ReplaceCharacter(at, character) => {
            let at = at.index(characters.len());
            characters[at] = *character;
            return characters.into_iter().collect();
        }
        Mutation::Truncate(at) => {
            characters.truncate(at.index(characters.len()));
            return characters.into_iter().collect();
        }
    }
    lines.concat()
}

fn stands_in(diagnostic: &Diagnostic, text: &str) {
    let (line, column) = diagnostic.position().expect("a text has places");
    let lines: Vec<_> = text.split('\n').collect();
    assert!((1..=lines.len()).contains(&line), "line {line} of {}", lines.len());
    assert!((1..=lines[line - 1].chars().count() + 1).contains(&column), "column {column} of {:?}", lines[line - 1]);
    let shown = diagnostic.to_string();
    assert!(shown.contains('^') && shown.contains(&format!("test.toml:{line}:{column}")), "{shown}");
}

fn check(text: &str) {
    match Model::from_toml(text, "test.toml") {
        Ok(loaded) => loaded.warnings.iter().for_each(|warning| stands_in(warning, text)),
        Err(faults) => {
            assert!(faults.errors().count() > 0);
            faults.diagnostics.iter().for_each(|diagnostic| stands_in(diagnostic, text));
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(2000) })]

    #[test]
    fn mutated_files_never_panic(file in 0..FILES.len(), mutations in prop::collection::vec(mutation(), 1..6)) {
        check(&mutations.iter().fold(FILES[file].to_owned(), |text, mutation| mutated(&text, mutation)));
    }

    /// Options are read beside a good file.
    #[test]
    fn mutated_options_never_panic(mutations in prop::collection::vec(mutation(), 1..4)) {
        let options = "functions = ['mass_matrix', \"energy\"]\nlocked = { joint6 = \"30 deg\", link2 = 1 }\n\
                       tolerance = 0.01";
        let options = mutations.iter().fold(options.to_owned(), |options, mutation| mutated(&options, mutation));
        if let Err(faults) = Model::from_toml_with(FILES[0], "test.toml", options.as_str()) {
            for span in faults.diagnostics.iter().filter_map(Diagnostic::span_beside) {
                assert!(span.start <= options.len(), "{span:?} in {options}");
            }
        }
    }

    #[test]
    fn arbitrary_texts_never_panic(text in any::<String>()) {
        check(&text);
    }
}
