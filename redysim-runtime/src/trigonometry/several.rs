//! A list of angles spread over lanes.

use super::angle::Angle;
use crate::lanes::{F64x2, F64x4, F64x8, Lanes};

/// A sine and cosine, the same for any number of lanes.
pub trait Kernel {
    /// Sine and cosine of `x` radians, in every lane.
    fn sin_cos<A: Angle>(x: A) -> (A, A);
}

/// Sines and cosines of all `angles`, several at a time.
#[inline(always)]
pub fn several<K: Kernel, const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    if cfg!(target_feature = "avx512f") {
        in_lanes::<K, F64x8, 8>(&angles, &mut sines, &mut cosines);
    } else if cfg!(target_feature = "avx") {
        in_lanes::<K, F64x4, 4>(&angles, &mut sines, &mut cosines);
    } else {
        in_lanes::<K, F64x2, 2>(&angles, &mut sines, &mut cosines);
    }
    (sines, cosines)
}

#[inline(always)]
fn in_lanes<K: Kernel, L: Angle + Lanes<f64, W>, const W: usize>(
    angles: &[f64],
    sines: &mut [f64],
    cosines: &mut [f64],
) {
    let (angles, last) = angles.as_chunks::<W>();
    let (sines, last_sines) = sines.as_chunks_mut::<W>();
    let (cosines, last_cosines) = cosines.as_chunks_mut::<W>();
    for ((angles, sines), cosines) in angles.iter().zip(sines).zip(cosines) {
        let (sin, cos) = K::sin_cos(L::from(*angles));
        (*sines, *cosines) = (sin.into(), cos.into());
    }
    if last.len() > 1 {
        let padded: [f64; W] = core::array::from_fn(|lane| last.get(lane).copied().unwrap_or(0.0));
        let (sin, cos) = K::sin_cos(L::from(padded));
        for (to, from) in last_sines.iter_mut().zip(sin.into()).chain(last_cosines.iter_mut().zip(cos.into())) {
            *to = from;
        }
    } else {
        for ((angle, sine), cosine) in last.iter().zip(last_sines).zip(last_cosines) {
            (*sine, *cosine) = K::sin_cos(*angle);
        }
    }
}
