//! Sine and cosine of `f64`.
//!
//! The angle is reduced to |r| ≤ π/4 with a tail that carries what a `f64` cannot: by subtracting π/2 in two parts (W. J. Cody
//! and W. Waite, *Software manual for the elementary functions*, 1980), or, where that is not enough (many quarter turns, or
//! an angle beside a multiple of π/2), with more digits (`reduction`).
//! Then two polynomials in r², of least relative error (found by Remez exchange: 2⁻⁵⁷ for the sine, 2⁻⁵⁹ for the
//! cosine), are evaluated.
//!
//! With fused multiply-adds the parts of π/2 are longer, and fewer operations keep the error below 1 unit in the last place.

use super::angle::{Angle, Kernel};
use super::fast_path::sin_cos;
#[cfg(feature = "lanes")]
use super::fast_path::{is_accurate, slow_path};
use super::reduction::{ROUNDER, Reduced};
use crate::scalar::Scalar;
#[cfg(feature = "lanes")]
use crate::{lanes::F64x2, registers};
use core::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// π/2 in two parts.
///
/// With fused multiply-adds the first part has full precision: x − n · π/2 is less than 1 in magnitude and a multiple of
/// 2⁻⁵³, so it is exact. Without them the first part has 36 bits, so that its multiples up to 2¹⁷ are exact.
const fn half_pi(fused: bool) -> [f64; 2] {
    if fused { [FRAC_PI_2, 6.123233995736766e-17] } else { [1.5707963267923333, 2.563344151594519e-12] }
}

/// The least rest for each quarter turn, 2⁻³³, without fused multiply-adds: a smaller one has lost too many digits to
/// cancellation.
const TOO_SMALL: f64 = 1.0 / (1_u64 << 33) as f64;
/// The square of the least rest at the largest number of quarter turns: 2¹⁷, or some 2³⁷ with fused multiply-adds.
const MANY_TURNS: f64 = 1.0 / (1_u64 << 32) as f64;

