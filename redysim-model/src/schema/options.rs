//! What is asked of a model, at the top of its file or beside it.

use super::keys;
use super::link::{LinkTable, coordinates};
use crate::joint::{Joint, LinkJoint};
use crate::lock::by_name;
use crate::messages;
use crate::model::JointKind;
use crate::options::AccelerationMethod;
use crate::run_time::{Quantity, RunTimeParameter};
use redysim_runtime::{Function, Functions};
use redysim_toml::{DeValue, Field, Findings, Reader, Spanned, Table, Text};
use std::ops::Range;

/// The options. Each key beside the file takes precedence over the file's.
#[derive(Debug)]
pub(crate) struct OptionsTable {
    pub(crate) functions: Entry<Field<RequestedFunctions>>,
    /// The joints that are locked. One whose value is invalid is locked at its zero position, so that the interface has the right
    /// number of joints.
    pub(crate) locked: Entry<Vec<Lock>>,
    pub(crate) tolerance: Entry<Field<f64>>,
    pub(crate) forward_dynamics: Entry<Field<AccelerationMethod>>,
    pub(crate) parameters: Entry<Field<Vec<Spanned<RunTimeParameter>>>>,
}

/// A joint held at a value.
#[derive(Clone, Debug)]
pub(crate) struct Lock {
    /// Index of the link in the document.
    pub(crate) link: usize,
    /// The coordinates, rad or m.
    pub(crate) values: Vec<f64>,
    /// The place of the joint's name.
    pub(crate) place: Range<usize>,
}

/// The value of a key, and the text that has it.
#[derive(Debug)]
pub(crate) struct Entry<T> {
    pub(crate) text: Text,
    pub(crate) value: T,
}

/// Functions that are requested, each with its place.
#[derive(Clone, Debug)]
pub(crate) struct RequestedFunctions(pub(crate) Vec<Spanned<Function>>);

impl RequestedFunctions {
    /// As a set.
    pub(crate) fn set(&self) -> Functions {
        Functions::of(self.0.iter().map(|function| *function.get_ref()))
    }
}

