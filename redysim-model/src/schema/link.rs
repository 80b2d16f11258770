//! A `[[link]]` table.

use super::item::item;
use super::origin::origin;
use super::{hints, keys};
use crate::joint::{EulerSequence, Joint, LinkJoint, Measure};
use crate::messages;
use crate::model::{Inertia, JointKind, JointRange};
use crate::per_velocity::PerVelocity;
use crate::spatial::Pose;
use redysim_toml::{DeValue, Field, Findings, Key, KeyPath, Reader, Spanned, TableAt, Value, name_of};
use std::ops::Range;

/// A `[[link]]` table.
#[derive(Debug)]
pub(crate) struct LinkTable {
    /// What messages call the link.
    pub(crate) item: String,
    /// The place of `[[link]]`.
    pub(crate) header: Range<usize>,
    pub(crate) name: Field<String>,
    pub(crate) joint_name: Field<String>,
    pub(crate) parent: Field<String>,
    pub(crate) joint: Field<JointKind>,
    pub(crate) dh: Field<Dh>,
    pub(crate) dh_standard: Field<DhStandard>,
    pub(crate) origin: Field<Pose<f64>>,
    pub(crate) axis: Field<[f64; 3]>,
    pub(crate) offset: Field<f64>,
    pub(crate) far_end: Field<Pose<f64>>,
    pub(crate) pitch: Field<f64>,
    pub(crate) coordinates: Field<EulerSequence>,
    pub(crate) mass: Field<f64>,
    pub(crate) com: Field<[f64; 3]>,
    pub(crate) inertia: Field<Inertia>,
    pub(crate) physics: PhysicsKeys,
    pub(crate) mimic: Field<MimicTable>,
    pub(crate) actuated: Field<PerVelocity<bool>>,
    /// For each velocity of the joint.
    pub(crate) range: Field<Vec<JointRange>>,
    /// The coordinates at which the options hold the joint.
    pub(crate) locked: Option<Vec<f64>>,
}

/// The table `mimic`: the joint that is followed, by its name or that of its link, and how.
#[derive(Clone, Debug)]
pub(crate) struct MimicTable {
    /// `None` if it cannot be read.
    pub(crate) joint: Option<Spanned<String>>,
    pub(crate) multiplier: f64,
    /// The place of the multiplier, if it is given.
    pub(crate) multiplier_place: Option<Range<usize>>,
    pub(crate) offset: f64,
}

/// The keys of what acts in the joint itself.
#[derive(Debug)]
pub(crate) struct PhysicsKeys {
    pub(crate) armature: Field<PerVelocity<f64>>,
    pub(crate) damping: Field<PerVelocity<f64>>,
    pub(crate) friction: Field<PerVelocity<f64>>,
    pub(crate) friction_velocity: Field<PerVelocity<f64>>,
    pub(crate) stiffness: Field<PerVelocity<f64>>,
    pub(crate) rest: Field<Vec<f64>>,
}

impl PhysicsKeys {
    /// Of the joint `motion`, as far as it can be read.
    fn read(reader: &mut Reader<'_, '_>, motion: Option<LinkJoint>) -> PhysicsKeys {
        let mut not_negative = |key: &Key| {
            per_velocity_in_one_unit(reader, key, motion, |reader, path, value, _| {
                let number = reader.parse_number(path, value)?;
                if number < 0.0 {
                    return reader.error(value, messages::negative_physics(reader.item(), key.name, path, number));
                }
                Some(number)
            })
        };
        PhysicsKeys {
            armature: not_negative(&keys::ARMATURE),
            damping: not_negative(&keys::DAMPING),
            friction: not_negative(&keys::FRICTION),
            stiffness: not_negative(&keys::STIFFNESS),
            friction_velocity: per_velocity_in_one_unit(
                reader,
                &keys::FRICTION_VELOCITY,
                motion,
                |reader, path, value, measure| {
                    let speed = reader.parse_displacement(path, value, measure == Measure::Angle, "/s")?;
                    if speed <= 0.0 {
                        let message = messages::friction_velocity_not_positive(reader.item(), path, speed);
                        return reader.error(value, message);
                    }
                    Some(speed)
                },
            ),
            rest: reader.field(&keys::REST, |reader, path, value| {
                coordinates(motion.unwrap_or(Joint::Revolute.into()), path, value, reader)
            }),
        }
    }