/// Sine and cosine of one angle.
#[inline(always)]
pub fn of_one(x: f64) -> (f64, f64) {
    #[cfg(feature = "lanes")]
    if registers::VECTORS {
        let (angle, margin) = x.fast_reduction();
        return if is_accurate(margin) { side_by_side(angle) } else { x.one_by_one(slow_path) };
    }
    sin_cos(x)
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

/// The kernel of `f64`.
pub struct Double;

impl Kernel for Double {
    #[inline(always)]
    fn reduced<A: Angle>(x: A) -> (Reduced<A>, A) {
        let k = A::from_f64;
        let [high, low] = half_pi(A::FUSED).map(k);
        let rounded = x.mul_add(k(FRAC_2_PI), k(ROUNDER));
        let minus_n = k(ROUNDER) - rounded;
        // The first difference is exact; the second leaves its roundoff in the tail. `subtracted` is exact: without fused
        // multiply-adds since `first` is the larger (T. J. Dekker, 1971) or the rest is too small, with them as below.
        let first = minus_n.mul_add(high, x);
        let rest = minus_n.mul_add(low, first);
        let subtracted = first - rest;
        let tail = minus_n.mul_add(low, subtracted);
        // Squares need no absolute values, and the kernel computes that of the rest anyway. With fused multiply-adds `subtracted` is
        // exact where it is not larger than the rest, as `first` is a multiple of 2⁻⁵³, and the error of the low part is at most
        // 2⁻⁵⁵ of it.
        let too_small = if A::FUSED { subtracted } else { minus_n * k(TOO_SMALL) };
        let margin = (-too_small).mul_add(too_small, (rest * rest).lesser(k(MANY_TURNS)));
        (Reduced { rounded, rest, tail }, margin)
    }

    #[inline(always)]
    fn evaluated<A: Angle>(Reduced { rounded, rest: r, tail }: Reduced<A>) -> (A, A) {
        let z = r * r;
        let squares = z * z;
        let polynomial = |terms: [f64; 6]| Polynomial::of(|term| A::from_f64(terms[term]), z, squares);
        let (sin, cos) = if A::FUSED {
            let sin = r + (r * z).mul_add(polynomial(SINE).value(squares), tail);
            let Polynomial { low, high } = polynomial(COSINE);
            let beyond_second_order = (squares * squares).mul_add(high, squares.mul_add(low, -r * tail));
            // The product r · (−r/2) is exact, so that it needs no correction.
            (sin, A::one() + r.mul_add(r * A::from_f64(-0.5), beyond_second_order))
        } else {
            let (near_one, correction) = second_order_cosine(z, r, tail);
            let sin = r + (r * z).mul_add(polynomial(SINE).value(squares), tail * near_one);
            (sin, near_one + squares.mul_add(polynomial(COSINE).value(squares), correction))
        };
        A::turned(rounded, sin, cos)
    }
}

/// [`Double::evaluated`] of one angle, sine and cosine side by side in two lanes: the same bits in fewer instructions.
#[inline(always)]
#[cfg(feature = "lanes")]
fn side_by_side(Reduced { rounded, rest: r, tail }: Reduced<f64>) -> (f64, f64) {
    let z = r * r;
    let pair = |sine: f64, cosine: f64| F64x2::from([sine, cosine]);
    let squares = pair(z * z, z * z);
    let polynomials = Polynomial::of(|term| pair(SINE[term], COSINE[term]), pair(z, z), squares);
    let found = if f64::FUSED {
        let low = pair(1.0, z * z).mul_add(polynomials.low, pair(0.0, -r * tail));
        let [sine, beyond_second_order] = (squares * pair(1.0, z * z)).mul_add(polynomials.high, low).into();
        pair(r, 1.0) + pair(r * z, r).mul_add(pair(sine, r * -0.5), pair(tail, beyond_second_order))
    } else {
        let (near_one, correction) = second_order_cosine(z, r, tail);
        let powers = pair(r, z) * pair(z, z);
        pair(r, near_one) + powers.mul_add(polynomials.value(squares), pair(tail * near_one, correction))
    };
    found.turned_as_sine_and_cosine(rounded)
}

/// 1 − z / 2, where z = r², and the correction for its roundoff and for the tail.
#[inline(always)]
fn second_order_cosine<A: Angle>(z: A, r: A, tail: A) -> (A, A) {
    // Halves are exact.
    let (one, minus_half) = (A::one(), A::from_f64(-0.5));
    let near_one = z.mul_add(minus_half, one);
    (near_one, (-r).mul_add(tail, z.mul_add(minus_half, one - near_one)))
}

/// A polynomial of six terms in z by Estrin's scheme, which shortens the chain of dependent operations: low + z² · high.
struct Polynomial<A> {
    low: A,
    high: A,
}

impl<A: Scalar> Polynomial<A> {
    #[inline(always)]
    fn of(coefficient: impl Fn(usize) -> A, z: A, squares: A) -> Self {
        let pair = |low: usize| z.mul_add(coefficient(low + 1), coefficient(low));
        Polynomial { low: pair(0), high: squares.mul_add(pair(4), pair(2)) }
    }

    #[inline(always)]
    fn value(&self, squares: A) -> A {
        squares.mul_add(self.high, self.low)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fast_path::is_accurate;
    use super::*;

    #[test]
    #[cfg(any(target_feature = "fma", target_arch = "aarch64"))]
    fn the_numbers_nearest_to_right_angles_take_the_fast_path() {
        for turns in -8..=8 {
            let angle = f64::from(turns) * FRAC_PI_2;
            let (_, margin) = angle.fast_reduction();
            assert!(is_accurate(margin) || !f64::FUSED, "{turns} quarter turns: the margin is {margin:e}");
        }
    }

    #[test]
    fn angles_of_many_turns_do_not_take_the_fast_path() {
        let many_turns = if f64::FUSED { 1e12 } else { 1e6 };
        for angle in
            [many_turns, -1e16, 1e20, 6381956970095103.0 * libm::exp2(797.0), f64::MAX, f64::INFINITY, f64::NAN]
        {
            let (_, margin) = angle.fast_reduction();
            assert!(!is_accurate(margin), "{angle:e}");
        }
    }
}
