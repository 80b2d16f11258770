//! Values for the coordinates or velocities of joints.

use std::borrow::Cow;
use std::ops::Range;

use redysim_toml::{DeValue, Field, Key, KeyPath, Message, Reader, Spanned, Value};

use super::chosen::{Name, not_a};
use super::in_space;
use super::resolution::resolved;
use crate::layout::{Component, Layout, StatePart};

/// What the values for joints are.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Coordinates: angles may have a unit.
    Coordinate,
    /// Rates of coordinates: likewise, without a warning about more than a turn.
    Rate,
    /// Gains: plain numbers, and one number is that of all joints.
    Gain,
    /// Limits of forces: likewise, above zero, and infinite where they are missing.
    Limit,
    /// Rates of anti-windup: as gains, zero or above.
    TrackingRate,
}

impl Quantity {
    /// Whether one number may stand for those of all joints.
    fn may_be_uniform(self) -> bool {
        matches!(self, Quantity::Gain | Quantity::Limit | Quantity::TrackingRate)
    }

    /// What the values are for: coordinates, or velocities.
    fn part(self) -> StatePart {
        if self == Quantity::Coordinate { StatePart::Coordinates } else { StatePart::Velocities }
    }
}

/// One value for each of `of`, indices of coordinates or velocities: an array in their order, or a table by their
/// names, in which missing coordinates are those of the neutral position, missing limits infinite, and other missing
/// values zero. In a table, all components of a joint that has several may stand under its name, in their own order. Quaternions have
/// length 1.
pub fn values(
    reader: &mut Reader<'_, '_>,
    key: &Key,
    quantity: Quantity,
    layout: &Layout,
    of: &[usize],
) -> Field<Vec<f64>> {
    reader.field(key, |reader, path, value| list(reader, path, value, quantity, layout, of))
}

/// Limits of forces, one for each of the velocities `of`, which are above zero: as [`values`] reads them, or "range", which
/// stands for the `force` of the range of each, as `range_force` has it.
pub fn limits(
    reader: &mut Reader<'_, '_>,
    key: &Key,
    layout: &Layout,
    of: &[usize],
    range_force: impl Fn(usize) -> Option<f64>,
) -> Field<Vec<f64>> {
    reader.field(key, |reader, path, value| {
        let DeValue::String(name) = value.get_ref() else {
            return list(reader, path, value, Quantity::Limit, layout, of);
        };
        reader.choose(path, value, name, &[("range", ())])?;
        let mut limits = Vec::new();
        for &velocity in of {
            let Some(force) = range_force(velocity) else {
                let whose = layout.first_of(&[velocity]).unwrap_or_default();
                let message = Message {
                    title: format!("{}: `{path}` is \"range\", and {whose} has no `range.force`", reader.item()),
                    label: "not known for every joint".into(),
                    help: format!(
                        "give `{}` a `force` in its `range` in the model, or write the limits here, N m or N",
                        layout.joint_of(velocity).name
                    ),
                };
                return reader.error(value, message);
            };
            limits.push(force);
        }
        Some(limits)
    })
}

/// Values for every point of a motion: an array of what [`values`] reads.
pub fn points(reader: &mut Reader<'_, '_>, key: &Key, layout: &Layout, of: &[usize]) -> Field<Vec<Vec<f64>>> {
    reader.field(key, |reader, path, value| {
        let array = reader.array(path, value, "an array with the coordinates of each point")?;
        let read = |reader: &mut _, path: &_, value| list(reader, path, value, Quantity::Coordinate, layout, of);
        reader.elements(path, array, read)
    })
}

/// The components that have the name, or whose joint has it.
fn named(reader: &mut Reader<'_, '_>, part: StatePart, name: &Name<'_>, layout: &Layout) -> Option<Range<usize>> {
    if let Some(components) = part.named(layout, name.text) {
        return Some(components);
    }
    if part.other().named(layout, name.text).is_some() {
        return not_a(reader, part, name, layout);
    }
    let several = layout.joints.iter().filter(|joint| joint.q.len() > 1).map(|joint| joint.name.as_str());
    let names = part.components(layout).iter().map(|component| component.name.as_str()).chain(several);
    let names: Vec<_> = names.enumerate().map(|(index, name)| (name, index)).collect();
    reader.lookup(name.place.clone(), "joint", name.text, &names).map(|index| index..index + 1)
}

