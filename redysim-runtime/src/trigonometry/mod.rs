//! Sine and cosine without panics, of one angle or of several at once, the same bits either way.
//!
//! The angle is reduced to |r| ≤ π/4 with a tail that carries what a `f64` cannot: by subtracting π/2 in two parts, or,
//! where that is not enough (many quarter turns, or an angle beside a multiple of π/2), with more digits (`reduction`).
//! Then two polynomials in r², of least relative error (found by Remez exchange: 2⁻⁵⁷ for the sine, 2⁻⁵⁹ for the
//! cosine), are evaluated.
//!
//! Errors stay below 1 unit in the last place for every finite angle; non-finite angles give NaN.

mod lanes;
mod reduction;

use lanes::Lanes;
use wide::{f64x2, f64x4};

/// Sine and cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    lanes_sin_cos(x)
}

/// Sines and cosines of all `angles`, several at a time.
#[inline(always)]
pub fn sin_cos_all<const N: usize>(angles: [f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sines, mut cosines) = ([0.0; N], [0.0; N]);
    if cfg!(target_feature = "avx") {
        in_lanes::<f64x4, 4>(&angles, &mut sines, &mut cosines);
    } else {
        in_lanes::<f64x2, 2>(&angles, &mut sines, &mut cosines);
    }
    (sines, cosines)
}

#[inline(always)]
fn in_lanes<L: Lanes + From<[f64; W]> + Into<[f64; W]>, const W: usize>(
    angles: &[f64],
    sines: &mut [f64],
    cosines: &mut [f64],
) {
    let (angles, last) = angles.as_chunks::<W>();
    let (sines, last_sines) = sines.as_chunks_mut::<W>();
    let (cosines, last_cosines) = cosines.as_chunks_mut::<W>();
    for ((angles, sines), cosines) in angles.iter().zip(sines).zip(cosines) {
        let (sin, cos) = lanes_sin_cos(L::from(*angles));
        (*sines, *cosines) = (sin.into(), cos.into());
    }
    if last.len() > 1 {
        let padded: [f64; W] = core::array::from_fn(|lane| last.get(lane).copied().unwrap_or(0.0));
        let (sin, cos) = lanes_sin_cos(L::from(padded));
        for (to, from) in last_sines.iter_mut().zip(sin.into()).chain(last_cosines.iter_mut().zip(cos.into())) {
            *to = from;
        }
    } else {
        for ((angle, sine), cosine) in last.iter().zip(last_sines).zip(last_cosines) {
            (*sine, *cosine) = lanes_sin_cos(*angle);
        }
    }
}

/// 2¹⁷ quarter turns.
const MANY_TURNS: f64 = 205_887.0;
/// A rest smaller than this has lost too many digits to cancellation.
const TOO_SMALL: f64 = 1.0 / 4096.0;
/// π/2 in a part of 36 bits, of which multiples up to 2¹⁷ are exact, and one of 53.
const HALF_PI: [f64; 2] = [1.5707963267923333, 2.563344151594519e-12];
/// Added to a number below 2⁵¹ and taken away again, it leaves the nearest integer, and shows its bits in between.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Sine and cosine in every lane.
#[inline(always)]
fn lanes_sin_cos<L: Lanes>(x: L) -> (L, L) {
    let k = L::splat;
    let rounded = x * k(core::f64::consts::FRAC_2_PI) + k(ROUNDER);
    let n = rounded - k(ROUNDER);
    // The first difference is exact; the second leaves its roundoff in the tail (Dekker: `first` is the larger, or the
    // rest is too small).
    let first = x - n * k(HALF_PI[0]);
    let part = n * k(HALF_PI[1]);
    let rest = first - part;
    let tail = (first - rest) - part;
    if !L::all_reduced(x, n, rest) {
        return L::one_by_one(x, |x| {
            let angle = reduction::reduced(x);
            let (sin, cos) = kernel(angle.rest, angle.tail);
            f64::turned(angle.rounded, sin, cos)
        });
    }
    let (sin, cos) = kernel(rest, tail);
    L::turned(rounded, sin, cos)
}

/// (sin r − r) / r³ as a polynomial in r².
const SINE: [f64; 6] = [
    -0.16666666666666632,
    0.008333333333322418,
    -0.0001984126982981238,
    2.755731369357263e-6,
    -2.5050758384371987e-8,
    1.5896811798732654e-10,
];

/// (cos r − 1 + r²/2) / r⁴ as a polynomial in r².
const COSINE: [f64; 6] = [
    0.0416666666666666,
    -0.0013888888888874131,
    2.4801587289487012e-5,
    -2.755731435378898e-7,
    2.087572347902117e-9,
    -1.1359658844005114e-11,
];

/// Sine and cosine of r + tail, |r| ≤ π/4.
#[inline(always)]
fn kernel<L: Lanes>(r: L, tail: L) -> (L, L) {
    let (one, z) = (L::splat(1.0), r * r);
    let half = L::splat(0.5) * z;
    let near_one = one - half;
    let sin = r + (r * (z * polynomial(&SINE, z)) + tail * near_one);
    let cos = near_one + (((one - near_one) - half) + (z * (z * polynomial(&COSINE, z)) - r * tail));
    (sin, cos)
}

#[inline(always)]
fn polynomial<L: Lanes>([a, b, c, d, e, f]: &[f64; 6], z: L) -> L {
    let k = |coefficient: &f64| L::splat(*coefficient);
    k(a) + z * (k(b) + z * (k(c) + z * (k(d) + z * (k(e) + z * k(f)))))
}