impl OptionsTable {
    /// Reads the options in the file and beside it. `links` is `None` if one of them cannot be read.
    pub(super) fn read(
        [file, beside]: [&Table<'_>; 2],
        item: &str,
        links: Option<&Vec<LinkTable>>,
        findings: &mut Findings,
    ) -> OptionsTable {
        let in_file = OptionFields::read(Reader::known(file, item, findings), links);
        let beside = findings.within(Text::Beside, |findings| {
            OptionFields::read(Reader::new(beside, 0..0, item, &keys::OPTIONS, findings), links)
        });
        OptionsTable {
            functions: first(beside.functions, in_file.functions),
            tolerance: first(beside.tolerance, in_file.tolerance),
            forward_dynamics: first(beside.forward_dynamics, in_file.forward_dynamics),
            parameters: first(beside.parameters, in_file.parameters),
            locked: match beside.locked {
                None => Entry { text: Text::File, value: in_file.locked.unwrap_or_default() },
                Some(locks) => Entry { text: Text::Beside, value: locks },
            },
        }
    }
}

/// The options of one text.
struct OptionFields {
    functions: Field<RequestedFunctions>,
    locked: Option<Vec<Lock>>,
    tolerance: Field<f64>,
    forward_dynamics: Field<AccelerationMethod>,
    parameters: Field<Vec<Spanned<RunTimeParameter>>>,
}

impl OptionFields {
    fn read(mut reader: Reader<'_, '_>, links: Option<&Vec<LinkTable>>) -> OptionFields {
        OptionFields {
            functions: functions(&mut reader),
            locked: locked(&mut reader, links),
            tolerance: tolerance(&mut reader),
            forward_dynamics: forward_dynamics(&mut reader),
            parameters: parameters(&mut reader, links),
        }
    }
}

fn first<T>(beside: Field<T>, in_file: Field<T>) -> Entry<Field<T>> {
    match beside {
        Field::Missing => Entry { text: Text::File, value: in_file },
        given => Entry { text: Text::Beside, value: given },
    }
}

fn tolerance(reader: &mut Reader<'_, '_>) -> Field<f64> {
    reader.field(&keys::TOLERANCE, |reader, path, value| {
        let tolerance = reader.parse_number(path, value)?;
        if tolerance <= 0.0 || tolerance >= 1.0 {
            return reader.error(value, messages::bad_tolerance(reader.item(), tolerance));
        }
        Some(tolerance)
    })
}

fn forward_dynamics(reader: &mut Reader<'_, '_>) -> Field<AccelerationMethod> {
    reader.field(&keys::FORWARD_DYNAMICS, |reader, path, value| {
        let DeValue::String(text) = value.get_ref() else {
            return reader.wrong_type(path, value, "the name of a way to compute accelerations");
        };
        match AccelerationMethod::NAMES.iter().find(|(name, _)| *name == text.as_ref()) {
            Some((_, method)) => Some(*method),
            None => reader.error(value, messages::unknown_acceleration_method(reader.item(), text)),
        }
    })
}

fn functions(reader: &mut Reader<'_, '_>) -> Field<RequestedFunctions> {
    reader.field(&keys::FUNCTIONS, |reader, path, value| {
        let array = reader.array(path, value, "an array of names of functions")?;
        if array.is_empty() {
            return reader.error(value, messages::no_functions(reader.item()));
        }
        let mut asked: Vec<Spanned<Function>> = Vec::new();
        for (index, value) in array.iter().enumerate() {
            let path = path.element(index);
            let DeValue::String(text) = value.get_ref() else {
                reader.wrong_type::<()>(&path, value, "the name of a function");
                continue;
            };
            match text.parse() {
                Err(_) => _ = reader.error::<()>(value, messages::unknown_function(reader.item(), text)),
                Ok(function) if asked.iter().any(|other| *other.get_ref() == function) => {
                    _ = reader.error::<()>(value, messages::repeated_function(reader.item(), function));
                }
                Ok(function) => asked.push(Spanned::new(value.span(), function)),
            }
        }
        Some(RequestedFunctions(asked))
    })
}

/// The locked joints. Where links cannot be read, one of them may be meant by any name, so names are not checked.
fn locked(reader: &mut Reader<'_, '_>, links: Option<&Vec<LinkTable>>) -> Option<Vec<Lock>> {
    let mut locks: Vec<Lock> = Vec::new();
    let field = reader.field(&keys::LOCKED, |reader, path, value| {
        let DeValue::Table(table) = value.get_ref() else {
            return reader.wrong_type(path, value, "a table of joints and values");
        };
        let links = links?;
        let mut pairs: Vec<_> = table.iter().collect();
        pairs.sort_by_key(|(name, _)| name.span().start);
        for (name, value) in pairs {
            let (name, place) = (name.get_ref().as_ref(), name.span());
            let Some(link) = joint(name, place.clone(), links, reader) else { continue };
            if locks.iter().any(|lock| lock.link == link) {
                reader.error_at::<()>(place.clone(), messages::locked_twice(reader.item(), name));
                continue;
            }
            let path = path.entry(name);
            let joint = links[link].motion().unwrap_or(Joint::Revolute.into());
            let values = coordinates(joint, &path, value, reader).unwrap_or_else(|| neutral(joint));
            locks.push(Lock { link, values, place });
        }
        Some(())
    });
    (!field.is_missing()).then_some(locks)
}

/// The coordinates of the zero position of a joint.
fn neutral(joint: LinkJoint) -> Vec<f64> {
    let mut coordinates = vec![0.0; joint.nq()];
    joint.neutral(&mut coordinates);
    coordinates
}

/// The parameters that are given at run time. Where links cannot be read, their names are not checked.
fn parameters(reader: &mut Reader<'_, '_>, links: Option<&Vec<LinkTable>>) -> Field<Vec<Spanned<RunTimeParameter>>> {
    reader.field(&keys::PARAMETERS, |reader, path, value| {
        let mut parameters: Vec<Spanned<RunTimeParameter>> = Vec::new();
        let names = reader.array(path, value, "an array of names of parameters")?;
        for (index, value) in names.iter().enumerate() {
            let DeValue::String(text) = value.get_ref() else {
                reader.wrong_type::<()>(&path.element(index), value, "the name of a parameter");
                continue;
            };
            let Some(parameter) = parameter(text, value.span(), links?, reader) else { continue };
            if parameters.iter().any(|other| *other.get_ref() == parameter) {
                reader.error::<()>(value, messages::repeated_parameter(reader.item(), text));
            } else {
                parameters.push(Spanned::new(value.span(), parameter));
            }
        }
        (!parameters.is_empty() || names.is_empty()).then_some(parameters)
    })
}

/// The parameter called `text`: `gravity`, or the name of a link or joint and a quantity that it has, with a dot
/// between them.
fn parameter(
    text: &str,
    place: Range<usize>,
    links: &[LinkTable],
    reader: &mut Reader<'_, '_>,
) -> Option<RunTimeParameter> {
    if text == Quantity::Gravity.name() {
        return Some(RunTimeParameter { quantity: Quantity::Gravity, link: None });
    }
    let Some((owner, quantity)) = text.rsplit_once('.') else {
        return reader.error_at(place, messages::unknown_parameter(reader.item(), text));
    };
    let known = |wanted: &str| Quantity::OF_LINKS.into_iter().find(|(name, _)| *name == wanted);
    let Some((written, quantity)) = known(quantity) else {
        let of_gravity = (Quantity::Gravity.name(), Quantity::Gravity);
        let whole = match owner.rsplit_once('.') {
            Some((_, of)) => known(of),
            None => Some(of_gravity).filter(|(name, _)| *name == owner),
        };
        let message = match whole {
            Some((_, whole)) => messages::component_of_parameter(reader.item(), text, owner, whole),
            None => messages::unknown_quantity(reader.item(), text, owner, quantity),
        };
        return reader.error_at(place, message);
    };
    let names = links.iter().map(|link| {
        let joint = link.joint_name().filter(|_| quantity.is_of_joint()).map(|name| name.get_ref().as_str());
        (joint, link.name.value().map(String::as_str))
    });
    match by_name(owner, names.clone()) {
        Some(link) => Some(RunTimeParameter { quantity, link: Some(link) }),
        None if links.iter().any(|link| link.name.value().is_none()) => None,
        None => {
            let owners: Vec<&str> = names.filter_map(|(joint, link)| joint.or(link)).collect();
            reader.error_at(place, messages::parameter_of_unknown(reader.item(), text, [owner, written], &owners))
        }
    }
}

/// The link whose joint is meant by `name`, if it is one that moves.
fn joint(name: &str, place: Range<usize>, links: &[LinkTable], reader: &mut Reader<'_, '_>) -> Option<usize> {
    let names = links.iter().map(|link| {
        let joint = link.joint_name().map(|name| name.get_ref().as_str());
        (joint, link.name.value().map(String::as_str))
    });
    let readable = names.clone().all(|(joint, link)| joint.is_some() && link.is_some());
    match by_name(name, names.clone()) {
        Some(link) if links[link].joint.value() == Some(&JointKind::Fixed) => {
            reader.error_at(place, messages::locked_fixed(reader.item(), name))
        }
        Some(link) if !links[link].mimic.is_missing() => {
            let followed = links[link].mimic.value().and_then(|mimic| mimic.joint.as_ref());
            let followed = followed.map_or("", |followed| followed.get_ref());
            reader.error_at(place, messages::locked_mimic(reader.item(), name, followed))
        }
        None if readable => {
            let moving = links.iter().zip(names).filter(|(link, _)| link.is_independent());
            let moving: Vec<&str> = moving.filter_map(|(_, (joint, _))| joint).collect();
            reader.error_at(place, messages::locked_unknown(reader.item(), name, &moving))
        }
        found => found,
    }
}
