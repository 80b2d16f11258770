//! The model file as it is written: tables and keys, read into structs with every value's place kept.
//!
//! Reading finds faults of form (unknown and missing keys, types, numbers, units) and goes on after each. What the
//! values mean together is for [`crate::check`].

mod cut;
mod link;
pub(crate) mod reader;
mod scene;
pub(crate) mod value;

pub(crate) use cut::{CutSideTable, LoopTable};
pub(crate) use link::{Dh, LinkTable, Origin};
pub(crate) use scene::{Entry, SceneTable};

use crate::diagnostic::Findings;
use crate::diagnostic::messages::quoted;
use crate::outline::Outline;

use reader::{Reader, Shape};
use redysim_runtime::Functions;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// What the file says under a key.
#[derive(Debug)]
pub enum Field<T> {
    /// Nothing.
    Missing,
    /// Something that is no `T`; a fault has been reported, and checks of this field are to keep silent.
    Faulty,
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
            Field::Missing | Field::Faulty => None,
        }
    }

    /// Whether the file says nothing.
    pub fn is_missing(&self) -> bool {
        matches!(self, Field::Missing)
    }

    /// The value, or `default` where the file says nothing; `None` where it is faulty.
    pub fn value_or(&self, default: T) -> Option<T>
    where
        T: Clone,
    {
        match self {
            Field::Missing => Some(default),
            Field::Faulty => None,
            Field::Value(value) => Some(value.get_ref().clone()),
        }
    }
}

/// The whole file.
#[derive(Debug)]
pub(crate) struct Document {
    /// What messages call the model.
    pub(crate) item: String,
    /// A place for faults of the model as a whole.
    pub(crate) place: Range<usize>,
    pub(crate) name: Field<String>,
    pub(crate) gravity: Field<[f64; 3]>,
    pub(crate) links: Vec<LinkTable>,
    /// Whether each link of the file is in `links`.
    pub(crate) links_complete: bool,
    pub(crate) loops: Vec<LoopTable>,
    /// What is asked of the model, by the file or beside it.
    pub(crate) scene: SceneTable,
}

const MODEL: Shape = Shape {
    owner: "A model",
    keys: &["name", "gravity", "link", "loop", "functions", "locked", "tolerance", "forward_dynamics"],
};

impl Document {
    /// Reads the file's tree, and that of the scene beside it.
    pub(crate) fn read(root: &DeTable<'_>, scene: &DeTable<'_>, findings: &mut Findings) -> Document {
        let name = root.get("name").and_then(|name| name.get_ref().as_str()).filter(|name| !name.trim().is_empty());
        let item = name.map_or("the model".into(), |name| format!("model {}", quoted(name)));
        let first_key = root.keys().map(Spanned::span).min_by_key(|span| span.start);
        let place = root.get("name").map(Spanned::span).or(first_key.clone()).unwrap_or(0..0);
        let mut reader = Reader::new(root, first_key.unwrap_or(0..0), &item, &MODEL, findings);
        let name = reader.text("name");
        let name = reader.required("name", name);
        let gravity = reader.vector("gravity");
        let gravity = reader.required("gravity", gravity);
        let links = reader.tables("link");
        let loops = reader.tables("loop");
        let links_complete = links.as_ref().is_some_and(|links| links.iter().all(Option::is_some));
        let mut links: Vec<_> = entries(links).map(|(i, table)| LinkTable::read(table, i, findings)).collect();
        let loops = entries(loops).map(|(i, table)| LoopTable::read(table, i, findings)).collect();
        let scene = SceneTable::read([root, scene], &item, links_complete.then_some(&links), findings);
        for lock in &scene.locked.said {
            links[lock.link].locked = Some(lock.value);
        }
        Document { item, place, name, gravity, links, links_complete, loops, scene }
    }

    /// The joints that the scene locks.
    pub(crate) fn locks(&self) -> Vec<&str> {
        let locked = self.links.iter().filter(|link| link.locked.is_some());
        locked.filter_map(|link| link.joint_name()).map(|name| name.get_ref().as_str()).collect()
    }

    /// What can be said of the model whatever its faults.
    pub(crate) fn outline(&self) -> Outline {
        let name = |name: Option<&Spanned<String>>, link: &LinkTable| {
            name.map_or(link.item.clone(), |name| name.get_ref().clone())
        };
        let moving: Vec<&LinkTable> = self.links.iter().filter(|link| !link.is_rigid()).collect();
        Outline {
            name: self.name.value().cloned().unwrap_or_default(),
            links: self.links.iter().map(|link| name(link.name.spanned(), link)).collect(),
            joints: moving.iter().map(|link| name(link.joint_name(), link)).collect(),
            actuated: moving.iter().map(|link| link.actuated.value_or(true).unwrap_or(true)).collect(),
            loop_rows: Vec::new(),
            mass: self.links.iter().filter_map(|link| link.mass.value()).sum(),
            functions: self.scene.functions.said.value().map_or(Functions::ALL, |given| given.set()),
        }
    }
}

/// One table of an array of tables, with the place of its header.
type Table<'a> = (&'a DeTable<'a>, Range<usize>);

/// The readable tables with their numbers in the file, counted from 1.
fn entries<'a>(tables: Option<Vec<Option<Table<'a>>>>) -> impl Iterator<Item = (usize, Table<'a>)> {
    let numbered = tables.unwrap_or_default().into_iter().zip(1..);
    numbered.filter_map(|(table, number)| Some((number, table?)))
}

/// "link `arm`", or "link #3" for a table without a readable name.
fn item(what: &str, table: &DeTable<'_>, number: usize) -> String {
    match table.get("name").map(Spanned::get_ref) {
        Some(DeValue::String(name)) if !name.trim().is_empty() => format!("{what} {}", quoted(name)),
        _ => format!("{what} #{number}"),
    }
}
