//! The model file as it is written: tables and keys, read into structs with every value's place kept.
//!
//! Reading reports errors of form (unknown and missing keys, types, numbers, units) and goes on after each. What the
//! values mean together is for [`crate::check`].

mod cut;
mod frame;
mod hints;
mod item;
pub(crate) mod keys;
mod link;
mod mimic;
mod options;
mod origin;
mod point;
mod spring;

pub(crate) use cut::{CutSideTable, LoopTable};
pub(crate) use frame::FrameTable;
pub(crate) use link::{Dh, DhStandard, LinkTable, MimicTable, PhysicsKeys};
pub(crate) use mimic::mimicked;
pub(crate) use options::{Entry, OptionsTable};
pub(crate) use origin::RotationDefect;
pub(crate) use point::PointTable;
pub(crate) use spring::SpringTable;

use crate::lint::Lint;
use crate::messages;
use crate::public_interface::{MovingJoint, ParameterNumber, PublicInterface};
use crate::run_time::RunTimeParameter;
use redysim_runtime::{Functions, ParameterRule};
use redysim_toml::words::quoted;
use redysim_toml::{DeValue, Field, Findings, Parsed, Reader, Spanned, Table, TableAt, Value};
use std::ops::Range;

/// The documentation of the keys of a model file, and of the lints that `allow` may name, as tables in Markdown, each with
/// what has the keys, such as "A link": `docs/models.md` has them all.
pub fn key_documentation() -> Vec<(&'static str, String)> {
    let lints = ("Lints", Lint::documentation());
    keys::MODEL.documented_tables().into_iter().chain([lints]).collect()
}

/// The names of the options that a declaration may have beside the path of its model file.
pub fn option_names() -> impl Iterator<Item = &'static str> {
    keys::OPTIONS.names()
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
    /// The lints that are not reported.
    pub(crate) allowed: Vec<Lint>,
    pub(crate) frames: Vec<FrameTable>,
    pub(crate) springs: Vec<SpringTable>,
    /// The options of code generation, in the file or beside it.
    pub(crate) options: OptionsTable,
}

impl Document {
    /// Reads the file, and the options beside it.
    pub(crate) fn read(file: &Parsed<'_>, options: &Parsed<'_>, findings: &mut Findings) -> Document {
        let root = file.root();
        let name = root.get(keys::NAME.name);
        let place = name.map_or(file.start(), Spanned::span);
        let name = name.and_then(|name| name.get_ref().as_str()).filter(|name| !name.trim().is_empty());
        let item = name.map_or("the model".into(), |name| format!("model {}", quoted(name)));
        let mut reader = Reader::new(root, file.start(), &item, &keys::MODEL, findings);
        let name = reader.required(&keys::NAME, Reader::text);
        if is_in_tables(root, keys::GRAVITY.name) {
            // The table reports it, and where it belongs.
            reader.excuse(&keys::GRAVITY);
        }
        let gravity = reader.required(&keys::GRAVITY, Reader::vector);
        let allowed = allowed(&mut reader);
        let links = reader.tables(&keys::LINKS);
        let loops = reader.tables(&keys::LOOPS);
        let frames = reader.tables(&keys::FRAMES);
        let springs = reader.tables(&keys::SPRINGS);
        // A table of another name may be meant as a link.
        let are_known = root.iter().all(|(key, value)| !is_tables(value) || is_known(key.get_ref()));
        let links_complete = are_known && links.as_ref().is_some_and(|links| links.iter().all(Option::is_some));
        let mut links: Vec<_> = entries(links).map(|(i, table)| LinkTable::read(table, i, findings)).collect();
        let loops = entries(loops).map(|(i, table)| LoopTable::read(table, i, findings)).collect();
        let frames = entries(frames).map(|(i, table)| FrameTable::read(table, i, findings)).collect();
        let springs = entries(springs).map(|(i, table)| SpringTable::read(table, i, findings)).collect();
        let options = OptionsTable::read([root, options.root()], &item, links_complete.then_some(&links), findings);
        for lock in &options.locked.value {
            links[lock.link].locked = Some(lock.values.clone());
        }
        mimic::lock(&mut links);
        Document { item, place, name, gravity, links, links_complete, loops, frames, springs, allowed, options }
    }

    /// The joints that the options lock.
    pub(crate) fn locks(&self) -> Vec<&str> {
        let locked = self.links.iter().filter(|link| link.locked.is_some());
        locked.filter_map(|link| link.joint_name()).map(|name| name.get_ref().as_str()).collect()
    }