/// Reports a joint or a component that the values are not for. Always `None`.
fn foreign<T>(reader: &mut Reader<'_, '_>, Name { text, place, path }: &Name<'_>, layout: &Layout) -> Option<T> {
    let what = if layout.joints.iter().any(|joint| joint.name == *text) { "the joint " } else { "" };
    let title = format!("{}: `{path}` has nothing to do with {what}`{text}`", reader.item());
    let help = "leave it out, or name it among the `joints` here".into();
    reader.error_at(place.clone(), Message { title, label: "not one of its joints".into(), help })
}

/// Reports a component that is given both by its own name and by that of its joint. Always `None`.
fn again<T>(reader: &mut Reader<'_, '_>, Name { text, place, path }: &Name<'_>) -> Option<T> {
    let title = format!("{}: `{path}` gives `{text}` twice, once by itself and once with its joint", reader.item());
    let help = "leave one of them out".into();
    reader.error_at(place.clone(), Message { title, label: "given before".into(), help })
}

fn list(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    value: &Value<'_>,
    quantity: Quantity,
    layout: &Layout,
    of: &[usize],
) -> Option<Vec<f64>> {
    let mut values = unchecked(reader, path, value, quantity, layout, of)?;
    if quantity == Quantity::Coordinate {
        in_space::normalise(reader, path, value, layout, of, &mut values)?;
    }
    Some(values)
}

/// The values as they are given.
fn unchecked(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    value: &Value<'_>,
    quantity: Quantity,
    layout: &Layout,
    of: &[usize],
) -> Option<Vec<f64>> {
    let components = quantity.part().components(layout);
    match value.get_ref() {
        DeValue::Array(array) if array.len() != of.len() => {
            let names: Vec<_> = of.iter().map(|&index| components[index].name.as_str()).collect();
            let wanted = match &names[..] {
                [name] => format!("1 value, that of {name}"),
                names => format!("{} values, one for each of {}", names.len(), names.join(", ")),
            };
            reader.wrong_length(path, value, &wanted, array.len())
        }
        DeValue::Array(array) => {
            let pairs = array.iter().zip(of).enumerate();
            let read =
                pairs.map(|(i, (value, &index))| one(reader, &path.element(i), value, quantity, &components[index]));
            read.collect::<Vec<_>>().into_iter().collect()
        }
        DeValue::Table(table) => {
            let missing = |index: usize| match quantity {
                Quantity::Limit => f64::INFINITY,
                _ => components[index].neutral,
            };
            let mut values: Vec<f64> = of.iter().map(|&index| missing(index)).collect();
            let mut given = vec![false; of.len()];
            let mut read = |(name, value): (&Spanned<Cow<'_, str>>, &Value<'_>)| {
                let name = Name { text: name.get_ref(), place: name.span(), path };
                let all = named(reader, quantity.part(), &name, layout)?;
                let own: Vec<usize> = all.clone().filter_map(|index| of.iter().position(|&of| of == index)).collect();
                if own.is_empty() {
                    return foreign(reader, &name, layout);
                }
                if own.iter().any(|&at| given[at]) {
                    return again(reader, &name);
                }
                own.iter().for_each(|&at| given[at] = true);
                let path = path.entry(name.text);
                let found = match all.len() {
                    1 => vec![one(reader, &path, value, quantity, &components[all.start])?],
                    _ => {
                        let of: Vec<usize> = own.iter().map(|&at| of[at]).collect();
                        of_joint(reader, &path, value, quantity, layout, &of)?
                    }
                };
                own.iter().zip(found).for_each(|(&at, found)| values[at] = found);
                Some(())
            };
            // Every joint is read, so that each error among them is reported.
            table.iter().map(&mut read).collect::<Vec<_>>().into_iter().collect::<Option<()>>()?;
            Some(values)
        }
        DeValue::Integer(_) | DeValue::Float(_) if quantity.may_be_uniform() => {
            Some(vec![plain(reader, path, value, quantity)?; of.len()])
        }
        _ if quantity.may_be_uniform() => {
            reader.wrong_type(path, value, "a number, an array with one for each joint, or a table by their names")
        }
        _ => reader.wrong_type(path, value, "an array with a value for each joint, or a table by their names"),
    }
}

