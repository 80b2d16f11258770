//! One or several `f64` side by side.

use super::{MANY_TURNS, TOO_SMALL};
use bytemuck::cast;
use core::ops::{Add, Mul, Sub};
use wide::{f64x2, f64x4, u64x2, u64x4};

/// Numbers on which the same operations are done at once.
pub trait Lanes: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {
    /// The same number in every lane.
    fn splat(value: f64) -> Self;

    /// Whether in every lane the angle `x` is finite, not too large, and its `rest` after `n` quarter turns not too small.
    fn all_reduced(x: Self, n: Self, rest: Self) -> bool;

    /// Sine and cosine, given those of the rest, after the quarter turns in the last two bits of `rounded`: every one
    /// turns (sin, cos) to (cos, −sin).
    fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self);

    /// `function` of each lane.
    fn one_by_one(x: Self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self);
}

impl Lanes for f64 {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn all_reduced(x: f64, n: f64, rest: f64) -> bool {
        let (angle, rest) = (libm::fabs(x), libm::fabs(rest));
        angle <= MANY_TURNS && (rest >= TOO_SMALL || n == 0.0)
    }

    #[inline(always)]
    fn turned(rounded: f64, sin: f64, cos: f64) -> (f64, f64) {
        let (turns, sin, cos) = (rounded.to_bits(), sin.to_bits(), cos.to_bits());
        let odd = (turns & 1).wrapping_neg();
        let differing = (sin ^ cos) & odd;
        let (sin_sign, cos_sign) = ((turns & 2) << 62, (turns.wrapping_add(1) & 2) << 62);
        (f64::from_bits(sin ^ differing ^ sin_sign), f64::from_bits(cos ^ differing ^ cos_sign))
    }

    #[inline(always)]
    fn one_by_one(x: f64, function: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
        function(x)
    }
}

macro_rules! lanes {
    ($lanes:ident, $bits:ident) => {
        impl Lanes for $lanes {
            #[inline(always)]
            fn splat(value: f64) -> Self {
                $lanes::splat(value)
            }

            #[inline(always)]
            fn all_reduced(x: Self, n: Self, rest: Self) -> bool {
                let near = x.abs().simd_le(Self::splat(MANY_TURNS));
                let rests = rest.abs().simd_ge(Self::splat(TOO_SMALL)) | n.simd_eq(Self::splat(0.0));
                (near & rests).all()
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (one, two) = ($bits::splat(1), $bits::splat(2));
                let [turns, sin, cos]: [$bits; 3] = [cast(rounded), cast(sin), cast(cos)];
                let odd = $bits::splat(0) - (turns & one);
                let differing = (sin ^ cos) & odd;
                let (sin_sign, cos_sign) = ((turns & two) << 62_u64, ((turns + one) & two) << 62_u64);
                (cast(sin ^ differing ^ sin_sign), cast(cos ^ differing ^ cos_sign))
            }

            #[inline(never)]
            #[cold]
            fn one_by_one(x: Self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
                let pairs = x.to_array().map(function);
                (Self::from(pairs.map(|(sin, _)| sin)), Self::from(pairs.map(|(_, cos)| cos)))
            }
        }
    };
}

lanes!(f64x2, u64x2);
lanes!(f64x4, u64x4);
