//! Paths into a scenario and its model, and values at them.

use std::fmt;

use redysim_toml::words::{did_you_mean, nearest, quoted, shortened};
use toml::{Table, Value};

use crate::failure::Failure;

/// The first part of paths that lead into the model.
const MODEL: &str = "model";

/// A path such as `forward.torque.kp`, `initial.q.0`, `model.link.crank.mass`. A part is a key, the number of an element
/// of an array, counted from 0, or the name of one of several tables. A part that is not a plain key is in quotes.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    parts: Vec<String>,
}

impl Place {
    /// Reads a path as TOML writes dotted keys.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Place, String> {
        let keys = toml_edit::Key::parse(text).map_err(|_| format!("{} is not a path", quoted(text)))?;
        Ok(Place { parts: keys.iter().map(|key| key.get().to_owned()).collect() })
    }

    /// The path with more parts at its end.
    pub fn then(&self, more: &Place) -> Place {
        Place { parts: [&self.parts[..], &more.parts].concat() }
    }

    /// Whether it leads into the model; the model itself is a part of the scenario.
    pub fn is_in_model(&self) -> bool {
        self.parts.len() > 1 && self.parts[0] == MODEL
    }

    /// Its first part.
    pub fn first(&self) -> &str {
        self.parts.first().map_or("", String::as_str)
    }

    /// Its last part.
    pub fn last(&self) -> &str {
        self.parts.last().map_or("", String::as_str)
    }

    /// Whether one leads to a part of what the other leads to.
    pub fn overlaps(&self, other: &Place) -> bool {
        self.parts.iter().zip(&other.parts).all(|(one, other)| one == other)
    }

    /// Sets the value at this path. Missing tables are created; missing elements of arrays are an error.
    ///
    /// # Errors
    /// If the path does not exist and cannot be created.
    pub fn set(&self, table: &mut Table, value: &Value) -> Result<(), Failure> {
        let skipped = usize::from(self.is_in_model());
        let fault = |(wrong, help): (String, String)| Failure::input(format!("`{self}`: {wrong}")).help(help);
        set_in_table(table, &self.parts[skipped..], value, &self.parts[..skipped]).map_err(fault)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&joined(&self.parts))
    }
}

fn joined(parts: &[String]) -> String {
    let written = parts.iter().map(|part| toml_edit::Key::new(part.as_str()).display_repr().into_owned());
    written.collect::<Vec<_>>().join(".")
}

/// What is wrong, and what to do.
type Fault = (String, String);

fn set_in_table(table: &mut Table, parts: &[String], value: &Value, before: &[String]) -> Result<(), Fault> {
    let Some((part, rest)) = parts.split_first() else { return Ok(()) };
    let before = [before, std::slice::from_ref(part)].concat();
    if rest.is_empty() {
        table.insert(part.clone(), value.clone());
        return Ok(());
    }
    if !table.contains_key(part) && rest[0].parse::<usize>().is_ok() {
        let here = joined(&before);
        let wrong = format!("there is no `{here}` with elements");
        return Err((wrong, format!("write {} in the file, or give values of all of `{here}`", quoted(part))));
    }
    set_in(table.entry(part.clone()).or_insert_with(|| Value::Table(Table::new())), rest, value, &before)
}

/// Puts `value` at the `parts`, of which there are some, of what is at `before`.
fn set_in(at: &mut Value, parts: &[String], value: &Value, before: &[String]) -> Result<(), Fault> {
    let here = joined(before);
    match at {
        Value::Table(table) => set_in_table(table, parts, value, before),
        Value::Array(array) => {
            let (part, rest) = (&parts[0], &parts[1..]);
            let count = array.len();
            let index = position(array, part, &here)?;
            let Some(element) = array.get_mut(index) else {
                let wrong = format!("`{here}` has {count} elements, which are counted from 0");
                return Err((wrong, format!("take one of 0 to {}", count.saturating_sub(1))));
            };
            if rest.is_empty() {
                *element = value.clone();
                return Ok(());
            }
            set_in(element, rest, value, &[before, std::slice::from_ref(part)].concat())
        }
        other => {
            let wrong = format!("`{here}` is {other}, which has no parts");
            Err((wrong, format!("write `{here}` as a table or an array in the file, or give values of `{here}`")))
        }
    }
}