/// The values of those components `of` of a joint that has several, under its name: an array or the table of a position, of
/// all of them, or one number for all.
fn of_joint(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    value: &Value<'_>,
    quantity: Quantity,
    layout: &Layout,
    of: &[usize],
) -> Option<Vec<f64>> {
    let components = quantity.part().components(layout);
    let joint = &layout.joints[components[of[0]].joint];
    let names: Vec<&str> = of.iter().map(|&index| components[index].name.as_str()).collect();
    let is_part = of.len() < quantity.part().of_joint(joint).len();
    let (what, label, help) = match value.get_ref() {
        DeValue::Table(_) | DeValue::Array(_) if is_part => (
            format!("stands for all of the joint, but is for {} only", names.join(", ")),
            "more than that",
            format!("give it by its own name: \"{}\" = 0", names[0]),
        ),
        DeValue::Table(_) if quantity == Quantity::Coordinate && joint.has_orientation() => {
            return in_space::coordinates(reader, path, value, joint);
        }
        DeValue::Table(_) => (
            format!("must be an array, not a table, with a value for each of {}", names.join(", ")),
            "not an array",
            format!(
                "write for example `{} = [{}]`, or by one name `\"{}\" = 0`",
                joint.name,
                vec!["0"; names.len()].join(", "),
                names[0]
            ),
        ),
        _ => return unchecked(reader, path, value, quantity, layout, of),
    };
    let title = format!("{}: `{path}` {what}", reader.item());
    reader.error(value, Message { title, label: label.into(), help })
}

fn one(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    value: &Value<'_>,
    quantity: Quantity,
    component: &Component,
) -> Option<f64> {
    match quantity {
        Quantity::Coordinate if component.turns() => {
            let angle = reader.parse_angle(path, value)?;
            resolved(reader, value.span(), path, angle)
        }
        Quantity::Rate => reader.parse_displacement(path, value, component.turns(), "/s"),
        Quantity::Coordinate | Quantity::Gain | Quantity::Limit | Quantity::TrackingRate => {
            plain(reader, path, value, quantity)
        }
    }
}

/// A number without a unit.
fn plain(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>, quantity: Quantity) -> Option<f64> {
    match quantity {
        Quantity::Limit => reader.parse_positive(path, value),
        Quantity::TrackingRate => {
            not_negative(reader, path, value, "a negative rate adds to the windup: give zero or more")
        }
        Quantity::Gain => gain(reader, path, value),
        _ => reader.parse_number(path, value),
    }
}

/// A gain, with a warning if it is negative.
fn gain(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>) -> Option<f64> {
    let gain = reader.parse_number(path, value)?;
    if gain < 0.0 {
        let title = format!("{}: `{path}` is {gain:?}, and a negative gain drives away", reader.item());
        let help = "it multiplies the target less the position, or the desired less the actual velocity";
        reader.warning_at(value.span(), Message { title, label: "negative".into(), help: help.into() });
    }
    Some(gain)
}

/// A number that is zero or above. `help` is what to do about a negative one.
pub fn not_negative(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>, help: &str) -> Option<f64> {
    let number = reader.parse_number(path, value)?;
    if number < 0.0 {
        let title = format!("{}: `{path}` is {number:?}, and must not be negative", reader.item());
        return reader.error(value, Message { title, label: "negative".into(), help: help.into() });
    }
    Some(number)
}
