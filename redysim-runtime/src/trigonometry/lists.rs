//! Which vectors lists of angles take: those of the target, up to 256 bits (see [`registers`](crate::registers)).

use super::several::{in_lanes, several};
use super::{double, single};
use crate::lanes::{F32x4, F32x8, F64x2, F64x4};

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f64<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    several(angles, double::sin_cos, in_two, in_four)
}

#[inline(always)]
fn in_two(angles: [f64; 2]) -> ([f64; 2], [f64; 2]) {
    in_lanes(angles, double::sin_cos::<F64x2>)
}

#[inline(always)]
fn in_four(angles: [f64; 4]) -> ([f64; 4], [f64; 4]) {
    in_lanes(angles, double::sin_cos::<F64x4>)
}

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f32<const N: usize>(angles: [f32; N]) -> ([f32; N], [f32; N]) {
    const VECTORS: bool = cfg!(any(
        target_feature = "sse2",
        all(target_arch = "aarch64", target_feature = "neon"),
        target_feature = "simd128"
    ));
    if cfg!(target_feature = "avx") {
        several(angles, single::sin_cos, in_four_single, in_eight_single)
    } else if VECTORS {
        several(angles, single::sin_cos, in_four_single, in_four_single)
    } else {
        several(angles, single::sin_cos, alone, alone)
    }
}

#[inline(always)]
fn in_four_single(angles: [f32; 4]) -> ([f32; 4], [f32; 4]) {
    in_lanes(angles, single::sin_cos::<F32x4>)
}

#[inline(always)]
fn in_eight_single(angles: [f32; 8]) -> ([f32; 8], [f32; 8]) {
    in_lanes(angles, single::sin_cos::<F32x8>)
}

#[inline(always)]
fn alone([angle]: [f32; 1]) -> ([f32; 1], [f32; 1]) {
    let (sin, cos) = single::sin_cos(angle);
    ([sin], [cos])
}
