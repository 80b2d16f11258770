//! Sine and cosine of `f64`.
//!
//! The angle is reduced to |r| ≤ π/4 with a tail that carries what a `f64` cannot: by subtracting π/2 in two parts, or,
//! where that is not enough (many quarter turns, or an angle beside a multiple of π/2), with more digits (`reduction`).
//! Then two polynomials in r², of least relative error (found by Remez exchange: 2⁻⁵⁷ for the sine, 2⁻⁵⁹ for the
//! cosine), are evaluated.

use super::angle::{Angle, Number};
use super::reduction::{ROUNDER, Reduced};
#[cfg(feature = "lanes")]
use crate::lanes::F64x2;
#[cfg(feature = "lanes")]
use crate::scalar::Scalar;

/// A rest smaller than this for each quarter turn has lost too many digits to cancellation, 2⁻³³.
const TOO_SMALL: f64 = 1.0 / (1_u64 << 33) as f64;
/// Of 2¹⁷ quarter turns, the square of that rest.
const MANY_TURNS: f64 = 1.0 / (1_u64 << 32) as f64;
/// π/2 in a part of 36 bits, of which multiples up to 2¹⁷ are exact, and one of 53.
const HALF_PI: [f64; 2] = [1.5707963267923333, 2.563344151594519e-12];

/// Sine and cosine of `x` radians, in every lane.
#[inline(always)]
pub fn sin_cos<A: Angle>(x: A) -> (A, A) {
    let (Reduced { rounded, rest, tail }, good) = reduced(x);
    if !good {
        // The other lanes of a hard angle are reduced as they are when they are alone, to give the same bits.
        return x.one_by_one(hard);
    }
    let (sin, cos) = kernel(rest, tail);
    A::turned(rounded, sin, cos)
}

/// [`sin_cos`] of one angle.
#[inline(always)]
pub fn of_one(x: f64) -> (f64, f64) {
    #[cfg(feature = "lanes")]
    if cfg!(any(target_feature = "sse2", target_feature = "neon", target_feature = "simd128")) {
        return side_by_side(x);
    }
    sin_cos(x)
}

/// Sine and cosine of one angle, side by side in two lanes: the bits of [`sin_cos`] in fewer operations.
#[inline(always)]
#[cfg(feature = "lanes")]
fn side_by_side(x: f64) -> (f64, f64) {
    let (Reduced { rounded, rest: r, tail }, good) = reduced(x);
    if !good {
        return x.one_by_one(hard);
    }
    let z = r * r;
    let near_one = Scalar::mul_add(z, -0.5, 1.0);
    let correction = Scalar::mul_add(-r, tail, Scalar::mul_add(z, -0.5, 1.0 - near_one));
    let [squares, powers] = [F64x2::from([z, z]), F64x2::from([r, z])];
    let polynomials = polynomial(&[0, 1, 2, 3, 4, 5], |term| F64x2::from([SINE[term], COSINE[term]]), squares);
    let corrections = F64x2::from([tail * near_one, correction]);
    let found = F64x2::from([r, near_one]) + (powers * squares).mul_add(polynomials, corrections);
    found.turned_as_sine_and_cosine(rounded)
}

/// Sine and cosine of one angle, of which the quick reduction may not be good enough.
#[inline(always)]
fn hard<T: Number>(x: T) -> (T, T) {
    let (quick, good) = reduced(x);
    let angle = if good { quick } else { x.reduced() };
    let (sin, cos) = kernel(angle.rest, angle.tail);
    T::turned(angle.rounded, sin, cos)
}

/// The reduction that is good for nearly all angles, and whether it is good for all of these.
#[inline(always)]
fn reduced<A: Angle>(x: A) -> (Reduced<A>, bool) {
    let k = A::from_f64;
    let rounded = x.mul_add(k(core::f64::consts::FRAC_2_PI), k(ROUNDER));
    let minus_n = k(ROUNDER) - rounded;
    // The first difference is exact; the second leaves its roundoff in the tail (Dekker: `first` is the larger, or the
    // rest is too small).
    let first = minus_n.mul_add(k(HALF_PI[0]), x);
    let rest = minus_n.mul_add(k(HALF_PI[1]), first);
    let tail = minus_n.mul_add(k(HALF_PI[1]), first - rest);
    // By squares, of which the kernel needs that of the rest anyway: one comparison for both, and no signs.
    let too_small = minus_n * k(TOO_SMALL);
    let good = (too_small * too_small).all_at_most((rest * rest).lesser(k(MANY_TURNS)));
    (Reduced { rounded, rest, tail }, good)
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
fn kernel<A: Angle>(r: A, tail: A) -> (A, A) {
    let (one, z) = (A::one(), r * r);
    // Halves are exact, fused or not.
    let minus_half = A::from_f64(-0.5);
    let near_one = z.mul_add(minus_half, one);
    let sin = r + (r * z).mul_add(polynomial(&SINE, A::from_f64, z), tail * near_one);
    let correction = (-r).mul_add(tail, z.mul_add(minus_half, one - near_one));
    let cos = near_one + (z * z).mul_add(polynomial(&COSINE, A::from_f64, z), correction);
    (sin, cos)
}

/// The polynomial whose coefficients `k` makes of `terms`. Neighbouring ones are paired, so that fewer operations wait for each
/// other.
#[inline(always)]
fn polynomial<A: Angle, T: Copy>([a, b, c, d, e, f]: &[T; 6], k: impl Fn(T) -> A, z: A) -> A {
    let pair = |low: &T, high: &T| z.mul_add(k(*high), k(*low));
    let squared = z * z;
    squared.mul_add(squared.mul_add(pair(e, f), pair(c, d)), pair(a, b))
}
