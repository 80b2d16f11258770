//! Reads the keys of one table, and reports errors.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::decimal::{elements, with_decimal_points};
use crate::diagnostic::Message;
use crate::field::Field;
use crate::findings::Findings;
use crate::key::{Key, KeyPath, Keys};
use crate::kind::Kind;
use crate::messages;
use crate::value::{Array, Named, Table, Value};
use crate::words::nearest;

/// A table with the place of its header.
#[derive(Clone, Debug)]
pub struct TableAt<'a> {
    /// The table.
    pub table: &'a Table<'a>,
    /// The bytes of its header.
    pub header: Range<usize>,
}

/// Reads the values of one table as [`Field`]s, and reports every error at its place.
pub struct Reader<'a, 'f> {
    table: &'a DeTable<'a>,
    /// Where missing keys are reported.
    place: Range<usize>,
    /// What messages call the item that the table describes.
    item: &'f str,
    /// Valid keys that unknown ones were probably meant to be: their absence is not a second error.
    misspelt: Vec<&'static str>,
    /// Stands before a key in messages: empty, or `dh.` in the table `dh`.
    prefix: String,
    findings: &'f mut Findings,
}

impl<'a, 'f> Reader<'a, 'f> {
    /// Opens a table and reports its unknown keys. Messages call what it describes `item`, as in "link `arm`"; missing
    /// keys are reported at `place`.
    pub fn new(
        table: &'a Table<'a>,
        place: Range<usize>,
        item: &'f str,
        keys: &Keys,
        findings: &'f mut Findings,
    ) -> Self {
        Self::open(table, place, item, findings).without_unknown_keys(keys)
    }

    /// Opens a table again whose unknown keys have been reported.
    pub fn known(table: &'a Table<'a>, item: &'f str, findings: &'f mut Findings) -> Self {
        Self::open(table, 0..0, item, findings)
    }

    fn open(table: &'a DeTable<'a>, place: Range<usize>, item: &'f str, findings: &'f mut Findings) -> Self {
        Self { table, place, item, misspelt: Vec::new(), prefix: String::new(), findings }
    }

