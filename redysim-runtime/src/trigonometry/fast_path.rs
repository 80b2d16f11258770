//! The fast path of sine and cosine, a Cody-Waite reduction that is accurate enough for nearly all angles, and the slow path
//! of the others.

use super::angle::{Angle, Number};

/// The lowest margin with which a reduction is accurate enough: −2⁻¹⁵⁰.
///
/// Roundoff leaves the numbers nearest to multiples of π/2 a margin this little below zero. That of an angle that needs more
/// digits of π is lower. In `f32`, where these numbers have none, the constant rounds to −0.
const LOWEST_MARGIN: f64 = -7.006492321624085e-46;

/// Whether a reduction with this margin is accurate enough in every lane.
#[inline(always)]
pub fn is_accurate<A: Angle>(margin: A) -> bool {
    A::from_f64(LOWEST_MARGIN).all_at_most(margin)
}

/// Sine and cosine of one angle, which may need more digits of π.
#[inline(always)]
pub fn slow_path<T: Number>(x: T) -> (T, T) {
    let (angle, margin) = x.fast_reduction();
    T::evaluated(if is_accurate(margin) { angle } else { x.reduced() })
}

/// Sine and cosine of `x` radians, in every lane.
#[inline(always)]
pub fn sin_cos<A: Angle>(x: A) -> (A, A) {
    let (angle, margin) = x.fast_reduction();
    // Each lane takes the slow path on its own, so that the bits are those of one angle.
    if is_accurate(margin) { A::evaluated(angle) } else { x.one_by_one(slow_path) }
}
