//! Sine and cosine of `f64`.
//!
//! The angle is reduced to |r| ≤ π/4 with a tail that carries what a `f64` cannot: by subtracting π/2 in two parts, or,
//! where that is not enough (many quarter turns, or an angle beside a multiple of π/2), with more digits (`reduction`).
//! Then two polynomials in r², of least relative error (found by Remez exchange: 2⁻⁵⁷ for the sine, 2⁻⁵⁹ for the
//! cosine), are evaluated.

use super::angle::{Angle, Number};
use super::reduction::{ROUNDER, Reduced};
#[cfg(feature = "lanes")]
use crate::{lanes::F64x2, registers, scalar::Scalar};

/// A rest smaller than this for each quarter turn has lost too many digits to cancellation, 2⁻³³.
const TOO_SMALL: f64 = 1.0 / (1_u64 << 33) as f64;
/// Of 2¹⁷ quarter turns, the square of that rest.
const MANY_TURNS: f64 = 1.0 / (1_u64 << 32) as f64;
/// π/2 in a part of 36 bits, of which multiples up to 2¹⁷ are exact, and one of 53.
const HALF_PI: [f64; 2] = [1.5707963267923333, 2.563344151594519e-12];

/// Sine and cosine of `x` radians, in every lane.
#[inline(always)]
pub fn sin_cos<A: Angle>(x: A) -> (A, A) {
    let (angle, good) = reduced(x);
    // The other lanes of a hard angle are reduced as they are when they are alone, to give the same bits.
    if good { evaluated(angle) } else { x.one_by_one(hard) }
}

/// [`sin_cos`] of one angle.
#[inline(always)]
pub fn of_one(x: f64) -> (f64, f64) {
    #[cfg(feature = "lanes")]
    if registers::VECTORS {
        return side_by_side(x);
    }
    sin_cos(x)
}

/// Sine and cosine of one angle, side by side in two lanes: the bits of [`sin_cos`] in fewer instructions.
#[inline(always)]
#[cfg(feature = "lanes")]
fn side_by_side(x: f64) -> (f64, f64) {
    let (Reduced { rounded, rest: r, tail }, good) = reduced(x);
    if !good {
        return x.one_by_one(hard);
    }
    let z = r * r;
    let (near_one, correction) = second_order_cosine(z, r, tail);
    let [squares, powers] = [F64x2::from([z, z]), F64x2::from([r, z])];
    let polynomials = polynomial(|term| F64x2::from([SINE[term], COSINE[term]]), squares);
    let corrections = F64x2::from([tail * near_one, correction]);
    let found = F64x2::from([r, near_one]) + (powers * squares).mul_add(polynomials, corrections);
    found.turned_as_sine_and_cosine(rounded)
}

/// Sine and cosine of one angle, of which the quick reduction may not be good enough.
#[inline(always)]
fn hard<T: Number>(x: T) -> (T, T) {
    let (quick, good) = reduced(x);
    evaluated(if good { quick } else { x.reduced() })
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

/// Sine and cosine of an angle that is reduced.
#[inline(always)]
fn evaluated<A: Angle>(Reduced { rounded, rest: r, tail }: Reduced<A>) -> (A, A) {
    let z = r * r;
    let (near_one, correction) = second_order_cosine(z, r, tail);
    let sin = r + (r * z).mul_add(polynomial(|term| A::from_f64(SINE[term]), z), tail * near_one);
    let cos = near_one + (z * z).mul_add(polynomial(|term| A::from_f64(COSINE[term]), z), correction);
    A::turned(rounded, sin, cos)
}

/// 1 − z / 2, where z = r², and the correction for its roundoff and for the tail.
#[inline(always)]
fn second_order_cosine<A: Angle>(z: A, r: A, tail: A) -> (A, A) {
    // Halves are exact, fused or not.
    let (one, minus_half) = (A::one(), A::from_f64(-0.5));
    let near_one = z.mul_add(minus_half, one);
    (near_one, (-r).mul_add(tail, z.mul_add(minus_half, one - near_one)))
}

/// The polynomial of six terms with these coefficients. Neighbouring terms are paired, so that fewer operations wait for each
/// other.
#[inline(always)]
fn polynomial<A: Angle>(coefficient: impl Fn(usize) -> A, z: A) -> A {
    let pair = |low: usize| z.mul_add(coefficient(low + 1), coefficient(low));
    let squared = z * z;
    squared.mul_add(squared.mul_add(pair(4), pair(2)), pair(0))
}