    /// What messages call the item that the table describes.
    pub fn item(&self) -> &'f str {
        self.item
    }

    /// Reports the keys that tables of this kind do not have.
    fn without_unknown_keys(mut self, keys: &Keys) -> Self {
        for found in self.table.keys().filter(|found| keys.names().all(|name| name != found.get_ref())) {
            let absent = keys.names().filter(|name| !self.table.contains_key(*name));
            let hint = keys.hint(found.get_ref());
            let in_lower_case = || keys.names().find(|name| name.eq_ignore_ascii_case(found.get_ref()));
            let meant =
                hint.map_or_else(|| in_lower_case().or_else(|| nearest(found.get_ref(), absent)), |hint| hint.key);
            let path = format!("{}{}", self.prefix, found.get_ref());
            let help = hint.map_or("", |hint| hint.help);
            self.findings.error(found.span(), messages::unknown_key(self.item, &path, meant, help, keys));
            self.misspelt.extend(meant);
        }
        self
    }

    /// Takes a key that is missing as one that has an error, because that has been or is going to be reported.
    pub fn excuse(&mut self, key: &Key) {
        self.misspelt.push(key.name);
    }

    /// Reads a required key with `read`, and reports it if it is missing.
    pub fn required<T>(&mut self, key: &Key, read: impl FnOnce(&mut Self, &Key) -> Field<T>) -> Field<T> {
        let field = read(self, key);
        if field.is_missing() {
            self.findings.error(self.place.clone(), messages::missing_key(self.item, &self.path(key)));
        }
        field
    }

    /// Reads the value of a key with `read`; the field is invalid if `read` reports an error.
    pub fn field<T>(
        &mut self,
        key: &Key,
        read: impl FnOnce(&mut Self, &KeyPath, &'a Value<'a>) -> Option<T>,
    ) -> Field<T> {
        let table = self.table;
        let Some(value) = table.get(key.name) else {
            return if self.misspelt.contains(&key.name) { Field::Invalid } else { Field::Missing };
        };
        let (path, errors_before) = (self.path(key), self.findings.errors());
        match read(self, &path, value) {
            Some(read) if self.findings.errors() == errors_before => Field::Value(Spanned::new(value.span(), read)),
            _ => Field::Invalid,
        }
    }

    /// A string.
    pub fn text(&mut self, key: &Key) -> Field<String> {
        self.field(key, |reader, path, value| match value.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            _ => reader.wrong_type(path, value, "a string"),
        })
    }

    /// True or false.
    pub fn flag(&mut self, key: &Key) -> Field<bool> {
        self.field(key, |reader, path, value| match value.get_ref() {
            DeValue::Boolean(flag) => Some(*flag),
            _ => reader.wrong_type(path, value, "true or false"),
        })
    }

    /// A finite number.
    pub fn number(&mut self, key: &Key) -> Field<f64> {
        self.field(key, Self::parse_number)
    }

    /// A number above zero.
    pub fn positive(&mut self, key: &Key) -> Field<f64> {
        self.field(key, Self::parse_positive)
    }

    /// An angle, in radians.
    pub fn angle(&mut self, key: &Key) -> Field<f64> {
        self.field(key, Self::parse_angle)
    }

    /// Three numbers.
    pub fn vector(&mut self, key: &Key) -> Field<[f64; 3]> {
        self.field(key, |reader, path, value| reader.three(path, value, "3 numbers", Self::parse_number))
    }

    /// Three angles, in radians.
    pub fn angles(&mut self, key: &Key) -> Field<[f64; 3]> {
        self.field(key, |reader, path, value| reader.three(path, value, "3 angles", Self::parse_angle))
    }

    /// Numbers, as many as there are.
    pub fn numbers(&mut self, key: &Key) -> Field<Vec<f64>> {
        self.field(key, |reader, path, value| {
            let array = reader.array(path, value, "an array of numbers")?;
            reader.elements(path, array, Self::parse_number)
        })
    }

    /// One of the names in `choices`.
    pub fn choice<T: Copy>(&mut self, key: &Key, choices: &[(&str, T)]) -> Field<T> {
        self.field(key, |reader, path, value| {
            let Some(found) = name_of(value) else { return reader.wrong_type(path, value, "a string") };
            reader.choose(path, value, found, choices)
        })
    }

    /// Looks up the name `found` in `choices`.
    pub fn choose<T: Copy>(
        &mut self,
        path: &KeyPath,
        value: &Value<'_>,
        found: &str,
        choices: &[(&str, T)],
    ) -> Option<T> {
        let chosen = choices.iter().find(|(name, _)| *name == found).map(|(_, choice)| *choice);
        chosen.or_else(|| {
            let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
            self.error(value, messages::unknown_choice(self.item, path, found, &names))
        })
    }

    /// Looks up the name `found`, which stands at `place`, in `named`; messages call each of them a `what`.
    pub fn lookup<T: Copy>(&mut self, place: Range<usize>, what: &str, found: &str, named: &[(&str, T)]) -> Option<T> {
        let there = named.iter().find(|(name, _)| *name == found).map(|(_, thing)| *thing);
        there.or_else(|| {
            let names: Vec<_> = named.iter().map(|(name, _)| *name).collect();
            self.error_at(place, messages::unknown_name(self.item, what, found, &names))
        })
    }

    /// Whether there is a table under a key.
    pub fn has_table(&self, key: &Key) -> bool {
        self.table.get(key.name).is_some_and(|value| matches!(value.get_ref(), DeValue::Table(_)))
    }

    /// A table within this one, with the first of the sets of keys that `key` has.
    pub fn table<T>(&mut self, key: &Key, read: impl FnOnce(Reader<'_, '_>) -> T) -> Field<T> {
        self.field(key, |reader, path, value| {
            let inner = reader.within(path, value)?;
            Some(read(match key.tables.first() {
                Some(keys) => inner.without_unknown_keys(keys),
                None => inner,
            }))
        })
    }

    /// A reader of the table that `value`, found at `path`, must be; it has `keys`.
    pub fn table_at<'b>(&'b mut self, path: &KeyPath, value: &'b Value<'_>, keys: &Keys) -> Option<Reader<'b, 'b>> {
        let DeValue::Table(table) = value.get_ref() else {
            return self.wrong_type(path, value, "a table");
        };
        Some(self.inside(path, value, table).without_unknown_keys(keys))
    }

    /// A table within this one whose kind, named under the key `tag`, determines which keys it has. The name of a kind
    /// alone stands for a table without other keys.
    pub fn table_of_kind<T, K: Copy>(
        &mut self,
        key: &Key,
        tag: &Key,
        kinds: &[Kind<K>],
        default: &Kind<K>,
        read: impl FnOnce(Reader<'_, '_>, K) -> T,
    ) -> Field<T> {
        let nothing_else = DeTable::new();
        self.field(key, |reader, path, value| {
            if let Some(found) = name_of(value) {
                let kind = reader.kind(path, value, found, kinds)?;
                return Some(read(reader.inside(path, value, &nothing_else), kind.kind));
            }
            reader.table_of_kind_at(path, value, tag, kinds, Some(default), read)
        })
    }

    /// The table that `value`, found at `path`, must be, whose kind, named under the key `tag`, determines which keys it
    /// has. Without a default, the kind must be named.
    pub fn table_of_kind_at<T, K: Copy>(
        &mut self,
        path: &KeyPath,
        value: &Value<'_>,
        tag: &Key,
        kinds: &[Kind<K>],
        default: Option<&Kind<K>>,
        read: impl FnOnce(Reader<'_, '_>, K) -> T,
    ) -> Option<T> {
        let DeValue::Table(table) = value.get_ref() else {
            return self.wrong_type(path, value, "a table");
        };
        let mut inner = self.inside(path, value, table);
        let by_name = |inner: &mut Reader<'_, '_>, key: &Key| {
            inner.field(key, |inner, path, value| match name_of(value) {
                Some(found) => inner.kind(path, value, found, kinds),
                None => inner.wrong_type(path, value, "a string"),
            })
        };
        if let Some(default) = default.filter(|_| !table.contains_key(tag.name)) {
            inner.expect_default(tag, kinds, default)?;
        }
        let kind = match default {
            Some(default) => by_name(&mut inner, tag).value_or(default)?,
            None => *inner.required(tag, by_name).value()?,
        };
        Some(read(inner.without_unknown_keys(kind.keys), kind.kind))
    }

    /// Reports a table without a kind whose keys are those of another than the default one: the other keys follow.
    fn expect_default<K>(&mut self, tag: &Key, kinds: &[Kind<K>], default: &Kind<K>) -> Option<()> {
        let table = self.table;
        let mut others: Vec<_> =
            table.keys().filter(|key| default.keys.names().all(|name| name != key.get_ref())).collect();
        others.sort_by_key(|key| key.span().start);
        let for_tag = others.iter().find(|key| {
            let hint = default.keys.hint(key.get_ref());
            hint.map_or_else(|| nearest(key.get_ref(), [tag.name]), |hint| hint.key) == Some(tag.name)
        });
        if let Some(key) = for_tag {
            let path = format!("{}{}", self.prefix, key.get_ref());
            let message = messages::unknown_key(self.item, &path, Some(tag.name), "", default.keys);
            return self.error_at(key.span(), message);
        }
        let has_all = |kind: &&Kind<K>| table.keys().all(|key| kind.keys.names().any(|name| name == key.get_ref()));
        let having: Vec<_> = kinds.iter().filter(|kind| kind.same_as.is_none()).filter(has_all).collect();
        if let (Some(key), false) = (others.first(), having.is_empty()) {
            let (path, names) = (self.path(tag), having.iter().map(|kind| kind.name).collect::<Vec<_>>());
            let message = messages::kind_missing(self.item, &path, default.name, key.get_ref(), &names);
            return self.error_at(key.span(), message);
        }
        Some(())
    }

    /// Looks up the kind of the name `found`.
    fn kind<'k, K>(
        &mut self,
        path: &KeyPath,
        value: &Value<'_>,
        found: &str,
        kinds: &'k [Kind<K>],
    ) -> Option<&'k Kind<K>> {
        kinds.iter().find(|kind| kind.name == found).or_else(|| {
            let names: Vec<_> = kinds.iter().map(|kind| (kind.name, kind.same_as)).collect();
            self.error(value, messages::unknown_kind(self.item, path, found, &names))
        })
    }

    /// A reader of the table that `value` must be.
    fn within<'b>(&'b mut self, path: &KeyPath, value: &'b Value<'a>) -> Option<Reader<'b, 'b>> {
        let DeValue::Table(table) = value.get_ref() else {
            return self.wrong_type(path, value, "a table");
        };
        Some(self.inside(path, value, table))
    }

    /// A reader of `table`, for which `value` stands.
    fn inside<'b>(&'b mut self, path: &KeyPath, value: &Value<'_>, table: &'b DeTable<'b>) -> Reader<'b, 'b> {
        let (item, prefix) = (self.item, format!("{path}."));
        let inner = Reader::open(table, value.span(), item, self.findings);
        Reader { prefix, ..inner }
    }

    /// The tables of an array of tables. `None` stands for an invalid array, and within it for an entry that is not a
    /// table.
    pub fn tables(&mut self, key: &Key) -> Option<Vec<Option<TableAt<'a>>>> {
        let (table, path) = (self.table, self.path(key));
        let Some(value) = table.get(key.name) else {
            return (!self.misspelt.contains(&key.name)).then(Vec::new);
        };
        let wanted = format!("an array of tables, each headed `[[{}]]`", key.name);
        let entry = |reader: &mut Self, entry: &'a Value<'a>| match entry.get_ref() {
            DeValue::Table(table) => Some(TableAt { table, header: entry.span() }),
            _ => reader.wrong_type(&path, entry, &wanted),
        };
        let array = self.array(&path, value, &wanted)?;
        Some(array.iter().map(|value| entry(self, value)).collect())
    }

    /// The value as a finite number.
    pub fn parse_number(&mut self, path: &KeyPath, value: &Value<'_>) -> Option<f64> {
        let number = Named { item: self.item, path, value }.number();
        self.accept(value, number)
    }

    /// The value as a number above zero.
    pub fn parse_positive(&mut self, path: &KeyPath, value: &Value<'_>) -> Option<f64> {
        let number = self.parse_number(path, value)?;
        if number <= 0.0 {
            return self.error(value, messages::not_positive(self.item, path, number));
        }
        Some(number)
    }

    /// The value as an angle, in radians: a number, or one with a unit.
    pub fn parse_angle(&mut self, path: &KeyPath, value: &Value<'_>) -> Option<f64> {
        self.parse_turn(path, value, "")
    }

    /// The value as a position of a joint: an angle for one that turns, otherwise a number.
    pub fn parse_position(&mut self, path: &KeyPath, value: &Value<'_>, turns: bool) -> Option<f64> {
        if turns { self.parse_angle(path, value) } else { self.parse_number(path, value) }
    }

    /// The value as a displacement of a joint, or as its rate `per` time, such as "/s": a number, or for a joint that
    /// turns also an angle with a unit, in radians. Unlike [`parse_position`](Self::parse_position), it accepts more than a
    /// turn without a warning.
    pub fn parse_displacement(&mut self, path: &KeyPath, value: &Value<'_>, turns: bool, per: &str) -> Option<f64> {
        match value.get_ref() {
            DeValue::String(_) if turns => self.parse_turn(path, value, per),
            _ => self.parse_number(path, value),
        }
    }

    fn parse_turn(&mut self, path: &KeyPath, value: &Value<'_>, per: &str) -> Option<f64> {
        let angle = Named { item: self.item, path, value }.angle(per);
        let angle = self.accept(value, angle)?;
        if let Some((lint, message)) = angle.warning {
            self.findings.lint(lint, value.span(), message);
        }
        Some(angle.radians)
    }

    /// The value as an array; `wanted` is a noun with its article.
    pub fn array(&mut self, path: &KeyPath, value: &'a Value<'a>, wanted: &str) -> Option<&'a Array<'a>> {
        match value.get_ref() {
            DeValue::Array(array) => Some(array),
            _ => self.wrong_type(path, value, wanted),
        }
    }

    /// Reads each element of an array with `read`. Every element is read, so that each error among them is reported.
    pub fn elements<T>(
        &mut self,
        path: &KeyPath,
        array: &'a Array<'a>,
        read: impl Fn(&mut Self, &KeyPath, &'a Value<'a>) -> Option<T>,
    ) -> Option<Vec<T>> {
        let each = array.iter().enumerate().map(|(i, value)| read(self, &path.element(i), value));
        each.collect::<Vec<_>>().into_iter().collect()
    }

    /// The value as three rows of three numbers.
    pub fn parse_matrix(&mut self, path: &KeyPath, value: &'a Value<'a>) -> Option<[[f64; 3]; 3]> {
        // Numbers without rows are one error, not one for each.
        let array = self.array(path, value, "an array of 3 rows of 3 numbers")?;
        if array.len() != 3 {
            return self.wrong_length(path, value, "3 rows of 3 numbers", array.len());
        }
        self.three(path, value, "3 rows of 3 numbers", |reader, path, value| {
            reader.three(path, value, "3 numbers", Self::parse_number)
        })
    }

    fn three<T>(
        &mut self,
        path: &KeyPath,
        value: &'a Value<'a>,
        wanted: &str,
        read: impl Fn(&mut Self, &KeyPath, &'a Value<'a>) -> Option<T>,
    ) -> Option<[T; 3]> {
        let array = self.array(path, value, &format!("an array of {wanted}"))?;
        let is_nested = array.iter().any(|element| element.get_ref().is_array());
        if array.len() != 3 && is_nested {
            // A bracket too many is one error.
            return self.wrong_length(path, value, wanted, array.len());
        }
        let elements = self.elements(path, array, read);
        if array.len() != 3 {
            return self.wrong_length(path, value, wanted, array.len());
        }
        elements?.try_into().ok()
    }

    fn accept<T>(&mut self, value: &Value<'_>, read: Result<T, Message>) -> Option<T> {
        read.map_or_else(|message| self.error(value, message), Some)
    }

    /// Reports that a value is not of the type `wanted`, a noun with its article. Always `None`.
    pub fn wrong_type<T>(&mut self, path: &KeyPath, value: &Value<'_>, wanted: &str) -> Option<T> {
        let message = Named { item: self.item, path, value }.wrong_type(wanted);
        self.error(value, message)
    }

    /// Reports that an array has `found` elements instead of `wanted`, as "3 numbers". Always `None`.
    pub fn wrong_length<T>(&mut self, path: &KeyPath, value: &Value<'_>, wanted: &str, found: usize) -> Option<T> {
        let written = with_decimal_points(self.findings.text(&value.span()));
        // Each decimal comma has made two elements of one.
        let written = written.filter(|written| wanted.starts_with(&format!("{} ", elements(written))));
        self.error(value, messages::wrong_length(self.item, path, wanted, found, written.as_deref()))
    }

    /// Reports an error of a value. Always `None`.
    pub fn error<T>(&mut self, value: &Value<'_>, message: Message) -> Option<T> {
        self.error_at(value.span(), message)
    }

    /// Reports an error at a place. Always `None`.
    pub fn error_at<T>(&mut self, place: Range<usize>, message: Message) -> Option<T> {
        self.findings.error(place, message);
        None
    }

    /// Reports an error of the table as a whole. Always `None`.
    pub fn error_of_table<T>(&mut self, message: Message) -> Option<T> {
        self.error_at(self.place.clone(), message)
    }

    /// Reports a warning at a place.
    pub fn warning_at(&mut self, place: Range<usize>, message: Message) {
        self.findings.warning(place, message);
    }

    /// Reports a warning about the table as a whole.
    pub fn warning_of_table(&mut self, message: Message) {
        self.warning_at(self.place.clone(), message);
    }

    fn path(&self, key: &Key) -> KeyPath {
        KeyPath::new(&self.prefix, key)
    }
}

/// The value as a name: a string, or a number used as one.
pub fn name_of<'v>(value: &'v Value<'_>) -> Option<&'v str> {
    match value.get_ref() {
        DeValue::String(text) => Some(text.as_ref()),
        DeValue::Integer(number) => Some(number.as_str()),
        _ => None,
    }
}
