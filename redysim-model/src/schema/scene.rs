//! What is asked of a model, at the top of its file or beside it.

use super::Field;
use super::reader::{Reader, Shape};
use crate::diagnostic::{Findings, Text, messages};
use crate::scene::{FUNCTIONS, Functions};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What the scene beside the file says or, key by key, what the file says where that is silent.
#[derive(Debug)]
pub(crate) struct SceneTable {
    pub(crate) functions: Entry<FunctionNames>,
}

/// What one of the two texts says under a key.
#[derive(Debug)]
pub(crate) struct Entry<T> {
    pub(crate) text: Text,
    pub(crate) field: Field<T>,
}

/// Names of functions, each with its place.
#[derive(Clone, Debug)]
pub(crate) struct FunctionNames(pub(crate) Vec<Spanned<&'static str>>);

impl FunctionNames {
    /// As a set.
    pub(crate) fn set(&self) -> Functions {
        Functions::of(self.0.iter().map(|name| *name.get_ref())).unwrap_or_default()
    }
}

const SCENE: Shape = Shape { owner: "A scene", keys: &["functions"] };

impl SceneTable {
    /// Reads the keys of a scene from both texts.
    pub(super) fn read(file: &DeTable<'_>, beside: &DeTable<'_>, item: &str, findings: &mut Findings) -> SceneTable {
        let in_file = Keys::read(Reader::known(file, item, findings));
        let beside =
            findings.within(Text::Scene, |findings| Keys::read(Reader::new(beside, 0..0, item, &SCENE, findings)));
        SceneTable { functions: first(beside.functions, in_file.functions) }
    }
}

/// What one text says.
struct Keys {
    functions: Field<FunctionNames>,
}

impl Keys {
    fn read(mut reader: Reader<'_, '_>) -> Keys {
        Keys { functions: functions(&mut reader) }
    }
}

fn first<T>(beside: Field<T>, in_file: Field<T>) -> Entry<T> {
    if beside.is_missing() {
        Entry { text: Text::File, field: in_file }
    } else {
        Entry { text: Text::Scene, field: beside }
    }
}

fn functions(reader: &mut Reader<'_, '_>) -> Field<FunctionNames> {
    reader.field("functions", |reader, path, value| {
        let DeValue::Array(array) = value.get_ref() else {
            return reader.wrong_type(path, value, "an array of names of functions");
        };
        if array.is_empty() {
            return reader.fault(value, messages::no_functions(reader.item()));
        }
        let mut names: Vec<Spanned<&'static str>> = Vec::new();
        for (index, value) in array.iter().enumerate() {
            let path = format!("{path}[{index}]");
            let DeValue::String(text) = value.get_ref() else {
                reader.wrong_type::<()>(&path, value, "the name of a function");
                continue;
            };
            match FUNCTIONS.iter().find(|known| **known == text.as_ref()) {
                None => _ = reader.fault::<()>(value, messages::unknown_function(reader.item(), text)),
                Some(name) if names.iter().any(|other| other.get_ref() == name) => {
                    _ = reader.fault::<()>(value, messages::repeated_function(reader.item(), name));
                }
                Some(name) => names.push(Spanned::new(value.span(), name)),
            }
        }
        Some(FunctionNames(names))
    })
}
