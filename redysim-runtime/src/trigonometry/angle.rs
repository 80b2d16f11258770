//! What the kernels ask of their angles beyond arithmetic.

use super::double::Double;
use super::reduction::{self, Reduced};
use super::single::Single;
use super::single_reduction;
use crate::scalar::{FUSED, Scalar};

/// One angle, or several side by side.
pub trait Angle: Scalar {
    /// What one angle is: `f64` or `f32`.
    type Number: Number;
    /// Whether `mul_add` rounds once.
    const FUSED: bool;

    /// Whether every lane is at most that of `limit`; NaN is not.
    fn all_at_most(self, limit: Self) -> bool;

    /// The lesser of the two numbers in every lane; `other` or NaN where `self` is NaN.
    fn lesser(self, other: Self) -> Self;

    /// Sine and cosine, given those of the rest, after the quarter turns in the last two bits of `rounded`: every one
    /// turns (sin, cos) to (cos, −sin).
    fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self);

    /// `function` of each lane.
    fn one_by_one(self, function: impl Fn(Self::Number) -> (Self::Number, Self::Number)) -> (Self, Self);

    /// The Cody-Waite reduction, and the margin of its accuracy, see [`is_accurate`](super::fast_path::is_accurate).
    #[inline(always)]
    fn fast_reduction(self) -> (Reduced<Self>, Self) {
        <Self::Number as Number>::Kernel::reduced(self)
    }

    /// Sine and cosine of a reduced angle.
    #[inline(always)]
    fn evaluated(angle: Reduced<Self>) -> (Self, Self) {
        <Self::Number as Number>::Kernel::evaluated(angle)
    }
}

/// Sine and cosine for one width of numbers, of one angle or of several side by side.
pub trait Kernel {
    /// The reduction that is accurate for nearly all angles, and its margin.
    fn reduced<A: Angle>(angle: A) -> (Reduced<A>, A);

    /// Sine and cosine of a reduced angle.
    fn evaluated<A: Angle>(angle: Reduced<A>) -> (A, A);
}

/// One angle.
pub trait Number: Angle<Number = Self> {
    /// The kernel for numbers of this width.
    type Kernel: Kernel;
    /// π/2 as the sum of two numbers.
    const HALF_PI: [Self; 2];

    /// The reduction of any angle with as many digits of π as it needs; NaN where it is not finite.
    fn reduced(self) -> Reduced<Self>;
}

macro_rules! one_angle {
    ($float:ident, $kernel:ty, $second_bit_to_sign:literal, $reduced:path, $half_pi:expr) => {
        impl Number for $float {
            type Kernel = $kernel;
            const HALF_PI: [Self; 2] = $half_pi;

            #[inline(always)]
            fn reduced(self) -> Reduced<Self> {
                $reduced(self)
            }
        }

        impl Angle for $float {
            type Number = Self;
            const FUSED: bool = FUSED;

            #[inline(always)]
            fn all_at_most(self, limit: Self) -> bool {
                self <= limit
            }

            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                if self < other { self } else { other }
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (turns, sin, cos) = (rounded.to_bits(), sin.to_bits(), cos.to_bits());
                let odd = (turns & 1).wrapping_neg();
                let differing = (sin ^ cos) & odd;
                let sin_sign = (turns & 2) << $second_bit_to_sign;
                let cos_sign = (turns.wrapping_add(1) & 2) << $second_bit_to_sign;
                (Self::from_bits(sin ^ differing ^ sin_sign), Self::from_bits(cos ^ differing ^ cos_sign))
            }

            #[inline(never)]
            #[cold]
            fn one_by_one(self, function: impl Fn(Self) -> (Self, Self)) -> (Self, Self) {
                function(self)
            }
        }
    };
}

one_angle!(f64, Double, 62, reduction::reduced, [core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17]);
one_angle!(f32, Single, 30, single_reduction::by_digits, [core::f32::consts::FRAC_PI_2, -4.371_139e-8]);
