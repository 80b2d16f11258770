//! The logarithm of a rotation.

use crate::Real;
use crate::linear_algebra::{largest, norm};
use crate::vector::entry;

/// The rotation vector of the rotation matrix `r` (by rows): axis times angle, the angle from 0 to π; at π, one of the
/// two.
///
/// Up to a quarter turn the axis is that of the skew-symmetric part, sin θ a; beyond, where sin θ fades, that of the
/// symmetric part, cos θ 1 + (1 − cos θ) a aᵀ, by the column of its largest diagonal element.
pub fn rotation_vector<S: Real>(r: &[[S; 3]; 3]) -> [S; 3] {
    let half = S::from_f64(0.5);
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = *r;
    let skew = [half * (zy - yz), half * (xz - zx), half * (yx - xy)];
    let (sin, cos) = (norm(&skew), half * (xx + yy + zz - S::one()));
    let angle = S::from_f64(libm::atan2(sin.to_f64(), cos.to_f64()));
    if cos >= S::zero() {
        let factor = if sin == S::zero() { S::one() } else { angle / sin };
        return skew.map(|element| factor * element);
    }
    let symmetric = [
        [xx - cos, half * (xy + yx), half * (xz + zx)],
        [half * (xy + yx), yy - cos, half * (yz + zy)],
        [half * (xz + zx), half * (yz + zy), zz - cos],
    ];
    let (_, at) = largest([xx - cos, yy - cos, zz - cos]);
    let column = symmetric.map(|row| entry(&row, at));
    let size = norm(&column);
    let along = skew.iter().zip(&column).fold(S::zero(), |sum, (&a, &b)| sum + a * b);
    let factor = if along < S::zero() { -(angle / size) } else { angle / size };
    column.map(|element| factor * element)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;

    /// Rodrigues' formula.
    fn rotation([x, y, z]: [f64; 3], angle: f64) -> [[f64; 3]; 3] {
        let (sin, cos) = angle.sin_cos();
        let c = 1.0 - cos;
        [
            [cos + c * x * x, c * x * y - sin * z, c * x * z + sin * y],
            [c * x * y + sin * z, cos + c * y * y, c * y * z - sin * x],
            [c * x * z - sin * y, c * y * z + sin * x, cos + c * z * z],
        ]
    }

    #[test]
    fn the_rotation_vector_is_axis_times_angle_up_to_a_half_turn() {
        for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [-0.48, 0.6, 0.64]] {
            for angle in [0.0, 1e-12, 1e-6, 0.3, 1.5, 1.6, 2.5, PI - 1e-6, PI - 1e-12] {
                let found = rotation_vector(&rotation(axis, angle));
                for (found, component) in found.iter().zip(axis) {
                    assert!((found - angle * component).abs() < 2e-15, "{axis:?} {angle}: {found}");
                }
            }
        }
        let half_turn = rotation_vector(&rotation([0.0, 0.6, 0.8], PI));
        assert!((norm(&half_turn) - PI).abs() < 1e-15 && half_turn[0].abs() < 1e-15, "{half_turn:?}");
    }
}
