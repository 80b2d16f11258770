//! Which vectors lists of angles take: those of the target, up to 256 bits (see [`registers`](crate::registers)).

use super::several::{in_lanes, several};
use super::{double, single};
use crate::lanes::{F32x4, F32x8, F64x2, F64x4};

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f64<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    several(
        angles,
        double::sin_cos,
        |two: [f64; 2]| in_lanes::<F64x2, _, 2>(two, double::sin_cos),
        |four: [f64; 4]| in_lanes::<F64x4, _, 4>(four, double::sin_cos),
    )
}

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f32<const N: usize>(angles: [f32; N]) -> ([f32; N], [f32; N]) {
    let four = |four: [f32; 4]| in_lanes::<F32x4, _, 4>(four, single::sin_cos);
    if cfg!(target_feature = "avx") {
        several(angles, single::sin_cos, four, |eight: [f32; 8]| in_lanes::<F32x8, _, 8>(eight, single::sin_cos))
    } else if cfg!(any(
        target_feature = "sse2",
        all(target_arch = "aarch64", target_feature = "neon"),
        target_feature = "simd128"
    )) {
        several(angles, single::sin_cos, four, four)
    } else {
        // Without vectors, one after the other.
        let one = |[angle]: [f32; 1]| {
            let (sin, cos) = single::sin_cos(angle);
            ([sin], [cos])
        };
        several(angles, single::sin_cos, one, one)
    }
}
