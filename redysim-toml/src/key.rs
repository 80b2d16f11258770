//! The keys of a file: what each is called, an example, and what it means.

use std::fmt;

/// A key of a table, defined once for the reader, the messages and the documentation.
///
/// ```
/// use redysim_toml::Key;
///
/// const MASS: Key = Key::new("mass", "1.5", "kg");
/// assert_eq!(MASS.example(), "mass = 1.5");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// An example of the value, to be copied; `None` for an array of tables, each with its own header.
    value: Option<&'static str>,
    /// The meaning of the value, with its unit; empty if the name is enough.
    pub meaning: &'static str,
    /// What holds where the key is missing, or that it must not be; empty if its owner does not state it.
    pub default: &'static str,
    /// The keys of the table that is its value: one set of keys, or one for each kind of table.
    pub tables: &'static [&'static Keys],
}

impl Key {
    /// A key with an example of its value, as TOML, and what it means.
    pub const fn new(name: &'static str, value: &'static str, meaning: &'static str) -> Self {
        Key { name, value: Some(value), meaning, default: "", tables: &[] }
    }

    /// A key whose value is a table, with the keys of that table, or of each kind of it.
    pub const fn of_table(
        name: &'static str,
        value: &'static str,
        meaning: &'static str,
        tables: &'static [&'static Keys],
    ) -> Self {
        Key { name, value: Some(value), meaning, default: "", tables }
    }

    /// A key whose value is an array of tables, each headed `[[name]]`.
    pub const fn of_tables(name: &'static str, meaning: &'static str, tables: &'static [&'static Keys]) -> Self {
        Key { name, value: None, meaning, default: "", tables }
    }

    /// The key with what holds where it is missing.
    pub const fn with_default(self, default: &'static str) -> Self {
        Key { default, ..self }
    }

    /// The example of its value; empty for an array of tables.
    pub fn value(&self) -> &'static str {
        self.value.unwrap_or_default()
    }

    /// An example line, to be copied.
    pub fn example(&self) -> String {
        match self.value {
            Some(value) => format!("{} = {value}", self.name),
            None => format!("[[{}]]", self.name),
        }
    }
}

/// The keys that a kind of table may have.
#[derive(Debug)]
pub struct Keys {
    /// What has the keys, with its article.
    pub owner: &'static str,
    /// The keys.
    pub keys: &'static [Key],
    /// What to write instead of names that are not among the keys.
    pub hints: &'static [Hint],
}

/// What to write instead of a name that is not among the keys, but that people know from elsewhere or expect there.
///
/// ```
/// use redysim_toml::{Hint, Key, Keys};
///
/// const HINTS: &[Hint] = &[Hint::key(&["arms"], "hands"), Hint::new(&["date"], "a date goes into a calendar")];
/// const CLOCK: Keys = Keys::new("A clock", &[Key::new("hands", "2", "how many")]).with_hints(HINTS);
/// assert_eq!(CLOCK.hint("arms").unwrap().key, Some("hands"));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hint {
    /// The names.
    pub names: &'static [&'static str],
    /// The key of the same table that is meant, if there is one.
    pub key: Option<&'static str>,
    /// What to do; empty if the key is enough.
    pub help: &'static str,
}

impl Hint {
    /// A hint that a name belongs elsewhere, or nowhere.
    pub const fn new(names: &'static [&'static str], help: &'static str) -> Self {
        Hint { names, key: None, help }
    }

    /// A hint at a key of the same table.
    pub const fn key(names: &'static [&'static str], key: &'static str) -> Self {
        Hint { names, key: Some(key), help: "" }
    }

    /// The hint with what else there is to know.
    pub const fn with_help(self, help: &'static str) -> Self {
        Hint { help, ..self }
    }
}

impl Keys {
    /// The keys of `owner`, a noun with its article.
    pub const fn new(owner: &'static str, keys: &'static [Key]) -> Self {
        Keys { owner, keys, hints: &[] }
    }

    /// The keys with hints about names that are not among them.
    pub const fn with_hints(self, hints: &'static [Hint]) -> Self {
        Keys { hints, ..self }
    }

    /// The hint about the name `found`.
    pub fn hint(&self, found: &str) -> Option<&Hint> {
        self.hints.iter().find(|hint| hint.names.contains(&found))
    }

    /// Their names.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.keys.iter().map(|key| key.name)
    }

    /// The documentation of the keys, and of those of the tables within, in Markdown: a table for each.
    ///
    /// ```
    /// use redysim_toml::{Key, Keys};
    ///
    /// const CLOCK: Keys = Keys::new("A clock", &[Key::new("hands", "2", "how many")]);
    /// let [head, row] = ["| key | example | meaning |\n|---|---|---|", "| `hands` | `hands = 2` | how many |"];
    /// assert_eq!(CLOCK.documentation(), format!("A clock has the keys:\n\n{head}\n{row}\n"));
    /// ```
    pub fn documentation(&self) -> String {
        let tables = self.documented_tables().into_iter();
        tables.map(|(owner, table)| format!("{owner} has the keys:\n\n{table}")).collect::<Vec<_>>().join("\n")
    }

    /// The tables of [`Keys::documentation`], each with the owner of its keys. Defaults have a column where they are
    /// stated.
    pub fn documented_tables(&self) -> Vec<(&'static str, String)> {
        let mut tables = Vec::new();
        self.document(&mut tables);
        tables
    }

    fn document(&self, tables: &mut Vec<(&'static str, String)>) {
        let has_defaults = self.keys.iter().any(|key| !key.default.is_empty());
        let (head, rule) = if has_defaults { ("default | ", "---|") } else { ("", "") };
        let mut text = format!("| key | example | {head}meaning |\n|---|---|---|{rule}\n");
        for key in self.keys {
            let default = if has_defaults { format!("{} | ", key.default) } else { String::new() };
            text.push_str(&format!("| `{}` | `{}` | {default}{} |\n", key.name, key.example(), key.meaning));
        }
        tables.push((self.owner, text));
        for table in self.keys.iter().flat_map(|key| key.tables) {
            if tables.iter().all(|(owner, _)| owner != &table.owner) {
                table.document(tables);
            }
        }
    }
}

/// What messages call a value: the path to it, as in `dh.a` or `com[1]`, with the key that it belongs to.
#[derive(Clone, Debug)]
pub struct KeyPath {
    key: Key,
    path: String,
}

impl KeyPath {
    /// A key of a table; `prefix` stands before it: empty, or `dh.` in the table `dh`.
    pub(crate) fn new(prefix: &str, key: &Key) -> Self {
        KeyPath { key: *key, path: format!("{prefix}{}", key.name) }
    }

    /// The element `index` of an array.
    pub fn element(&self, index: usize) -> Self {
        KeyPath { key: self.key, path: format!("{}[{index}]", self.path) }
    }

    /// The value under `name`, a name defined by the file instead of a known key.
    pub fn entry(&self, name: &str) -> Self {
        KeyPath { key: self.key, path: format!("{}.{name}", self.path) }
    }

    /// "write for example …".
    pub(crate) fn example(&self) -> String {
        match self.key.meaning {
            "" => format!("write for example `{}`", self.key.example()),
            meaning => format!("write for example `{}` ({meaning})", self.key.example()),
        }
    }
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.path)
    }
}
