//! The coordinates of joints with an orientation: a position, and the orientation as a quaternion, by roll, pitch and yaw,
//! or by an axis and an angle.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use redysim_model::joint::EulerSequence;
use redysim_model::rotation::roll_pitch_yaw;
use redysim_model::spatial::Mat3;
use redysim_toml::{Field, Key, KeyPath, Message, Reader, Value};

use super::keys;
use crate::euler_angles::euler_angles;
use crate::layout::{Joint, Layout};

/// How far the square of the length of a quaternion may be from 1 to be left as it is: a quaternion that was normalised
/// before keeps its bits.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// An orientation as a scenario gives it.
#[derive(Clone, Copy, Debug)]
pub enum Orientation {
    /// x, y, z, w, of any length but zero.
    Quaternion([f64; 4]),
    /// Roll, pitch and yaw, rad.
    Rpy([f64; 3]),
    /// The axis, of any length but zero, and the angle, rad.
    AxisAngle([f64; 3], f64),
}

impl Orientation {
    /// As a quaternion x, y, z, w.
    pub fn quaternion(self) -> [f64; 4] {
        match self {
            Orientation::Quaternion(quaternion) => quaternion,
            Orientation::Rpy([roll, pitch, yaw]) => UnitQuaternion::from_euler_angles(roll, pitch, yaw).coords.into(),
            Orientation::AxisAngle(axis, angle) => {
                let axis = Vector3::from(axis).normalize();
                UnitQuaternion::from_scaled_axis(axis * angle).coords.into()
            }
        }
    }

    /// As Euler angles. Those of roll, pitch and yaw are exact at quarter turns.
    fn euler_angles(self, sequence: EulerSequence) -> [f64; 3] {
        let rotation = match self {
            Orientation::Rpy(rpy) => roll_pitch_yaw(rpy),
            _ => {
                let quaternion = UnitQuaternion::new_normalize(Quaternion::from(self.quaternion()));
                let rotation = quaternion.to_rotation_matrix();
                Mat3::from_fn(|i, j| rotation[(i, j)])
            }
        };
        euler_angles(&rotation, sequence)
    }
}

/// The coordinates of a joint with the orientation, at the position if the joint has one; the default of each part is neutral.
pub fn position_of(joint: &Joint, xyz: Option<[f64; 3]>, orientation: Option<Orientation>) -> Vec<f64> {
    let orientation = match joint.euler_sequence() {
        Some(sequence) => orientation.map_or([0.0; 3], |given| given.euler_angles(sequence)).to_vec(),
        None => orientation.map_or([0.0, 0.0, 0.0, 1.0], Orientation::quaternion).to_vec(),
    };
    let position = xyz.unwrap_or_default();
    position[..joint.q.len() - orientation.len()].iter().chain(&orientation).copied().collect()
}

/// Reads the table of a joint's position.
pub fn coordinates(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>, joint: &Joint) -> Option<Vec<f64>> {
    let keys = if joint.v.len() > 3 { &keys::FREE_POSITION } else { &keys::SPHERICAL_POSITION };
    let mut reader = reader.table_at(path, value, keys)?;
    let xyz = reader.vector(&keys::JOINT_XYZ);
    let quaternion = reader.field(&keys::QUATERNION, |reader, path, value| {
        let array = reader.array(path, value, "an array of 4 numbers: x, y, z, w")?;
        let numbers = reader.elements(path, array, |reader, path, value| reader.parse_number(path, value))?;
        let found = numbers.len();
        let Ok(quaternion) = <[f64; 4]>::try_from(numbers) else {
            return reader.wrong_length(path, value, "4 numbers: x, y, z, w", found);
        };
        match square(&quaternion) == 0.0 {
            true => zero_quaternion(reader, path, value, joint),
            false => Some(quaternion),
        }
    });
    let rpy = reader.angles(&keys::JOINT_RPY);
    let axis = reader.vector(&keys::AXIS);
    if let Some(zero) = axis.spanned().filter(|axis| *axis.get_ref() == [0.0; 3]) {
        let title = format!("{}: `{path}.{}` is [0, 0, 0], which has no direction", reader.item(), keys::AXIS.name);
        let help = "give the axis of the rotation, of any length, as in [0, 0, 1]".to_owned();
        return reader.error_at(zero.span(), Message { title, label: "no direction".into(), help });
    }
    let angle = match axis.is_missing() {
        true => reader.angle(&keys::ANGLE),
        false => reader.required(&keys::ANGLE, Reader::angle),
    };
    if axis.is_missing() && !angle.is_missing() {
        reader.required::<[f64; 3]>(&keys::AXIS, |_, _| Field::Missing);
    }
    let given = [(keys::QUATERNION, !quaternion.is_missing()), (keys::JOINT_RPY, !rpy.is_missing())];
    let given: Vec<Key> =
        given.into_iter().chain([(keys::AXIS, !axis.is_missing())]).filter(|of| of.1).map(|of| of.0).collect();
    if let [first, second, ..] = given[..] {
        let title = format!(
            "{}: `{path}` gives its orientation twice, by `{}` and by `{}`",
            reader.item(),
            first.name,
            second.name
        );
        return reader.error_of_table(Message { title, label: "twice".into(), help: "keep one of them".into() });
    }
    let (quaternion, rpy) = (optional(&quaternion)?, optional(&rpy)?);
    let axis_angle = optional(&axis)?.zip(optional(&angle)?);
    let orientation = quaternion.map(Orientation::Quaternion).or(rpy.map(Orientation::Rpy));
    let orientation = orientation.or(axis_angle.map(|(axis, angle)| Orientation::AxisAngle(axis, angle)));
    Some(position_of(joint, optional(&xyz)?, orientation))
}

/// A value that may be missing; `None` if it is invalid.
fn optional<T: Copy>(field: &Field<T>) -> Option<Option<T>> {
    match field {
        Field::Missing => Some(None),
        given => given.value().map(|value| Some(*value)),
    }
}

/// Scales the quaternions among `values`, those of the coordinates `of`, to length 1; fails if one is zero.
pub fn normalise(
    reader: &mut Reader<'_, '_>,
    path: &KeyPath,
    value: &Value<'_>,
    layout: &Layout,
    of: &[usize],
    values: &mut [f64],
) -> Option<()> {
    for joint in layout.joints.iter().filter(|joint| joint.is_in_space()) {
        let Some(at) = of.iter().position(|&index| index == joint.orientation().start) else { continue };
        let quaternion = &mut values[at..at + 4];
        let square = square(quaternion);
        if square == 0.0 {
            return zero_quaternion(reader, path, value, joint);
        }
        if (square - 1.0).abs() > ROUNDING {
            let length = square.sqrt();
            quaternion.iter_mut().for_each(|component| *component /= length);
        }
    }
    Some(())
}

/// The square of the length.
fn square(quaternion: &[f64]) -> f64 {
    quaternion.iter().map(|component| component * component).sum()
}

/// Reports a quaternion of length zero. Always `None`.
fn zero_quaternion<T>(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>, joint: &Joint) -> Option<T> {
    let name = &joint.name;
    let title =
        format!("{}: `{path}` gives the joint `{name}` the quaternion [0, 0, 0, 0], which is invalid", reader.item());
    let help = format!(
        "a quaternion is x, y, z, w, and 0, 0, 0, 1 by default: give one that is not zero, or give the orientation by angles, \
         as in {} = {{ {name} = {{ {} }} }}",
        keys::Q.name,
        keys::JOINT_RPY.example()
    );
    reader.error(value, Message { title, label: "a zero quaternion".into(), help })
}
