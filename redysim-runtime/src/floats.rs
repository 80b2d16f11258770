//! `f64` and `f32` as scalars.

#[cfg(feature = "lanes")]
use crate::branches::compute_branches_in_lanes;
#[cfg(feature = "lanes")]
use crate::registers::{self, Register};
use crate::scalar::{FUSED, Real, Scalar};
use crate::trigonometry;
#[cfg(feature = "lanes")]
use wide::{f32x4, f64x2};

macro_rules! real {
    ($float:ident, $vector:ident, $pair:ident: $two:literal, $four:ident: $width:literal, $sin_cos:path, $sin_cos_all:path, $sqrt:path, $fabs:path, $pow:path) => {
        impl Scalar for $float {
            const AT_ONCE: bool = true;

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                $sin_cos(self)
            }
            #[cfg(feature = "lanes")]
            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
                $sin_cos_all(angles)
            }
            #[inline(always)]
            fn without_turns<const N: usize>(angles: [Self; N]) -> [Self; N] {
                trigonometry::turns::without_turns(angles)
            }
            #[inline]
            fn sqrt(self) -> Self {
                // The vector's square root becomes the scalar instruction, which that of `libm` hides in assembly that
                // the compiler cannot see through; without the instruction, `libm` is the better one.
                #[cfg(feature = "lanes")]
                if registers::VECTORS {
                    let [root, ..] = $vector::splat(self).sqrt().to_array();
                    return root;
                }
                $sqrt(self)
            }
            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                if !FUSED {
                    return self * factor + addend;
                }
                // Where the target has the instruction, the one of `std` becomes it. `core` does not provide it; that of a vector
                // rounds the same, but is slower to compile and leaves moves between lanes in long functions.
                #[cfg(feature = "std")]
                let sum = $float::mul_add(self, factor, addend);
                #[cfg(all(feature = "lanes", not(feature = "std")))]
                let [sum, ..] = $vector::splat(self).mul_add(factor.into(), addend.into()).to_array();
                #[cfg(not(feature = "lanes"))]
                let sum = self * factor + addend;
                sum
            }
            #[cfg(feature = "lanes")]
            compute_branches_in_lanes!(crate::lanes::$pair: $two, crate::lanes::$four: $width);
            #[cfg(feature = "lanes")]
            #[inline(always)]
            fn apart<const N: usize>(mut numbers: [Self; N]) -> [Self; N] {
                if !registers::JOINED {
                    return numbers;
                }
                let (vectors, others) = numbers.as_chunks_mut();
                for vector in vectors {
                    *vector = Register::apart($vector::from(*vector)).to_array();
                }
                for number in others {
                    *number = Register::apart(*number);
                }
                numbers
            }
        }

        impl Real for $float {
            const EPSILON: Self = $float::EPSILON;
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
            #[inline]
            fn abs(self) -> Self {
                $fabs(self)
            }
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            #[inline]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

real!(f64, f64x2, F64x2: 2, F64x4: 4, trigonometry::double::of_one, trigonometry::lists::of_f64, libm::sqrt, libm::fabs, libm::pow);
real!(f32, f32x4, F32x4: 4, F32x4: 4, trigonometry::fast_path::sin_cos, trigonometry::lists::of_f32, libm::sqrtf, libm::fabsf, libm::powf);
