//! Sine and cosine of `f32`, in `f32` and integers only: a processor without a unit for `f64` needs none.
//!
//! The angle is reduced to |r| ≤ π/4 with a tail that carries what an `f32` cannot, by subtracting π/2 in three parts
//! (W. J. Cody and W. Waite, *Software manual for the elementary functions*, 1980), or, after many turns, in integers
//! (`single_reduction`). No angle of few turns comes closer to a multiple of π/2 than the three parts are accurate for, as
//! is seen by trying every one. Then two polynomials in r², of least relative error (found by Remez exchange with
//! coefficients that are `f32`, `studies/sin_cos/minimax.py`: 2⁻²⁷·⁸ for the sine, 2⁻³¹·⁹ for the cosine), are evaluated.

use super::angle::{Angle, Kernel};
use super::fast_path::{is_accurate, slow_path};
use super::reduction::Reduced;

/// The number of radians up to which the parts of π/2 are accurate enough: 2¹⁷ quarter turns, or 2⁸ if multiply and add
/// round twice.
const fn many_turns(fused: bool) -> f32 {
    if fused { 205_887.0 } else { 402.0 }
}

/// π/2 in three parts. If multiply and add round once, a multiple of the first is subtracted exactly though it has all
/// 24 bits, and what the second leaves is exact, too. If they round twice, the first and the second have 16 bits, of
/// which multiples up to 2⁸ are exact.
const fn half_pi(fused: bool) -> [f32; 3] {
    if fused { [1.570_796_4, -4.371_139e-8, -1.715_124_5e-15] } else { [1.570_770_3, 2.606_306_2e-5, 6.077_100_6e-11] }
}

/// Added to a number below 2²² and taken away again, it leaves the nearest integer, and shows its bits in between.
const ROUNDER: f32 = 12_582_912.0;

/// Sines and cosines of all `angles`, for a processor without vectors.
///
/// Up to eight become straight code after one decision, so that constants stay in registers from angle to angle.
#[inline(always)]
#[cfg(feature = "lanes")]
pub fn one_after_the_other<const N: usize>(angles: [f32; N]) -> ([f32; N], [f32; N]) {
    let mut found = ([0.0; N], [0.0; N]);
    let mut put = |index: usize, (sin, cos)| (found.0[index], found.1[index]) = (sin, cos);
    if angles.iter().all(|&x| is_accurate(margin(x))) {
        for start in (0..N).step_by(8) {
            let mut one = |index: usize| {
                if index < N {
                    put(index, f32::evaluated(angles[index].fast_reduction().0));
                }
            };
            one(start);
            one(start + 1);
            one(start + 2);
            one(start + 3);
            one(start + 4);
            one(start + 5);
            one(start + 6);
            one(start + 7);
        }
    } else {
        for (index, angle) in angles.into_iter().enumerate() {
            put(index, angle.one_by_one(slow_path));
        }
    }
    found
}

/// Positive where the parts of π/2 are accurate enough.
#[inline(always)]
fn margin<A: Angle>(x: A) -> A {
    let many = many_turns(A::FUSED);
    k::<A>(many * many) - x * x
}

/// The constant `value` in every lane.
#[inline(always)]
fn k<A: Angle>(value: f32) -> A {
    A::from_f64(f64::from(value))
}

/// Three constants in every lane.
#[inline(always)]
fn constants<A: Angle>([a, b, c]: [f32; 3]) -> [A; 3] {
    [k(a), k(b), k(c)]
}

/// (sin r − r) / r³ as a polynomial in r².
const SINE: [f32; 3] = [-0.166_666_54, 0.008_332_114, -0.000_195_091_63];

/// (cos r − 1 + r²/2) / r⁴ as a polynomial in r².
const COSINE: [f32; 3] = [0.041_666_646, -0.001_388_733_5, 2.443_594_7e-5];

/// The kernel of `f32`.
pub struct Single;

impl Kernel for Single {
    #[inline(always)]
    fn reduced<A: Angle>(x: A) -> (Reduced<A>, A) {
        let rounded = x.mul_add(k(core::f32::consts::FRAC_2_PI), k(ROUNDER));
        let minus_n = k::<A>(ROUNDER) - rounded;
        let [a, b, c] = constants::<A>(half_pi(A::FUSED));
        // The first difference is exact. The second leaves its roundoff in the tail, with that of its product.
        let first = minus_n.mul_add(a, x);
        let product = minus_n * b;
        let rest = first + product;
        let roundoff = (first - rest) + product;
        let tail = if A::FUSED {
            roundoff + minus_n.mul_add(c, minus_n.mul_add(b, -product))
        } else {
            minus_n.mul_add(c, roundoff)
        };
        (Reduced { rounded, rest, tail }, margin(x))
    }

    #[inline(always)]
    fn evaluated<A: Angle>(Reduced { rounded, rest, tail }: Reduced<A>) -> (A, A) {
        let z = rest * rest;
        let [a, b, c] = constants::<A>(SINE);
        let sin = rest + (rest * z).mul_add(c.mul_add(z, b).mul_add(z, a), tail);
        let [a, b, c] = constants::<A>(COSINE);
        // 1 − r²/2 rounded, and what that loses.
        let (one, minus_half) = (k::<A>(1.0), k::<A>(-0.5));
        let near_one = z.mul_add(minus_half, one);
        let lost = (-rest).mul_add(tail, z.mul_add(minus_half, one - near_one));
        let cos = near_one + (z * z).mul_add(c.mul_add(z, b).mul_add(z, a), lost);
        A::turned(rounded, sin, cos)
    }
}
