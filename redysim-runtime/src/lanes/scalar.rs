//! The operations of lanes beyond arithmetic.

use super::{F32x4, F32x8, F32x16, F64x2, F64x4, F64x8};
use crate::registers::Register;
use crate::scalar::{FUSED, Scalar};
use crate::trigonometry::in_turn::in_turn;
use crate::trigonometry::{fast_path, turns};

macro_rules! scalar {
    ($lanes:ident($wide:ident) of $float:ident) => {
        impl Scalar for $lanes {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self(wide::$wide::splat(value as $float))
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                fast_path::sin_cos(self)
            }

            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
                in_turn(angles)
            }

            #[inline(always)]
            fn without_turns<const N: usize>(angles: [Self; N]) -> [Self; N] {
                turns::without_turns(angles)
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                Self(self.0.sqrt())
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                if FUSED { Self(self.0.mul_add(factor.0, addend.0)) } else { self * factor + addend }
            }

            #[inline(always)]
            fn opaque_zero() -> Self {
                Self(Register::opaque(Self::zero().0))
            }

            #[inline(always)]
            fn apart<const N: usize>(mut numbers: [Self; N]) -> [Self; N] {
                for number in &mut numbers {
                    number.0 = Register::apart(number.0);
                }
                numbers
            }
        }
    };
}

scalar!(F64x2(f64x2) of f64);
scalar!(F64x4(f64x4) of f64);
scalar!(F64x8(f64x8) of f64);
scalar!(F32x4(f32x4) of f32);
scalar!(F32x8(f32x8) of f32);
scalar!(F32x16(f32x16) of f32);