    /// Whether some velocities have an actuator and some do not, and there are no loops.
    pub(crate) fn has_passive_joints(&self) -> bool {
        let moving = self.links.iter().filter(|link| link.is_independent());
        let velocities: Vec<bool> = moving.flat_map(LinkTable::actuated_velocities).collect();
        let actuated = velocities.iter().filter(|actuated| **actuated).count();
        self.loops.is_empty() && (1..velocities.len()).contains(&actuated)
    }

    /// The interface of the model, whatever is wrong with it.
    pub(crate) fn public_interface(&self) -> PublicInterface {
        let name =
            |name: Option<&Spanned<String>>, item: &String| name.map_or(item.clone(), |name| name.get_ref().clone());
        let joint = |link: &LinkTable| {
            MovingJoint::new(name(link.joint_name(), &link.item), link.motion(), link.actuated_velocities())
        };
        let numbers = |parameter: &Spanned<RunTimeParameter>| {
            let parameter = *parameter.get_ref();
            let owner = parameter.link.and_then(|link| self.links.get(link)).and_then(|link| {
                let joint = link.joint_name().filter(|_| parameter.quantity.is_of_joint());
                joint.map(Spanned::get_ref).or(link.name.value())
            });
            let joint = parameter.link.and_then(|link| self.links.get(link)?.motion());
            let numbers = parameter.numbers_with(owner, joint);
            numbers.map(|(name, rule)| ParameterNumber { name, value: 0.0, rule }).collect::<Vec<_>>()
        };
        let parameters = match &self.options.parameters.value {
            Field::Missing => Vec::new(),
            Field::Value(parameters) => parameters.get_ref().iter().flat_map(numbers).collect(),
            Field::Invalid => vec![ParameterNumber { name: String::new(), value: 0.0, rule: ParameterRule::Finite }],
        };
        let functions = self.options.functions.value.value().map_or(Functions::ALL, |given| given.set());
        let joints: Vec<MovingJoint> = self.links.iter().filter(|link| link.is_independent()).map(joint).collect();
        let functions = functions.with_frames(self.frames.len()).with_passive_joints(self.has_passive_joints());
        PublicInterface {
            is_valid: false,
            name: self.name.value().cloned().unwrap_or_default(),
            links: self.links.iter().map(|link| name(link.name.spanned(), &link.item)).collect(),
            joints,
            loop_rows: Vec::new(),
            frames: self.frames.iter().map(|frame| name(frame.name.spanned(), &frame.item)).collect(),
            mass: self.links.iter().filter_map(|link| link.mass.value()).sum(),
            functions,
            parameters,
        }
    }
}

/// Whether a value has headers `[[..]]`.
fn is_tables(value: &Value<'_>) -> bool {
    value.get_ref().as_array().is_some_and(|array| array.iter().any(|entry| entry.get_ref().is_table()))
}

/// Whether the key is one of a model.
fn is_known(key: &str) -> bool {
    keys::MODEL.names().any(|name| name == key)
}

/// Whether one of the tables below the top of the file has the key.
fn is_in_tables(root: &Table<'_>, key: &str) -> bool {
    let entries = root.values().filter_map(|value| value.get_ref().as_array()).flat_map(|array| array.iter());
    entries.filter_map(|entry| entry.get_ref().as_table()).any(|table| table.contains_key(key))
}

/// The lints that the file allows.
fn allowed(reader: &mut Reader<'_, '_>) -> Vec<Lint> {
    let mut allowed = Vec::new();
    reader.field(&keys::ALLOW, |reader, path, value| {
        for (index, value) in reader.array(path, value, "an array of names of lints")?.iter().enumerate() {
            let DeValue::String(text) = value.get_ref() else {
                reader.wrong_type::<()>(&path.element(index), value, "the name of a lint");
                continue;
            };
            match Lint::ALL.into_iter().find(|lint| lint.name() == text.as_ref()) {
                Some(lint) => allowed.push(lint),
                None => _ = reader.error::<()>(value, messages::unknown_lint(reader.item(), text)),
            }
        }
        Some(())
    });
    allowed
}

/// The readable tables with their numbers in the file, counted from 1.
fn entries<'a>(tables: Option<Vec<Option<TableAt<'a>>>>) -> impl Iterator<Item = (usize, TableAt<'a>)> {
    let numbered = tables.unwrap_or_default().into_iter().zip(1..);
    numbered.filter_map(|(table, number)| Some((number, table?)))
}
