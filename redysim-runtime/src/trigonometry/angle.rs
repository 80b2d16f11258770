//! What the kernels ask of their angles beyond arithmetic.

use crate::Scalar;
use crate::lanes::{F64x2, F64x4, F64x8};
use bytemuck::cast;
use wide::{u64x2, u64x4, u64x8};

/// One angle, or several side by side, of which each is an `f64`.
pub trait Angle: Scalar {
    /// Whether in every lane the magnitude is at most that of `limit`, and neither is NaN.
    fn all_within(self, limit: Self) -> bool;

    /// Sine and cosine, given those of the rest, after the quarter turns in the last two bits of `rounded`: every one
    /// turns (sin, cos) to (cos, −sin).
    fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self);

    /// `function` of each lane.
    fn one_by_one(self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self);
}

impl Angle for f64 {
    #[inline(always)]
    fn all_within(self, limit: f64) -> bool {
        f64::abs(self) <= f64::abs(limit)
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
    fn one_by_one(self, function: impl Fn(f64) -> (f64, f64)) -> (f64, f64) {
        function(self)
    }
}

macro_rules! angles {
    ($lanes:ident, $bits:ident) => {
        impl Angle for $lanes {
            #[inline(always)]
            fn all_within(self, limit: Self) -> bool {
                self.0.abs().simd_le(limit.0.abs()).all()
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (one, two) = ($bits::splat(1), $bits::splat(2));
                let [turns, sin, cos]: [$bits; 3] = [cast(rounded.0), cast(sin.0), cast(cos.0)];
                let odd = $bits::splat(0) - (turns & one);
                let differing = (sin ^ cos) & odd;
                let (sin_sign, cos_sign) = ((turns & two) << 62_u64, ((turns + one) & two) << 62_u64);
                (Self(cast(sin ^ differing ^ sin_sign)), Self(cast(cos ^ differing ^ cos_sign)))
            }

            #[inline(always)]
            fn one_by_one(self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
                // A call that is not inlined takes the address of its lanes, which would keep these lanes in memory
                // from where they are put together; and to read as a whole what was just written in parts stalls.
                // Negative lanes are other lanes, made only when they are needed.
                (-self).negatives_one_by_one(function)
            }
        }

        impl $lanes {
            /// `function` of the negative of each lane.
            #[inline(never)]
            #[cold]
            fn negatives_one_by_one(self, function: impl Fn(f64) -> (f64, f64)) -> (Self, Self) {
                let pairs = self.to_array().map(|minus_x| function(-minus_x));
                (Self::from(pairs.map(|(sin, _)| sin)), Self::from(pairs.map(|(_, cos)| cos)))
            }
        }
    };
}

angles!(F64x2, u64x2);
angles!(F64x4, u64x4);
angles!(F64x8, u64x8);
