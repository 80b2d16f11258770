//! Which vectors lists of angles take: those of the target, up to 256 bits (see [`registers`](crate::registers)).

use super::several::several;
use super::single;
use crate::lanes::{F32x4, F32x8, F64x2, F64x4};
use crate::registers::VECTORS;

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f64<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    several::<f64, F64x2, F64x4, 2, 4, N>(angles)
}

/// Sines and cosines of all `angles`.
#[inline(always)]
pub fn of_f32<const N: usize>(angles: [f32; N]) -> ([f32; N], [f32; N]) {
    if cfg!(target_feature = "avx") {
        several::<f32, F32x4, F32x8, 4, 8, N>(angles)
    } else if VECTORS {
        several::<f32, F32x4, F32x4, 4, 4, N>(angles)
    } else {
        single::one_after_the_other(angles)
    }
}