    /// The keys that are given, each with its place.
    pub(crate) fn given(&self) -> impl Iterator<Item = (&'static Key, Range<usize>)> {
        let per_velocity = [
            (&keys::ARMATURE, &self.armature),
            (&keys::DAMPING, &self.damping),
            (&keys::FRICTION, &self.friction),
            (&keys::FRICTION_VELOCITY, &self.friction_velocity),
            (&keys::STIFFNESS, &self.stiffness),
        ];
        let places = per_velocity.map(|(key, field)| (key, field.spanned().map(Spanned::span)));
        let rest = [(&keys::REST, self.rest.spanned().map(Spanned::span))];
        places.into_iter().chain(rest).filter_map(|(key, place)| Some((key, place?)))
    }
}

/// [`per_velocity`], where one number for all velocities of a joint needs them to have one unit.
fn per_velocity_in_one_unit<T>(
    reader: &mut Reader<'_, '_>,
    key: &Key,
    motion: Option<LinkJoint>,
    read: impl Fn(&mut Reader<'_, '_>, &KeyPath, &Value<'_>, Measure) -> Option<T>,
) -> Field<PerVelocity<T>> {
    let field = per_velocity(reader, key, motion, read);
    let joint = motion.filter(|joint| joint.velocity_measures().windows(2).any(|pair| pair[0] != pair[1]));
    match (&field, joint) {
        (Field::Value(value), Some(joint)) if matches!(value.get_ref(), PerVelocity::Uniform(_)) => {
            let message = messages::one_number_for_two_units(reader.item(), key, joint.velocity_names());
            reader.error_at::<()>(value.span(), message);
            Field::Invalid
        }
        _ => field,
    }
}

/// A coordinate: of a joint that turns, in radians.
fn position(reader: &mut Reader<'_, '_>, key: &Key, turns: bool) -> Field<f64> {
    reader.field(key, |reader, path, value| reader.parse_position(path, value, turns))
}

/// Khalil-Kleinfinger parameters: the link's frame stands in its parent's at Rx(alpha) Tx(a) Rz(theta) Tz(b).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Dh {
    pub(crate) a: f64,
    pub(crate) alpha: f64,
    pub(crate) b: f64,
    pub(crate) theta: f64,
}

/// Standard (distal) parameters: the link's frame stands in its parent's at Rz(theta) Tz(d) Tx(a) Rx(alpha).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DhStandard {
    pub(crate) a: f64,
    pub(crate) alpha: f64,
    pub(crate) d: f64,
    pub(crate) theta: f64,
}

