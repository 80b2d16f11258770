//! A `[[link]]` table.

use super::item::item;
use super::keys;
use super::origin::origin;
use crate::actuation::Actuation;
use crate::joint::{EulerSequence, LinkJoint, Measure};
use crate::messages;
use crate::model::{Inertia, JointKind, JointRange};
use crate::spatial::Pose;
use redysim_toml::{DeValue, Field, Findings, Key, Reader, Spanned, TableAt, Value, name_of};
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
    pub(crate) actuated: Field<Actuation>,
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
    pub(crate) armature: Field<f64>,
    pub(crate) damping: Field<f64>,
    pub(crate) friction: Field<f64>,
    pub(crate) friction_velocity: Field<f64>,
    pub(crate) stiffness: Field<f64>,
    pub(crate) rest: Field<f64>,
}

impl PhysicsKeys {
    /// Of a joint that turns, in radians.
    fn read(reader: &mut Reader<'_, '_>, turns: bool) -> PhysicsKeys {
        PhysicsKeys {
            armature: reader.number(&keys::ARMATURE),
            damping: reader.number(&keys::DAMPING),
            friction: reader.number(&keys::FRICTION),
            friction_velocity: displacement(reader, &keys::FRICTION_VELOCITY, turns, "/s"),
            stiffness: reader.number(&keys::STIFFNESS),
            rest: displacement(reader, &keys::REST, turns, ""),
        }
    }

    /// Every key with what is given for it.
    pub(crate) fn fields(&self) -> [(&'static Key, &Field<f64>); 6] {
        [
            (&keys::ARMATURE, &self.armature),
            (&keys::DAMPING, &self.damping),
            (&keys::FRICTION, &self.friction),
            (&keys::FRICTION_VELOCITY, &self.friction_velocity),
            (&keys::STIFFNESS, &self.stiffness),
            (&keys::REST, &self.rest),
        ]
    }
}

/// A coordinate, or its rate `per` something: of a joint that turns, in radians.
fn displacement(reader: &mut Reader<'_, '_>, key: &Key, turns: bool, per: &str) -> Field<f64> {
    reader.field(key, |reader, path, value| reader.parse_displacement(path, value, turns, per))
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
        let joint = reader.required(&keys::JOINT, |reader, key| named(reader, key, &JointKind::ALL));
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
            offset: displacement(&mut reader, &keys::OFFSET, turns, ""),
            far_end: reader.table(&keys::FAR_END, origin),
            pitch,
            coordinates,
            mass: reader.required(&keys::MASS, Reader::number),
            com: reader.vector(&keys::COM),
            inertia: reader.table(&keys::INERTIA, inertia),
            physics: PhysicsKeys::read(&mut reader, turns),
            mimic: reader.table(&keys::MIMIC, |reader| mimic(reader, turns)),
            actuated: actuated(&mut reader, kind),
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
        let actuated = self.actuated.value().unwrap_or(&Actuation::Uniform(true));
        actuated.of_velocities(self.motion().map_or(1, LinkJoint::nv))
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

/// `true` or `false` for the joint as a whole, or an array with one of them for each of its velocities.
fn actuated(reader: &mut Reader<'_, '_>, joint: Option<JointKind>) -> Field<Actuation> {
    reader.field(&keys::ACTUATED, |reader, path, value| {
        let flag = |value: &Value<'_>| match value.get_ref() {
            DeValue::Boolean(flag) => Some(*flag),
            _ => None,
        };
        let count = joint.map(JointKind::dof).filter(|count| *count > 1);
        let array = match value.get_ref() {
            DeValue::Array(array) if count.is_some() => array,
            _ => {
                return match flag(value) {
                    Some(flag) => Some(flag.into()),
                    None => reader.wrong_type(path, value, "true or false"),
                };
            }
        };
        let flags = reader.elements(path, array, |reader, path, value| {
            flag(value).or_else(|| reader.wrong_type(path, value, "true or false"))
        });
        match count {
            Some(count) if count != array.len() => reader.wrong_length(
                path,
                value,
                &format!("{count} values, one for each velocity of the joint"),
                array.len(),
            ),
            _ => Some(Actuation::PerVelocity(flags?)),
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
        offset: displacement(&mut reader, &keys::MIMIC_OFFSET, turns, "").value_or(0.0).unwrap_or_default(),
    }
}

/// A table, or an array with one for each velocity of a joint of several freedoms.
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
