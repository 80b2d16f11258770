//! Reads the keys of one table, reporting what is not as it should be.

use super::value::Value;
use super::{Field, Table};
use crate::diagnostic::messages::{MODEL_FILE, Manual};
use crate::diagnostic::{Findings, Message, messages};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys that a kind of table may have.
#[derive(Debug)]
pub struct Shape {
    /// What has the keys, with its article.
    pub owner: &'static str,
    /// The keys.
    pub keys: &'static [&'static str],
}

/// One table, and whose it is.
///
/// What it reads is a [`Field`]; what is not as it should be is reported with its place. Keys are called by their
/// `path` in messages: `dh.a` is `a` in the table `dh`, `com[1]` an element of `com`.
pub struct Reader<'a, 'f> {
    table: &'a DeTable<'a>,
    /// A place for what the table lacks.
    place: Range<usize>,
    /// What messages call the item that the table describes.
    item: &'f str,
    /// Valid keys that unknown ones were probably meant to be: their absence is no second fault.
    misspelt: Vec<&'static str>,
    /// Stands before a key in messages: empty, or `dh.` in the table `dh`.
    prefix: String,
    pub(super) manual: &'static Manual,
    findings: &'f mut Findings,
}

impl<'a, 'f> Reader<'a, 'f> {
    /// Opens a table and reports its unknown keys.
    pub(super) fn new(
        table: &'a DeTable<'a>,
        place: Range<usize>,
        item: &'f str,
        shape: &Shape,
        findings: &'f mut Findings,
    ) -> Self {
        Self::of_file(&MODEL_FILE, table, place, item, findings).without_unknown_keys(shape)
    }

    /// Opens a table again of which the unknown keys are reported already.
    pub(super) fn known(table: &'a DeTable<'a>, item: &'f str, findings: &'f mut Findings) -> Self {
        Self::of_file(&MODEL_FILE, table, 0..0, item, findings)
    }

    /// Opens a table of any kind of file. Unknown keys are not looked for.
    pub(crate) fn of_file(
        manual: &'static Manual,
        table: &'a DeTable<'a>,
        place: Range<usize>,
        item: &'f str,
        findings: &'f mut Findings,
    ) -> Self {
        Self { table, place, item, misspelt: Vec::new(), prefix: String::new(), manual, findings }
    }

