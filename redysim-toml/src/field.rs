//! What a file has under a key.

use toml::Spanned;

/// What a file has under a key.
#[derive(Debug)]
pub enum Field<T> {
    /// Nothing.
    Missing,
    /// Something that is not a `T`. The error has been reported; checks of this field are to keep silent.
    Invalid,
    /// A value, with its place.
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

    /// Whether the file has nothing here.
    pub fn is_missing(&self) -> bool {
        matches!(self, Field::Missing)
    }

    /// The value, or `default` where the file has none; `None` where it is invalid.
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
