//! Sines and cosines by a reduction that is good for nearly all angles, and whether it was.

use super::angle::{Angle, Number};

/// Sine and cosine of an angle, or of several in lanes.
pub struct Quick<A> {
    pub sin: A,
    pub cos: A,
    /// By how much the reduction is good enough.
    pub margin: A,
}

/// How far below zero a margin may be, as it is by roundoff for the numbers nearest to multiples of π/2: 2⁻¹⁵⁰, less than
/// the distance of any angle that is too hard.
const ROUNDOFF: f64 = 1.0 / ((1_u128 << 75) as f64 * (1_u128 << 75) as f64);

/// Whether a reduction with this margin is good enough in every lane.
#[inline(always)]
pub fn is_enough<A: Angle>(margin: A) -> bool {
    A::from_f64(-ROUNDOFF).all_at_most(margin)
}

impl<A: Angle> Quick<A> {
    /// These, which are those of `x`; or, where they are not good enough, those by more digits of π.
    #[inline(always)]
    pub fn or_hard(self, x: A) -> (A, A) {
        if is_enough(self.margin) {
            return (self.sin, self.cos);
        }
        // The other lanes of a hard angle are reduced as they are when they are alone, to give the same bits.
        x.one_by_one(Number::hard)
    }
}

/// Sine and cosine of `x` radians, in every lane.
#[inline(always)]
pub fn sin_cos<A: Angle>(x: A) -> (A, A) {
    x.quick().or_hard(x)
}