/// The element of an array that `part` is the number or the name of.
fn position(array: &[Value], part: &str, here: &str) -> Result<usize, Fault> {
    let names: Vec<&str> = array.iter().filter_map(|element| element.get("name")?.as_str()).collect();
    let named = array.iter().position(|element| element.get("name").and_then(Value::as_str) == Some(part));
    if let Some(index) = named.or_else(|| part.parse().ok()) {
        return Ok(index);
    }
    if names.is_empty() {
        let wrong = format!("`{here}` is an array, whose elements have no names such as {}", quoted(part));
        return Err((wrong, format!("count its elements from 0, as in `{here}.0`")));
    }
    let guess = did_you_mean(nearest(part, names.iter().copied()));
    Err((
        format!("`{here}` has nothing of the name {}", quoted(part)),
        format!("{guess}there are {}", shortened(&names)),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str =
        "initial = { q = [0, 1] }\nforward.torque = 'pd'\n[[link]]\nname = 'a.b'\ncom = [0.0, 1.0, 2.0]\n";

    fn set(path: &str, value: impl Into<Value>) -> Result<Table, String> {
        let mut table: Table = TEXT.parse().unwrap();
        let place = Place::parse(path)?;
        let set = place.set(&mut table, &value.into());
        set.map(|()| table).map_err(|failure| failure.to_string())
    }

    #[test]
    fn a_value_is_set_at_its_path_and_nowhere_else() {
        let expected = |from: &str, to: &str| TEXT.replace(from, to).parse::<Table>().unwrap();
        assert_eq!(set("initial.q.1", 2.5).unwrap(), expected("[0, 1]", "[0, 2.5]"));
        assert_eq!(set("initial.q", vec![3.0, 4.0]).unwrap(), expected("[0, 1]", "[3.0, 4.0]"));
        assert_eq!(set("initial.v.a", 2.0).unwrap(), expected("[0, 1]", "[0, 1], v = { a = 2.0 }"));
        assert_eq!(set("model.link.\"a.b\".com.2", 7.0).unwrap(), expected("2.0", "7.0"));
        assert_eq!(set("model.link.0.com.2", 7.0).unwrap(), expected("2.0", "7.0"));
        assert_eq!(set("model", "other.toml").unwrap()["model"].as_str(), Some("other.toml"));
    }

    #[test]
    fn a_place_that_is_not_there_is_reported_with_what_is() {
        for (path, wrong, help) in [
            ("initial.q.2", "`initial.q.2`: `initial.q` has 2 elements", "0 to 1"),
            ("initial.q.arm", "`initial.q` is an array, whose elements have no names such as `arm`", "`initial.q.0`"),
            ("initial.v.0", "there is no `initial.v` with elements", "give values of all of `initial.v`"),
            ("forward.torque.kp", "`forward.torque` is \"pd\", which has no parts", "as a table"),
            ("model.link.a_b.mass", "`model.link` has nothing of the name `a_b`", "did you mean `a.b`? there are a.b"),
            ("a..b", "`a..b` is not a path", ""),
        ] {
            let failure = set(path, 1.0).unwrap_err();
            assert!(failure.contains(wrong) && failure.contains(help), "{path}: {failure}");
        }
    }

    #[test]
    fn paths_are_written_as_they_are_read() {
        for path in ["initial.q.0", "model.link.\"a.b\".mass", "model.loop.crank-coupler.point_a.1"] {
            assert_eq!(Place::parse(path).unwrap().to_string(), path);
        }
    }
}
