//! Kinds of tables.

use crate::key::Keys;

/// A kind of table: its name, its meaning, and its keys.
#[derive(Clone, Copy, Debug)]
pub struct Kind<K> {
    /// The name, as the file has it.
    pub name: &'static str,
    /// Its meaning.
    pub kind: K,
    /// The keys.
    pub keys: &'static Keys,
    /// The usual name of the kind, if `name` is another, such as a number that people know from elsewhere.
    pub same_as: Option<&'static str>,
}

impl<K> Kind<K> {
    /// A kind by its usual name.
    pub const fn new(name: &'static str, kind: K, keys: &'static Keys) -> Self {
        Kind { name, kind, keys, same_as: None }
    }
}

impl<K: Copy> Kind<K> {
    /// The same kind by another name.
    pub const fn also(self, name: &'static str) -> Self {
        Kind { name, kind: self.kind, keys: self.keys, same_as: Some(self.name) }
    }
}
