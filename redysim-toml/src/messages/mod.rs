//! The messages about a file as text: syntax, keys, types, numbers. One function is one message.
//!
//! The title names the item, the rule and the value found; the label repeats the rule in a few words beside the caret;
//! the help has the remedy. `item` is "link `arm`" or "the scenario".

pub(crate) mod syntax;

use std::ops::RangeInclusive;

use crate::diagnostic::Message;
use crate::key::{KeyPath, Keys};
use crate::value::MOST_ANGLE;
use crate::words::{did_you_mean, nearest, quoted};

fn message(title: String, label: impl Into<String>, help: impl Into<String>) -> Message {
    Message::new(title, label, help)
}

/// The number or angle under `path` is the string `found`; `written` is the value with a decimal point.
pub(crate) fn decimal_comma(item: &str, path: &KeyPath, found: &str, written: &str) -> Message {
    message(
        format!("{item}: `{path}` is \"{found}\", which has a decimal comma"),
        "a decimal comma",
        format!("TOML writes decimals with a point: {written}"),
    )
}

pub(crate) fn more_is_not_toml() -> Message {
    message("TOML: more lines are invalid".into(), "and below", "is this the right file?")
}

pub(crate) fn xml() -> Message {
    message(
        "this is XML, not TOML".into(),
        "TOML does not begin like this",
        "convert a URDF to a model file with `redysim import`",
    )
}

pub(crate) fn csv() -> Message {
    message(
        "this is a table (CSV), not TOML".into(),
        "TOML does not begin like this",
        "a scenario names a table, as in file = \"motion.csv\"; name the file in TOML here",
    )
}

/// A table with the keys `keys` has another one; `meant` is the one that was probably meant, and `help` is what else is
/// known about the name, or empty.
pub(crate) fn unknown_key(item: &str, path: &str, meant: Option<&str>, help: &str, keys: &Keys) -> Message {
    let names: Vec<_> = keys.names().collect();
    let all = format!("{} has: {}", keys.owner, names.join(", "));
    let help = format!("{}{}", did_you_mean(meant), if help.is_empty() { &all } else { help });
    message(format!("{item}: unknown key {}", quoted(path)), "unknown key", help)
}

pub(crate) fn missing_key(item: &str, path: &KeyPath) -> Message {
    message(format!("{item}: `{path}` is missing"), format!("`{path}` is missing"), path.example())
}

/// `wanted` and `found` are nouns with their article.
pub(crate) fn wrong_type(item: &str, path: &KeyPath, wanted: &str, found: &str) -> Message {
    let help = match (wanted, found.starts_with("the string")) {
        ("a number", true) => format!("{}, without quotes: only angles may have a unit", path.example()),
        _ => path.example(),
    };
    message(format!("{item}: `{path}` must be {wanted}, found {found}"), format!("not {wanted}"), help)
}

/// `written` is the array with decimal points, if it then has the right length.
pub(crate) fn wrong_length(item: &str, path: &KeyPath, wanted: &str, found: usize, written: Option<&str>) -> Message {
    message(
        format!("{item}: `{path}` must have {wanted}, found {found}"),
        format!("{found} instead of {wanted}"),
        match written {
            Some(written) => format!("TOML writes decimals with a point: {written}"),
            None => path.example(),
        },
    )
}

pub(crate) fn not_finite(item: &str, path: &KeyPath, found: &str) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is not a finite number", quoted(found)),
        "not a finite number",
        path.example(),
    )
}

/// `nearest` is the float next to the integer.
pub(crate) fn integer_out_of_range(item: &str, path: &KeyPath, found: &str, nearest: Option<f64>) -> Message {
    message(
        format!("{item}: `{path}` is the integer {}, and integers in TOML have 64 bits", quoted(found)),
        "not from -2^63 to 2^63 - 1",
        match nearest {
            Some(nearest) => format!("write a larger number with an exponent, as in {nearest:e}"),
            None => "write a larger number with an exponent, as in 1e20".into(),
        },
    )
}

pub(crate) fn not_positive(item: &str, path: &KeyPath, found: f64) -> Message {
    let title = format!("{item}: `{path}` is {found:?}, which is not above zero");
    message(title, "not above zero", path.example())
}

pub(crate) fn out_of_range(item: &str, path: &KeyPath, found: &str, allowed: &RangeInclusive<f64>) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is out of range", quoted(found)),
        "too large or too small",
        format!("a number is 0 or from {:e} to {:e} in size", allowed.start(), allowed.end()),
    )
}