    /// What messages call the item that the table describes.
    pub fn item(&self) -> &'f str {
        self.item
    }

    /// Reports the keys that tables of this kind do not have.
    pub(crate) fn without_unknown_keys(mut self, shape: &Shape) -> Self {
        for key in self.table.keys().filter(|key| !shape.keys.contains(&key.get_ref().as_ref())) {
            let absent = shape.keys.iter().copied().filter(|key| !self.table.contains_key(*key));
            let meant = messages::nearest(key.get_ref(), absent);
            let path = self.path(key.get_ref());
            self.findings.error(key.span(), messages::unknown_key(self.item, &path, meant, shape.owner, shape.keys));
            self.misspelt.extend(meant);
        }
        self
    }

    /// What to make of a key that is not there.
    fn absent<T>(&self, key: &str) -> Field<T> {
        if self.misspelt.contains(&key) { Field::Faulty } else { Field::Missing }
    }

    /// Reports a key that must be there and is not.
    pub fn required<T>(&mut self, key: &str, field: Field<T>) -> Field<T> {
        if field.is_missing() {
            self.findings.error(self.place.clone(), messages::missing_key(self.manual, self.item, &self.path(key)));
        }
        field
    }

    /// A text.
    pub fn text(&mut self, key: &str) -> Field<String> {
        self.field(key, |reader, path, value| match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            _ => reader.wrong_type(path, value, "a string"),
        })
    }

    /// True or false.
    pub fn flag(&mut self, key: &str) -> Field<bool> {
        self.field(key, |reader, path, value| match value.get_ref() {
            DeValue::Boolean(flag) => Some(*flag),
            _ => reader.wrong_type(path, value, "true or false"),
        })
    }

    /// A finite number.
    pub fn number(&mut self, key: &str) -> Field<f64> {
        self.field(key, Self::a_number)
    }

    /// In radians.
    pub fn angle(&mut self, key: &str) -> Field<f64> {
        self.field(key, Self::an_angle)
    }

    pub(super) fn vector(&mut self, key: &str) -> Field<[f64; 3]> {
        self.field(key, |reader, path, value| reader.three(path, value, "3 numbers", Self::a_number))
    }

    /// In radians.
    pub(super) fn angles(&mut self, key: &str) -> Field<[f64; 3]> {
        self.field(key, |reader, path, value| reader.three(path, value, "3 angles", Self::an_angle))
    }

    /// A least and a largest coordinate: of a joint that turns, in radians.
    pub(super) fn bounds(&mut self, key: &str, turns: bool) -> Field<[f64; 2]> {
        self.field(key, |reader, path, value| {
            let DeValue::Array(array) = value.get_ref() else {
                return reader.wrong_type(path, value, "an array of 2 numbers");
            };
            let read = array
                .iter()
                .enumerate()
                .map(|(i, value)| reader.displacement(&format!("{path}[{i}]"), value, turns, ""));
            let elements: Vec<_> = read.collect();
            match elements.as_slice() {
                [least, largest] => {
                    let (least, largest) = ((*least)?, (*largest)?);
                    if least > largest {
                        return reader.fault(value, messages::empty_range(reader.item, path, least, largest));
                    }
                    Some([least, largest])
                }
                _ => reader.wrong_length(path, value, "2 numbers", elements.len()),
            }
        })
    }

    /// The largest size of a rate `per` something: of a joint that turns, in radians.
    pub(super) fn largest(&mut self, key: &str, turns: bool, per: &str) -> Field<f64> {
        self.field(key, |reader, path, value| {
            let largest = reader.displacement(path, value, turns, per)?;
            if largest < 0.0 {
                return reader.fault(value, messages::negative_range(reader.item, path, largest));
            }
            Some(largest)
        })
    }

    /// A number above zero.
    pub fn positive(&mut self, key: &str) -> Field<f64> {
        self.field(key, |reader, path, value| {
            let number = reader.a_number(path, value)?;
            if number <= 0.0 {
                return reader.fault(value, messages::not_positive(reader.manual, reader.item, path, number));
            }
            Some(number)
        })
    }

    /// The `found` one of the names in `choices`.
    pub(crate) fn one_of<T: Copy>(
        &mut self,
        path: &str,
        value: &Value<'_>,
        found: &str,
        choices: &[(&str, T)],
    ) -> Option<T> {
        let chosen = choices.iter().find(|(name, _)| *name == found).map(|(_, choice)| *choice);
        chosen.or_else(|| {
            let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
            self.fault(value, messages::unknown_choice(self.item, path, found, &names))
        })
    }

    /// What is called `found` among `named`, things that are each a `what`; `place` is where the name stands.
    pub fn called<T: Copy>(&mut self, place: Range<usize>, what: &str, found: &str, named: &[(&str, T)]) -> Option<T> {
        let there = named.iter().find(|(name, _)| *name == found).map(|(_, thing)| *thing);
        there.or_else(|| {
            let names: Vec<_> = named.iter().map(|(name, _)| *name).collect();
            self.fault_at(place, messages::unknown_name(self.item, what, found, &names))
        })
    }

    /// Reports that an array has `found` elements instead of `wanted`, as "3 numbers". Always `None`.
    pub fn wrong_length<T>(&mut self, path: &str, value: &Value<'_>, wanted: &str, found: usize) -> Option<T> {
        self.fault(value, messages::wrong_length(self.manual, self.item, path, wanted, found))
    }

    /// One of the names in `choices`. Those in `planned` are known, but not supported.
    pub fn choice<T: Copy>(&mut self, key: &str, choices: &[(&str, T)], planned: &[&str]) -> Field<T> {
        self.field(key, |reader, path, value| {
            let Some(text) = name(value) else { return reader.wrong_type(path, value, "a string") };
            if planned.contains(&text) {
                let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
                return reader.fault(value, messages::unsupported_joint(reader.item, text, &names));
            }
            reader.one_of(path, value, text, choices)
        })
    }

    /// Whether there is a table under `key`.
    pub fn has_table(&self, key: &str) -> bool {
        self.table.get(key).is_some_and(|value| matches!(value.get_ref(), DeValue::Table(_)))
    }

    /// A table within this one.
    pub fn table<T>(&mut self, key: &str, shape: &Shape, read: impl FnOnce(Reader<'_, '_>) -> T) -> Field<T> {
        self.field(key, |reader, path, value| Some(read(reader.within(path, value)?.without_unknown_keys(shape))))
    }

    /// A table within this one whose kind, named under the key `tag`, says which keys it has; `usual` is meant where it
    /// names none. A kind is a name with what it stands for. The name alone stands for a table without other keys.
    pub fn table_of_kind<T, K: Copy>(
        &mut self,
        key: &str,
        tag: &str,
        kinds: &[(&str, (K, &Shape))],
        usual: (K, &Shape),
        read: impl FnOnce(Reader<'_, '_>, K) -> T,
    ) -> Field<T> {
        let nothing_else = DeTable::new();
        self.field(key, |reader, path, value| {
            if let Some(text) = name(value) {
                let (kind, _) = reader.one_of(path, value, text, kinds)?;
                return Some(read(reader.inside(path, value, &nothing_else), kind));
            }
            let mut inner = reader.within(path, value)?;
            let (kind, shape) = inner.choice(tag, kinds, &[]).value_or(usual)?;
            Some(read(inner.without_unknown_keys(shape), kind))
        })
    }

    /// A reader of the table that `value` must be.
    fn within<'b>(&'b mut self, path: &str, value: &'b Value<'a>) -> Option<Reader<'b, 'b>> {
        let DeValue::Table(table) = value.get_ref() else {
            return self.wrong_type(path, value, "a table");
        };
        Some(self.inside(path, value, table))
    }

    /// A reader of `table`, for which `value` stands.
    fn inside<'b>(&'b mut self, path: &str, value: &Value<'_>, table: &'b DeTable<'b>) -> Reader<'b, 'b> {
        let (item, manual, prefix) = (self.item, self.manual, format!("{path}."));
        let inner = Reader::of_file(manual, table, value.span(), item, self.findings);
        Reader { prefix, ..inner }
    }

    /// The tables of an array of tables; `None` stands for what is no table, or no array.
    pub(super) fn tables(&mut self, key: &str) -> Option<Vec<Option<Table<'a>>>> {
        let (table, path) = (self.table, self.path(key));
        let Some(value) = table.get(key) else {
            return (!self.misspelt.contains(&key)).then(Vec::new);
        };
        let DeValue::Array(array) = value.get_ref() else {
            return self.wrong_type(&path, value, &format!("an array of tables, each headed `[[{key}]]`"));
        };
        let entry = |entry: &'a Value<'a>| match entry.get_ref() {
            DeValue::Table(table) => Some((table, entry.span())),
            _ => self.wrong_type(&path, entry, &format!("an array of tables, each headed `[[{key}]]`")),
        };
        Some(array.iter().map(entry).collect())
    }

    /// What `read` makes of the value under `key`; faulty if it reports any error.
    pub fn field<T>(&mut self, key: &str, read: impl FnOnce(&mut Self, &str, &'a Value<'a>) -> Option<T>) -> Field<T> {
        let table = self.table;
        let Some(value) = table.get(key) else {
            return self.absent(key);
        };
        let (path, errors_before) = (self.path(key), self.findings.errors());
        match read(self, &path, value) {
            Some(read) if self.findings.errors() == errors_before => Field::Value(Spanned::new(value.span(), read)),
            _ => Field::Faulty,
        }
    }

    fn three(
        &mut self,
        path: &str,
        value: &'a Value<'a>,
        wanted: &str,
        element: impl Fn(&mut Self, &str, &'a Value<'a>) -> Option<f64>,
    ) -> Option<[f64; 3]> {
        let DeValue::Array(array) = value.get_ref() else {
            return self.wrong_type(path, value, &format!("an array of {wanted}"));
        };
        // Every element is read, so that each fault among them is reported.
        let read = array.iter().enumerate().map(|(i, value)| element(self, &format!("{path}[{i}]"), value));
        let elements: Vec<_> = read.collect();
        match elements.as_slice() {
            [x, y, z] => Some([(*x)?, (*y)?, (*z)?]),
            _ => self.wrong_length(path, value, wanted, elements.len()),
        }
    }

    /// Reports a fault of a value. Always `None`.
    pub fn fault<T>(&mut self, value: &Value<'_>, message: Message) -> Option<T> {
        self.fault_at(value.span(), message)
    }

    /// Reports a fault at a place. Always `None`.
    pub fn fault_at<T>(&mut self, place: Range<usize>, message: Message) -> Option<T> {
        self.findings.error(place, message);
        None
    }

    /// Warns of what is at a place.
    pub fn warning(&mut self, place: Range<usize>, message: Message) {
        self.findings.warning(place, message);
    }

    /// Warns of the table as a whole.
    pub fn warning_of_table(&mut self, message: Message) {
        self.warning(self.place.clone(), message);
    }

    /// Reports a fault of the table as a whole. Always `None`.
    pub fn fault_of_table<T>(&mut self, message: Message) -> Option<T> {
        self.fault_at(self.place.clone(), message)
    }

    fn path(&self, key: &str) -> String {
        format!("{}{key}", self.prefix)
    }
}

/// The name of a kind, which may be a number, too.
fn name<'v>(value: &'v Value<'_>) -> Option<&'v str> {
    match value.get_ref() {
        DeValue::String(text) => Some(text.as_ref()),
        DeValue::Integer(number) => Some(number.as_str()),
        _ => None,
    }
}
