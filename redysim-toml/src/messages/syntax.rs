//! The messages about text that is not TOML.

use super::message;
use crate::diagnostic::Message;
use crate::words::quoted;

/// The parser's own words.
pub(crate) fn other(reason: &str) -> Message {
    let help = "correct the TOML first; the rest of the file is checked after that";
    message(format!("TOML: {reason}"), reason, help)
}

/// `first_line` is where the key stands before, if that is known.
pub(crate) fn duplicate_key(key: &str, first_line: Option<usize>) -> Message {
    let label = first_line.map_or("twice in a table".into(), |line| format!("also on line {line}"));
    let help = "a key occurs once in a table: delete one of the two, or rename it";
    message(format!("TOML: the key {} occurs twice in one table", quoted(key)), label, help)
}

/// The header `[name]` is on `line`; another header of this name is on the line `other`.
pub(crate) fn single_header(name: &str, line: usize, other: usize) -> Message {
    message(
        format!("TOML: `[{name}]` on line {line} is a second table of this name"),
        format!("`{name}` is also on line {other}"),
        format!("each of several tables has a header in double brackets: write [[{name}]] on line {line}"),
    )
}

/// `close` is what closes the bracket.
pub(crate) fn unclosed_bracket(close: char) -> Message {
    let what = if close == ']' { "array" } else { "table" };
    message(
        format!("TOML: the {what} that begins here has no closing `{close}`"),
        "not closed",
        format!("write `{close}` after its last element; what follows is checked after that"),
    )
}

/// `written` is the value `found` with a decimal point.
pub(crate) fn comma(found: &str, written: &str) -> Message {
    let (has, label) = match found.starts_with('[') {
        true => ("has decimal commas", "decimal commas"),
        false => ("has a decimal comma", "a decimal comma"),
    };
    message(format!("TOML: {} {has}", quoted(found)), label, format!("TOML writes decimals with a point: {written}"))
}

pub(crate) fn unclosed_header(found: &str, whole: &str) -> Message {
    message(format!("TOML: the header {} is not closed", quoted(found)), "not closed", format!("write {whole}"))
}

pub(crate) fn foreign_comment(found: &str, written: &str) -> Message {
    let title = format!("TOML: {} does not begin a comment", quoted(found.get(..2).unwrap_or(found)));
    message(title, "not a comment", format!("a comment begins with #: write {written}"))
}

pub(crate) fn value_without_key(found: &str) -> Message {
    message(format!("TOML: {} has no key", quoted(found)), "no key", "write the name of the key before `=`")
}

pub(crate) fn colon(key: &str, value: &str) -> Message {
    let value = if value.is_empty() { ".." } else { value };
    message(
        format!("TOML: the key {} has a colon", quoted(key)),
        "a colon instead of `=`",
        format!("write {key} = {value}"),
    )
}

pub(crate) fn key_of_words(words: &str, written: &str, value: &str) -> Message {
    message(
        format!("TOML: the key {} has a blank", quoted(words)),
        "more than one word",
        format!("a key is one word, as in {written} = {value}"),
    )
}

pub(crate) fn no_equals(key: &str, value: &str) -> Message {
    let value = if value.is_empty() { ".." } else { value };
    message(
        format!("TOML: no `=` follows the key {}", quoted(key)),
        "no `=`",
        format!("write {key} = {value}, or begin a comment with #"),
    )
}

pub(crate) fn no_value(key: &str) -> Message {
    message(
        format!("TOML: the key {} has no value", quoted(key)),
        "no value",
        "write a value after `=`, or leave the key out",
    )
}

pub(crate) fn unclosed_string(quote: char) -> Message {
    message(
        format!("TOML: the string has no closing `{quote}`"),
        "not closed",
        format!("end it with {quote} on the same line, the quote that it begins with"),
    )
}

pub(crate) fn curly_quotes(found: &str, inside: &str) -> Message {
    message(
        format!("TOML: {} has typographic quotes", quoted(found)),
        "typographic quotes",
        format!("TOML has straight quotes: write \"{inside}\""),
    )
}

pub(crate) fn round_brackets(found: &str, inside: &str) -> Message {
    message(
        format!("TOML: {} has round brackets", quoted(found)),
        "round brackets",
        format!("an array has square brackets: write [{inside}]"),
    )
}

pub(crate) fn separators(found: &str, written: &str) -> Message {
    message(
        format!("TOML: the elements of {} are not separated by commas", quoted(found)),
        "no commas between elements",
        format!("write [{written}]"),
    )
}

/// No comma stands before `key` in a table in braces.
pub(crate) fn missing_comma(key: &str) -> Message {
    message(
        format!("TOML: the comma before {} is missing", quoted(key)),
        "no comma before it",
        "keys in braces are separated by commas, as in { a = 1, b = 2 }",
    )
}

/// The character `found` stands after a value.
pub(crate) fn end_of_line(found: &str) -> Message {
    message(
        format!("TOML: {} follows the value", quoted(found)),
        "not part of the value",
        format!("a key and its value end with the line: delete {}", quoted(found)),
    )
}

pub(crate) fn something_follows(found: &str) -> Message {
    message(
        format!("TOML: {} follows the value", quoted(found)),
        "not part of the value",
        "each key and its value have a line of their own, and a comment begins with #",
    )
}

pub(crate) fn lower_case(found: &str, written: &str) -> Message {
    message(format!("TOML: {} has upper-case letters", quoted(found)), "in lower case", format!("write {written}"))
}

pub(crate) fn nothing(found: &str) -> Message {
    message(
        format!("TOML: {} is not a value", quoted(found)),
        "not a value",
        "leave the key out: its default then holds, if it has one",
    )
}

pub(crate) fn number(found: &str, written: &str) -> Message {
    message(
        format!("TOML: {} is not a number of TOML", quoted(found)),
        "not as TOML writes it",
        format!("a number has a digit on each side of its point, and no zeros in front: write {written}"),
    )
}

pub(crate) fn unit(found: &str, number: &str) -> Message {
    message(
        format!("TOML: {} has a unit", quoted(found)),
        "a unit",
        format!("write {number} alone, in the unit of the key; only angles have units, in quotes, as in \"90 deg\""),
    )
}

pub(crate) fn angle_without_quotes(found: &str, written: &str) -> Message {
    message(
        format!("TOML: the angle {} has no quotes", quoted(found)),
        "no quotes",
        format!("an angle with a unit is a string: write {written}"),
    )
}

/// `angle` is the value, if it is an angle.
pub(crate) fn expression(found: &str, angle: Option<&str>) -> Message {
    let help = match angle {
        Some(angle) => format!("write the number, or of an angle {angle}"),
        None => "write the number that it results in".into(),
    };
    message(format!("TOML: {} is a formula, not a number", quoted(found)), "a formula", help)
}

pub(crate) fn no_quotes(found: &str) -> Message {
    message(format!("TOML: the string {} has no quotes", quoted(found)), "no quotes", format!("write \"{found}\""))
}
