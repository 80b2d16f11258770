//! Rotations whose entries are exact at quarter turns, so that no noise such as cos(90°) = 6e-17 enters a model.

use crate::spatial::{Mat3, Vec3};
use redysim_runtime::unfused_sin_cos;
use std::f64::consts::FRAC_PI_2;

/// Quarter turns are recognised up to this many; beyond, neighbouring numbers are too far apart to mean one.
const MOST_QUARTER_TURNS: f64 = 1e6;

/// Sine and cosine of an angle in radians; exactly 0 or ±1 where the angle is a quarter turn k π/2 as nearly as a
/// `f64` can say it. The same bits on every processor.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    let turns = (angle / FRAC_PI_2).round();
    let off = (angle - turns * FRAC_PI_2).abs();
    if turns.abs() > MOST_QUARTER_TURNS || off > f64::EPSILON * angle.abs() {
        return unfused_sin_cos(angle);
    }
    match (turns as i64).rem_euclid(4) {
        0 => (0.0, 1.0),
        1 => (1.0, 0.0),
        2 => (0.0, -1.0),
        _ => (-1.0, 0.0),
    }
}

/// Rx: the rotation about x.
pub fn about_x(angle: f64) -> Mat3<f64> {
    let (sin, cos) = sin_cos(angle);
    Mat3([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])
}

/// Ry: the rotation about y.
pub fn about_y(angle: f64) -> Mat3<f64> {
    let (sin, cos) = sin_cos(angle);
    Mat3([[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]])
}

/// Rz: the rotation about z.
pub fn about_z(angle: f64) -> Mat3<f64> {
    let (sin, cos) = sin_cos(angle);
    Mat3([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
}

/// Rz(yaw) Ry(pitch) Rx(roll), the `rpy` of URDF.
pub fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> Mat3<f64> {
    about_z(yaw) * about_y(pitch) * about_x(roll)
}

/// A rotation that takes z to the unit vector `axis`: a signed permutation where the axis is one of the frame's.
pub fn align_z(axis: Vec3<f64>) -> Mat3<f64> {
    let least = (0..3).fold(0, |least, i| if axis[i].abs() < axis[least].abs() { i } else { least });
    let mut y = axis.cross(Mat3::identity().column(least));
    y = y.scale(1.0 / y.dot(y).sqrt());
    let x = y.cross(axis);
    Mat3::from_fn(|i, j| [x, y, axis][j][i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::approx_constant, reason = "as files write them")]
    fn quarter_turns_are_exact() {
        let cycle = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)];
        for k in -1000_i32..=1000 {
            let exact = cycle[k.rem_euclid(4) as usize];
            assert_eq!(sin_cos(f64::from(k) * FRAC_PI_2), exact, "{k} quarter turns");
        }
        assert_eq!(sin_cos(1.5707963267948966), (1.0, 0.0));
        assert_eq!(sin_cos(3.141592653589793), (0.0, -1.0));
        assert_eq!(sin_cos(4.71238898038469), (-1.0, 0.0));
    }

    #[test]
    fn angles_beside_a_quarter_turn_are_not_one() {
        for angle in [1e-300, FRAC_PI_2 + 1e-15, FRAC_PI_2 - 1e-15, FRAC_PI_2 + 4e-6] {
            assert_eq!(sin_cos(angle), unfused_sin_cos(angle));
        }
    }

    #[test]
    fn products_of_quarter_turns_are_signed_permutations() {
        for k in 0..64 {
            let quarter = |shift: i32| f64::from((k >> shift) & 3) * FRAC_PI_2;
            let rotation = roll_pitch_yaw([quarter(0), quarter(2), quarter(4)]);
            let entries = rotation.0.as_flattened();
            assert!(entries.iter().all(|entry| [-1.0, 0.0, 1.0].contains(entry)), "{rotation:?}");
            assert_eq!(rotation * rotation.transpose(), Mat3::identity());
        }
    }

    #[test]
    fn roll_is_applied_first() {
        let rotation = roll_pitch_yaw([FRAC_PI_2, 0.0, FRAC_PI_2]);
        assert_eq!(rotation, Mat3([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    }
}
