//! The value of a key in a file.

use toml::Spanned;

/// The value of a key in a file.
#[derive(Debug)]
pub enum Field<T> {
    /// The key is missing.
    Missing,
    /// The value is not a `T`. The error has been reported; checks of this field report nothing more.
    Invalid,
    /// The value, with its place.
    Value(Spanned<T>),
}

impl<T> Field<T> {
    /// The value, if there is one.
    pub fn value(&self) -> Option<&T> {
        self.spanned().map(Spanned::get_ref)
    }

    /// The value with its place, if there is one.
    pub fn spanned(&self) -> Option<&Spanned<T>> {
        match self {
            Field::Value(value) => Some(value),
            Field::Missing | Field::Invalid => None,
        }
    }

    /// Whether the key is missing.
    pub fn is_missing(&self) -> bool {
        matches!(self, Field::Missing)
    }

    /// The value, or `default` if the key is missing; `None` if the value is invalid.
    pub fn value_or(&self, default: T) -> Option<T>
    where
        T: Clone,
    {
        match self {
            Field::Missing => Some(default),
            Field::Invalid => None,
            Field::Value(value) => Some(value.get_ref().clone()),
        }
    }
}
