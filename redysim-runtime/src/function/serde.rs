//! Sets of functions by [`serde`]: as the list of their names.

use super::set::Functions;
use super::table::Function;
use core::fmt;
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl Serialize for Functions {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for Functions {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Names)
    }
}

struct Names;

impl<'de> Visitor<'de> for Names {
    type Value = Functions;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a list of names of functions")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Functions, A::Error> {
        let mut functions = Functions::of([]);
        while let Some(function) = names.next_element::<Function>()? {
            functions = Functions::of(functions.iter().chain([function]));
        }
        Ok(functions)
    }
}