impl LinkTable {
    /// Reads the `number`-th link of the file.
    pub(super) fn read(at: TableAt<'_>, number: usize, findings: &mut Findings) -> LinkTable {
        let item = item("link", &at, number);
        let mut reader = Reader::new(at.table, at.header.clone(), &item, &keys::LINK, findings);
        let name = reader.required(&keys::NAME, Reader::text);
        let parent = reader.required(&keys::PARENT, Reader::text);
        let joint = reader.required(&keys::JOINT, joint_kind);
        let pitch = match joint.value() {
            Some(JointKind::Helical) => reader.required(&keys::PITCH, Reader::number),
            _ => reader.number(&keys::PITCH),
        };
        let kind = joint.value().copied();
        let turns = kind != Some(JointKind::Prismatic);
        let coordinates = named(&mut reader, &keys::COORDINATES, &EulerSequence::ALL);
        let motion = kind.and_then(|kind| LinkJoint::of_kind(kind, 0.0, coordinates.value().copied()));
        LinkTable {
            name,
            joint_name: reader.text(&keys::JOINT_NAME),
            parent,
            joint,
            dh: reader.table(&keys::DH, dh),
            dh_standard: reader.table(&keys::DH_STANDARD, dh_standard),
            origin: reader.table(&keys::ORIGIN, origin),
            axis: reader.vector(&keys::AXIS),
            offset: position(&mut reader, &keys::OFFSET, turns),
            far_end: reader.table(&keys::FAR_END, origin),
            pitch,
            coordinates,
            mass: reader.required(&keys::MASS, Reader::number),
            com: reader.vector(&keys::COM),
            inertia: reader.table(&keys::INERTIA, inertia),
            physics: PhysicsKeys::read(&mut reader, motion),
            mimic: reader.table(&keys::MIMIC, |reader| mimic(reader, turns)),
            actuated: actuated(&mut reader, motion),
            range: ranges(&mut reader, motion, turns),
            locked: None,
            item,
            header: at.header,
        }
    }

    /// Whether the link is part of its parent's body; a joint of unreadable kind is taken for one that moves.
    pub(crate) fn is_rigid(&self) -> bool {
        self.locked.is_some() || self.joint.value() == Some(&JointKind::Fixed)
    }

    /// Whether the joint adds coordinates to the mechanism: it moves and does not mimic another.
    pub(crate) fn is_independent(&self) -> bool {
        !self.is_rigid() && self.mimic.is_missing()
    }

    /// What the joint does, as far as it can be read; `None` if it is fixed or of an unreadable kind.
    pub(crate) fn motion(&self) -> Option<LinkJoint> {
        let pitch = self.pitch.value().copied().unwrap_or_default();
        LinkJoint::of_kind(*self.joint.value()?, pitch, self.coordinates.value().copied())
    }

    /// Whether each velocity of the joint has an actuator, as far as it can be read.
    pub(crate) fn actuated_velocities(&self) -> Vec<bool> {
        let actuated = self.actuated.value().unwrap_or(&PerVelocity::Uniform(true));
        actuated.of_velocities(self.motion().map_or(1, LinkJoint::nv), true)
    }

    /// Where faults of the link as a whole are shown.
    pub(crate) fn place(&self) -> Range<usize> {
        self.name.spanned().map_or(self.header.clone(), Spanned::span)
    }

    /// The joint's name: the link's unless the file gives one.
    pub(crate) fn joint_name(&self) -> Option<&Spanned<String>> {
        if self.joint_name.is_missing() { self.name.spanned() } else { self.joint_name.spanned() }
    }
}

