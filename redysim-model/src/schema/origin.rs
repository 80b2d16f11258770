//! The pose of a frame: the tables `origin` and `far_end`.

use super::keys;
use crate::messages;
use crate::rotation::roll_pitch_yaw;
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_toml::{Field, Reader, Spanned};

/// How far the elements of R Rᵀ of a rotation matrix may be from those of the unit matrix. A matrix written with 13
/// digits or more is within it.
const ORTHONORMAL: f64 = 1e-12;

/// The pose that the table gives. An invalid entry becomes that of the identity; its error makes the whole table invalid.
pub(super) fn origin(mut reader: Reader<'_, '_>) -> Pose<f64> {
    let position = reader.vector(&keys::XYZ).value_or([0.0; 3]).unwrap_or_default();
    let angles = reader.angles(&keys::RPY);
    let matrix = reader.field(&keys::ROTATION, |reader, path, value| {
        let matrix = Mat3(reader.parse_matrix(path, value)?);
        match defect(matrix) {
            Some(defect) => reader.error(value, messages::not_a_rotation(reader.item(), path, defect)),
            None => Some(matrix),
        }
    });
    if let (Some(matrix), false) = (matrix.spanned(), angles.is_missing()) {
        reader.error_at::<()>(Spanned::span(matrix), messages::two_rotations(reader.item()));
    }
    let rotation = match matrix {
        Field::Missing => roll_pitch_yaw(angles.value_or([0.0; 3]).unwrap_or_default()),
        given => given.value_or(Mat3::identity()).unwrap_or_else(Mat3::identity),
    };
    Pose { rotation, position: Vec3(position) }.without_negative_zeros()
}

/// What keeps a matrix from being a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum RotationDefect {
    /// The largest error of an element of R Rᵀ = 1.
    NotOrthonormal(f64),
    /// It mirrors: its determinant is −1.
    Reflection,
}

fn defect(matrix: Mat3<f64>) -> Option<RotationDefect> {
    let error = (matrix * matrix.transpose() - Mat3::identity()).0;
    let largest = error.as_flattened().iter().fold(0.0, |largest: f64, element| largest.max(element.abs()));
    if largest > ORTHONORMAL {
        return Some(RotationDefect::NotOrthonormal(largest));
    }
    let [x, y, z] = [0, 1, 2].map(|column| matrix.column(column));
    (x.cross(y).dot(z) < 0.0).then_some(RotationDefect::Reflection)
}