pub(crate) fn not_an_angle(item: &str, path: &KeyPath, found: &str) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is not a number with a unit", quoted(found)),
        "not an angle",
        "write a number and a unit, as in \"90 deg\" or \"1.5 rad\", or a plain number of radians",
    )
}

pub(crate) fn bad_unit(item: &str, path: &KeyPath, found: &str, unit: &str, per: &str) -> Message {
    let (title, label) = match unit {
        "" => (format!("{item}: `{path}` is \"{found}\", which has no unit"), "no unit".into()),
        _ => (
            format!("{item}: `{path}` has the unit {}, which is not an angle's", quoted(unit)),
            format!("{} is not a unit of angle", quoted(unit)),
        ),
    };
    let help =
        format!("the units of angle are deg{per} and rad{per}, as in \"90 deg{per}\"; a plain number is in rad{per}");
    message(title, label, help)
}

pub(crate) fn unknown_choice(item: &str, path: &KeyPath, found: &str, choices: &[&str]) -> Message {
    let meant = did_you_mean(nearest(found, choices.iter().copied()));
    let help = format!("{meant}It must be one of: {}", choices.join(", "));
    message(format!("{item}: `{path}` cannot be {}", quoted(found)), "not one of the kinds", help)
}

/// `kinds` are the names, each with the usual name if it is another.
pub(crate) fn unknown_kind(item: &str, path: &KeyPath, found: &str, kinds: &[(&str, Option<&str>)]) -> Message {
    let is_number = |name: &str| name.parse::<i64>().is_ok();
    let usual: Vec<_> = kinds.iter().filter(|(_, same_as)| same_as.is_none()).map(|(name, _)| *name).collect();
    let others = kinds.iter().filter_map(|(name, same_as)| Some((name, (*same_as)?)));
    // One number is as near to another as any: all are listed with what they stand for.
    let (others, meant) = match is_number(found) {
        true => (others.filter(|(name, _)| is_number(name)).collect::<Vec<_>>(), String::new()),
        false => (others.collect(), did_you_mean(nearest(found, kinds.iter().map(|(name, _)| *name)))),
    };
    let others: Vec<_> = others.iter().map(|(name, same_as)| format!("{name} ({same_as})")).collect();
    let others = if others.is_empty() { String::new() } else { format!("; or {}", others.join(", ")) };
    let help = format!("{meant}It must be one of: {}{others}", usual.join(", "));
    message(format!("{item}: `{path}` cannot be {}", quoted(found)), "not one of the kinds", help)
}

/// The kind is not named; the default has no `key`, but those in `having` do.
pub(crate) fn kind_missing(item: &str, path: &KeyPath, default: &str, key: &str, having: &[&str]) -> Message {
    message(
        format!("{item}: `{path}` is missing, and the default, {default}, has no {}", quoted(key)),
        "a key of another kind",
        format!("add `{path}`, which is one of: {}", having.join(", ")),
    )
}

pub(crate) fn unknown_name(item: &str, what: &str, found: &str, names: &[&str]) -> Message {
    let meant = did_you_mean(nearest(found, names.iter().copied()));
    let help = format!("{meant}The {what}s are: {}", names.join(", "));
    message(format!("{item}: unknown {what} {}", quoted(found)), format!("unknown {what}"), help)
}

pub(crate) fn large_angle(item: &str, path: &KeyPath, radians: f64) -> Message {
    // A larger angle is invalid in a scenario, whether in radians or in degrees.
    let help = if radians.abs() <= MOST_ANGLE {
        format!("if degrees are meant, write \"{radians:?} deg\"; otherwise \"{radians:?} rad\" ends this warning")
    } else {
        "leave whole turns out".into()
    };
    message(format!("{item}: `{path}` is {radians:?} rad, more than a whole turn"), "more than a whole turn", help)
}

pub(crate) fn nearly_quarter_turn(item: &str, path: &KeyPath, radians: f64, degrees: f64) -> Message {
    message(
        format!("{item}: `{path}` is {radians:?} rad, nearly but not exactly {degrees} deg"),
        format!("nearly {degrees} deg"),
        format!(
            "write \"{degrees} deg\": it is exact, and its zeros leave the generated code; \"{radians:?} rad\" ends \
             this warning"
        ),
    )
}