/// One value for the joint as a whole, or an array with one for each of several velocities; `read` has what the integral
/// of the velocity measures.
fn per_velocity<T>(
    reader: &mut Reader<'_, '_>,
    key: &Key,
    motion: Option<LinkJoint>,
    read: impl Fn(&mut Reader<'_, '_>, &KeyPath, &Value<'_>, Measure) -> Option<T>,
) -> Field<PerVelocity<T>> {
    let measures = motion.map_or(vec![Measure::Angle], LinkJoint::velocity_measures);
    reader.field(key, |reader, path, value| {
        let array = match value.get_ref() {
            DeValue::Array(array) if measures.len() > 1 => array,
            _ => return read(reader, path, value, measures[0]).map(PerVelocity::Uniform),
        };
        // Every element is read, so that each error among them is reported.
        let each: Vec<Option<T>> = array
            .iter()
            .enumerate()
            .map(|(i, value)| read(reader, &path.element(i), value, *measures.get(i).unwrap_or(&Measure::Angle)))
            .collect();
        let count = measures.len();
        if count != array.len() {
            let wanted = format!("{count} values, one for each velocity of the joint");
            return reader.wrong_length(path, value, &wanted, array.len());
        }
        each.into_iter().collect::<Option<Vec<T>>>().map(PerVelocity::Each)
    })
}

/// Whether an actuator moves the joint, as a whole or by each of its velocities.
fn actuated(reader: &mut Reader<'_, '_>, motion: Option<LinkJoint>) -> Field<PerVelocity<bool>> {
    per_velocity(reader, &keys::ACTUATED, motion, |reader, path, value, _| match value.get_ref() {
        DeValue::Boolean(flag) => Some(*flag),
        _ => reader.wrong_type(path, value, "true or false"),
    })
}

/// The coordinates of a joint: a number, or an array of several.
pub(super) fn coordinates<'a>(
    joint: LinkJoint,
    path: &KeyPath,
    value: &'a Value<'a>,
    reader: &mut Reader<'a, '_>,
) -> Option<Vec<f64>> {
    let angles: Vec<bool> = joint.coordinate_measures().iter().map(|measure| *measure == Measure::Angle).collect();
    if let [turns] = angles[..] {
        return reader.parse_position(path, value, turns).map(|value| vec![value]);
    }
    let count = angles.len();
    let wanted = format!("{count} numbers");
    let array = reader.array(path, value, &format!("an array of {wanted}"))?;
    let values: Vec<Option<f64>> = array
        .iter()
        .enumerate()
        .map(|(i, value)| reader.parse_position(&path.element(i), value, angles.get(i).copied().unwrap_or_default()))
        .collect();
    if array.len() != count {
        return reader.wrong_length(path, value, &wanted, array.len());
    }
    let values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
    if joint.has_no_orientation_at(&values) {
        return reader.error(value, messages::without_orientation(reader.item(), path));
    }
    Some(values)
}

/// The kind of a joint. Names of other formats lead to those of this one.
fn joint_kind(reader: &mut Reader<'_, '_>, key: &Key) -> Field<JointKind> {
    reader.field(key, |reader, path, value| {
        let Some(found) = name_of(value) else { return reader.wrong_type(path, value, "a string") };
        let lower = found.to_lowercase();
        let known = JointKind::ALL.iter().any(|(name, _)| *name == found);
        match hints::JOINT_KINDS.iter().find(|(names, _)| !known && names.contains(&lower.as_str())) {
            Some((_, help)) => reader.error(value, messages::foreign_joint_kind(reader.item(), path, found, help)),
            None => reader.choose(path, value, found, &JointKind::ALL),
        }
    })
}

