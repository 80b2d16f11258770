//! The values of a study, column by column: read, drawn, and combined to samples.

use std::ops::RangeInclusive;

use redysim_toml::words::{nearest, quoted};
use redysim_toml::{DeValue, Field, Key, KeyPath, Message, Reader};
use toml::Value;

use super::draw::Distribution;
use super::keys;
use super::place::Place;

/// The most samples of a study.
pub const MOST: usize = 10_000_000;

/// The values at a path.
pub struct Column {
    pub place: Place,
    pub values: Values,
    /// Where it stands in the file.
    pub span: std::ops::Range<usize>,
}

/// The values of a column.
pub enum Values {
    Listed(Vec<Value>),
    Drawn(Distribution),
}

type Toml<'a> = redysim_toml::Value<'a>;

/// Reads the table `key`, whose keys are paths but for the names of `others`, with all tables that are no values; `leaf`
/// reads those that are.
pub fn read(
    reader: &mut Reader<'_, '_>,
    key: &Key,
    others: &[Key],
    leaf: (&'static redysim_toml::Keys, Leaf),
) -> Field<Vec<Column>> {
    reader.field(key, |reader, path, value| {
        let DeValue::Table(table) = value.get_ref() else { return reader.wrong_type(path, value, "a table of paths") };
        let mut columns = Vec::new();
        let is_path = |name: &str| others.iter().all(|other| other.name != name);
        for (name, value) in table.iter().filter(|(name, _)| is_path(name.get_ref())) {
            within(reader, path, (name.get_ref(), name.span(), value), (None, &leaf), &mut columns);
        }
        columns.sort_by_key(|column| column.span.start);
        for (k, column) in columns.iter().enumerate() {
            if let Some(before) = columns[..k].iter().find(|before| before.place.overlaps(&column.place)) {
                let message = Message {
                    title: format!(
                        "{}: `{}` is a part of `{}`, or the same",
                        reader.item(),
                        column.place,
                        before.place
                    ),
                    label: "varied twice".into(),
                    help: "vary each value once".into(),
                };
                return reader.error_at(column.span.clone(), message);
            }
        }
        Some(columns)
    })
}

/// Reads a table that stands for values.
type Leaf = fn(&mut Reader<'_, '_>) -> Option<Values>;

fn within(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    (name, span, value): (&str, std::ops::Range<usize>, &Toml<'_>),
    (outer, leaf): (Option<&Place>, &(&'static redysim_toml::Keys, Leaf)),
    columns: &mut Vec<Column>,
) {
    let path = path.entry(name);
    // Keys with a dot in quotes are paths; others are parts, which TOML has taken apart.
    let place = match (Place::parse(name), outer) {
        (Ok(place), Some(outer)) => outer.then(&place),
        (Ok(place), None) => place,
        (Err(_), _) => {
            let message = Message {
                title: format!("{}: {} is not a path", reader.item(), quoted(name)),
                label: "not a path".into(),
                help: "paths are written as dotted keys, as in \"model.link.crank.mass\"".into(),
            };
            reader.error_at::<()>(span, message);
            return;
        }
    };
    let values = match value.get_ref() {
        DeValue::Table(table) => {
            let is_key = |name: &str| leaf.0.names().any(|key| key == name);
            // Values at paths are arrays, and tables of them; those of a distribution are arrays, too.
            let is_of_leaf = |name: &str, value: &Toml<'_>| match value.get_ref() {
                DeValue::Table(_) => false,
                DeValue::Array(_) => is_key(keys::NORMAL.name) && is_distribution(name),
                _ => is_key(name),
            };
            let is_leaf = table.iter().any(|(name, value)| is_of_leaf(name.get_ref(), value));
            if !is_leaf {
                for (name, value) in table.iter() {
                    within(reader, &path, (name.get_ref(), name.span(), value), (Some(&place), leaf), columns);
                }
                return;
            }
            reader.table_at(&path, value, leaf.0).and_then(|mut reader| leaf.1(&mut reader))
        }
        DeValue::Array(array) if array.is_empty() => {
            let message = Message {
                title: format!("{}: `{path}` is empty", reader.item()),
                label: "no values".into(),
                help: "give at least one value, or leave it out".into(),
            };
            reader.error(value, message)
        }
        DeValue::Array(array) => {
            let each = array.iter().enumerate().map(|(k, value)| to_toml(reader, &path.element(k), value));
            let values: Option<Vec<Value>> = each.collect::<Vec<_>>().into_iter().collect();
            values.and_then(|values| match odd_one(&values) {
                None => Some(Values::Listed(values)),
                Some(k) => {
                    let message = Message {
                        title: format!(
                            "{}: `{}` is {}, but `{}` is {}",
                            reader.item(),
                            path.element(k),
                            form(&values[k]),
                            path.element(0),
                            form(&values[0])
                        ),
                        label: "of another form".into(),
                        help: "all values at a path are of one form".into(),
                    };
                    reader.error(&array[k], message)
                }
            })
        }
        _ => reader.wrong_type(&path, value, "an array of values, or a table that stands for them"),
    };
    columns.extend(values.map(|values| Column { place, values, span }));
}

/// Whether a key is that of a distribution, one of these misspelled, or the name of a distribution that is not supported.
fn is_distribution(name: &str) -> bool {
    const UNSUPPORTED: [&str; 8] =
        ["beta", "exponential", "gauss", "gaussian", "lognormal", "mean", "triangular", "truncated_normal"];
    UNSUPPORTED.contains(&name) || nearest(name, keys::DRAWN.names()).is_some()
}

/// The value as it replaces another one; its numbers are finite.
fn to_toml(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Toml<'_>) -> Option<Value> {
    match value.get_ref() {
        DeValue::String(text) => Some(Value::String(text.to_string())),
        DeValue::Boolean(flag) => Some(Value::Boolean(*flag)),
        DeValue::Integer(_) | DeValue::Float(_) => reader.parse_number(path, value).map(Value::Float),
        DeValue::Array(array) => {
            let each = array.iter().enumerate().map(|(k, value)| to_toml(reader, &path.element(k), value));
            each.collect::<Vec<_>>().into_iter().collect::<Option<Vec<_>>>().map(Value::Array)
        }
        _ => reader.wrong_type(path, value, "a number, a string, true, false, or an array of these"),
    }
}

/// The first value that has not the form of the one before all.
fn odd_one(values: &[Value]) -> Option<usize> {
    values.iter().position(|value| form(value) != form(&values[0]))
}

/// What a value is: scalars, or so many of them.
fn form(value: &Value) -> String {
    match value {
        Value::Array(array) => match array.first() {
            Some(Value::Array(_)) => format!("{} of {}", array.len(), form(&array[0])),
            _ => format!("an array of {}", array.len()),
        },
        _ => "a single value".to_owned(),
    }
}

/// Values at equal distances.
pub fn steps(reader: &mut Reader<'_, '_>) -> Option<Values> {
    let from = reader.required(&keys::FROM, Reader::number);
    let to = reader.required(&keys::TO, Reader::number);
    let count = reader.required(&keys::COUNT, |reader, key| whole(reader, key, 1..=MOST as u64));
    let (from, to, count) = (*from.value()?, *to.value()?, *count.value()? as usize);
    let last = count.saturating_sub(1).max(1) as f64;
    let at = |k: usize| if k + 1 == count && k > 0 { to } else { from + k as f64 * ((to - from) / last) };
    Some(Values::Listed((0..count).map(|k| Value::Float(at(k))).collect()))
}

/// A distribution.
pub fn drawn(reader: &mut Reader<'_, '_>) -> Option<Values> {
    let normal = reader.field(&keys::NORMAL, |reader, path, value| {
        pair(reader, path, value, |_, deviation| deviation >= 0.0, "a standard deviation is not negative")
    });
    let uniform = reader.field(&keys::UNIFORM, |reader, path, value| {
        pair(reader, path, value, |least, largest| least <= largest, "the least value stands before the largest")
    });
    let drawn = match (normal, uniform) {
        (Field::Invalid, _) | (_, Field::Invalid) => return None,
        // All keys of the table are unknown, which the reader reports.
        (Field::Missing, Field::Missing) => return None,
        (Field::Value(normal), Field::Missing) => {
            let [mean, deviation] = *normal.get_ref();
            Distribution::Normal(mean, deviation)
        }
        (Field::Missing, Field::Value(uniform)) => {
            let [least, largest] = *uniform.get_ref();
            Distribution::Uniform(least, largest)
        }
        (Field::Value(_), Field::Value(_)) => {
            let message = Message {
                title: format!("{}: a distribution is `normal` or `uniform`, not both", reader.item()),
                label: "two distributions".into(),
                help: format!("write {} or {}", keys::NORMAL.example(), keys::UNIFORM.example()),
            };
            return reader.error_of_table(message);
        }
    };
    Some(Values::Drawn(drawn))
}

fn pair<'a>(
    reader: &mut Reader<'a, '_>,
    path: &KeyPath,
    value: &'a Toml<'a>,
    holds: fn(f64, f64) -> bool,
    rule: &str,
) -> Option<[f64; 2]> {
    let array = reader.array(path, value, "an array of 2 numbers")?;
    if array.len() != 2 {
        return reader.wrong_length(path, value, "2 numbers", array.len());
    }
    let numbers = reader.elements(path, array, Reader::parse_number)?;
    let (first, second) = (numbers[0], numbers[1]);
    if !holds(first, second) {
        let title = format!("{}: `{path}` is [{first:?}, {second:?}]: {rule}", reader.item());
        let message = Message { title, label: "out of order".into(), help: rule.into() };
        return reader.error(value, message);
    }
    Some([first, second])
}

/// A whole number within a range, whose ends `f64` represents exactly.
pub fn whole(reader: &mut Reader<'_, '_>, key: &Key, range: RangeInclusive<u64>) -> Field<u64> {
    reader.field(key, |reader, path, value| {
        let number = reader.parse_number(path, value)?;
        let (least, most) = (*range.start() as f64, *range.end() as f64);
        if number.fract() == 0.0 && (least..=most).contains(&number) {
            return Some(number as u64);
        }
        let title =
            format!("{}: `{path}` is {number:?}, but must be a whole number from {least} to {most}", reader.item());
        let message = Message { title, label: "not such a number".into(), help: format!("write {}", key.example()) };
        reader.error(value, message)
    })
}