/// One of several names, each of which stands for something.
fn named<T: Copy>(reader: &mut Reader<'_, '_>, key: &Key, choices: &[(&'static str, T)]) -> Field<T> {
    reader.field(key, |reader, path, value| {
        let Some(found) = name_of(value) else { return reader.wrong_type(path, value, "a string") };
        reader.choose(path, value, found, choices)
    })
}

// Invalid entries become zero here; the error that was reported makes the whole table invalid.

fn dh(mut reader: Reader<'_, '_>) -> Dh {
    Dh {
        a: reader.number(&keys::DH_A).value_or(0.0).unwrap_or_default(),
        alpha: reader.angle(&keys::DH_ALPHA).value_or(0.0).unwrap_or_default(),
        b: reader.number(&keys::DH_B).value_or(0.0).unwrap_or_default(),
        theta: reader.angle(&keys::DH_THETA).value_or(0.0).unwrap_or_default(),
    }
}

fn dh_standard(mut reader: Reader<'_, '_>) -> DhStandard {
    DhStandard {
        a: reader.number(&keys::DH_A).value_or(0.0).unwrap_or_default(),
        alpha: reader.angle(&keys::DH_ALPHA).value_or(0.0).unwrap_or_default(),
        d: reader.number(&keys::DH_D).value_or(0.0).unwrap_or_default(),
        theta: reader.angle(&keys::DH_THETA).value_or(0.0).unwrap_or_default(),
    }
}

/// Of a joint that turns, in radians.
fn mimic(mut reader: Reader<'_, '_>, turns: bool) -> MimicTable {
    let multiplier = reader.number(&keys::MULTIPLIER);
    MimicTable {
        joint: reader.required(&keys::MIMIC_JOINT, Reader::text).spanned().cloned(),
        multiplier: multiplier.value_or(1.0).unwrap_or(1.0),
        multiplier_place: multiplier.spanned().map(Spanned::span),
        offset: position(&mut reader, &keys::MIMIC_OFFSET, turns).value_or(0.0).unwrap_or_default(),
    }
}

/// A table, or an array with one for each velocity of a joint with several degrees of freedom.
fn ranges(reader: &mut Reader<'_, '_>, joint: Option<LinkJoint>, turns: bool) -> Field<Vec<JointRange>> {
    reader.field(&keys::RANGE, |reader, path, value| {
        let measures = joint.map(LinkJoint::velocity_measures).filter(|measures| measures.len() > 1);
        let Some(measures) = measures else {
            return Some(vec![range(reader.table_at(path, value, &keys::RANGE_KEYS)?, turns)]);
        };
        let wanted = format!("{} tables, one for each velocity of the joint", measures.len());
        let array = reader.array(path, value, &format!("an array of {wanted}"))?;
        if array.len() != measures.len() {
            return reader.wrong_length(path, value, &wanted, array.len());
        }
        let each = array.iter().zip(measures).enumerate().map(|(index, (value, measure))| {
            let inner = reader.table_at(&path.element(index), value, &keys::RANGE_KEYS)?;
            Some(range(inner, measure == Measure::Angle))
        });
        each.collect::<Vec<_>>().into_iter().collect()
    })
}

/// Of a velocity that turns, in radians.
fn range(mut reader: Reader<'_, '_>, turns: bool) -> JointRange {
    let velocity = reader.required(&keys::VELOCITY, |reader, key| largest(reader, key, turns, "/s"));
    let velocity = velocity.value_or(0.0).unwrap_or_default();
    let acceleration = largest(&mut reader, &keys::ACCELERATION, turns, "/s^2").value().copied();
    let position = reader.required(&keys::POSITION, |reader, key| bounds(reader, key, turns));
    let position = position.value_or([0.0; 2]).unwrap_or_default();
    let force = reader.positive(&keys::FORCE);
    JointRange { position, velocity, acceleration, force: force.value().copied() }
}

/// A least and a largest coordinate: of a joint that turns, in radians.
fn bounds(reader: &mut Reader<'_, '_>, key: &Key, turns: bool) -> Field<[f64; 2]> {
    reader.field(key, |reader, path, value| {
        let array = reader.array(path, value, "an array of 2 numbers")?;
        let elements =
            reader.elements(path, array, |reader, path, value| reader.parse_displacement(path, value, turns, ""));
        if array.len() != 2 {
            return reader.wrong_length(path, value, "2 numbers", array.len());
        }
        let bounds: [f64; 2] = elements?.try_into().ok()?;
        if bounds[0] > bounds[1] {
            return reader.error(value, messages::empty_range(reader.item(), path, bounds));
        }
        Some(bounds)
    })
}

/// The largest size of a rate `per` something: of a joint that turns, in radians.
fn largest(reader: &mut Reader<'_, '_>, key: &Key, turns: bool, per: &str) -> Field<f64> {
    reader.field(key, |reader, path, value| {
        let largest = reader.parse_displacement(path, value, turns, per)?;
        if largest < 0.0 {
            return reader.error(value, messages::negative_range(reader.item(), path, largest));
        }
        Some(largest)
    })
}

fn inertia(mut reader: Reader<'_, '_>) -> Inertia {
    let mut element = |key| reader.number(key).value_or(0.0).unwrap_or_default();
    Inertia {
        xx: element(&keys::XX),
        yy: element(&keys::YY),
        zz: element(&keys::ZZ),
        xy: element(&keys::XY),
        yz: element(&keys::YZ),
        xz: element(&keys::XZ),
    }
}
