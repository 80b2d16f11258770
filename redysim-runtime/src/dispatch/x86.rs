//! Numbers whose operations are the instructions of AVX2 with FMA, or of AVX-512.
//!
//! # Safety
//!
//! Every `unsafe` block of this file calls a function that is compiled for target features which the program is not compiled
//! for, but for two that have their own proofs: one reads what was just written, the other is assembly without instructions.
//! Such a call is undefined on a processor without the features, and harmless on one that has them. The types are
//! private to this crate, and so are the traits through which generic code of this crate reaches them, so that no other
//! crate can name them, make a value of one, or call a function for one. This crate does so in two places,
//! [`batch`](crate::batch) and [`Dispatched`](super::Dispatched), both behind
//! [`Instructions::of_processor`](super::Instructions), which has found the features. Code of other crates meets
//! these types only as the parameter of a generic function that those two call. Therefore the processor has the
//! features whenever an operation of these types runs.
//!
//! Vectors go in and out of functions through memory in Rust's own calling convention, so that no call depends on the
//! features of either side. `loadu` and `storeu` read and write arrays as large as the vector, which need no alignment.

#![allow(unsafe_code)]

use crate::branches::compute_branches_in_lanes;
use crate::scalar::Scalar;
use crate::trigonometry::angle::{Angle, Number};
use crate::trigonometry::in_turn::in_turn;
use crate::trigonometry::reduction::Reduced;
use crate::trigonometry::several::several;
use crate::trigonometry::{fast_path, turns};
use core::arch::asm;
use core::arch::x86_64::*;
use core::fmt;
use core::mem::MaybeUninit;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Whether multiply and add round once.
const FUSED: bool = cfg!(not(feature = "deterministic"));

/// Adding and subtracting in place, by the other operators.
macro_rules! assigning {
    ($name:ty) => {
        impl AddAssign for $name {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }

        impl SubAssign for $name {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
    };
}

/// The size in bytes up to which a result is returned in registers, two numbers at most.
///
/// LLVM makes a function part of one with more target features only if none of its calls return several numbers in registers:
/// how these are passed might depend on the features. Such a result, as that of `energy`, goes through memory, so that code
/// for AVX2 that calls a function for AVX2 by way of a trait becomes one piece.
const IN_REGISTERS: usize = 16;

/// `Scalar::with_target_features` of a number whose operations need `$features`.
macro_rules! with_target_features {
    ($features:literal) => {
        #[inline(always)]
        fn with_target_features<R>(computation: impl FnOnce() -> R) -> R {
            #[target_feature(enable = $features)]
            fn enabled<R>(computation: impl FnOnce() -> R) -> R {
                computation()
            }
            if size_of::<R>() > IN_REGISTERS {
                // SAFETY: the processor has these features, see the head of the file.
                return unsafe { enabled(computation) };
            }
            let mut result = MaybeUninit::uninit();
            // SAFETY: as above.
            unsafe {
                enabled(
                    #[inline(always)]
                    || {
                        result.write(computation());
                    },
                )
            };
            // SAFETY: `enabled` has returned, so the closure has run to its end, where it has written the result.
            unsafe { result.assume_init() }
        }
    };
}

macro_rules! numbers {
    ($($(#[$documentation:meta])* $name:ident($float:ident), $lanes:ident: $width:literal, branches: $pair:ident: $two:literal, $four:ident;)*) => {$(
        $(#[$documentation])*
        #[derive(Clone, Copy, Debug, Default)]
        #[repr(transparent)]
        pub struct $name(pub $float);

        numbers!(@operators $name: Add add +, Sub sub -, Mul mul *, Div div /);
        assigning!($name);

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }

        impl Scalar for $name {
            const AT_ONCE: bool = true;

            with_target_features!("avx2,fma,bmi1,bmi2");
            compute_branches_in_lanes!($pair: $two, $four: 4);

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                Self(value as $float)
            }

            #[inline(always)]
            fn sin_cos(self) -> (Self, Self) {
                fast_path::sin_cos(self)
            }

            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
                several::<Self, $lanes, $lanes, $width, $width, N>(angles)
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
        }

        impl Number for $name {
            type Kernel = <$float as Number>::Kernel;
            const HALF_PI: [Self; 2] = [Self($float::HALF_PI[0]), Self($float::HALF_PI[1])];

            #[inline(always)]
            fn reduced(self) -> Reduced<Self> {
                Number::reduced(self.0).map(Self)
            }
        }

        impl Angle for $name {
            type Number = Self;
            const FUSED: bool = FUSED;

            #[inline(always)]
            fn all_at_most(self, limit: Self) -> bool {
                self.0.all_at_most(limit.0)
            }

            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                Self(self.0.lesser(other.0))
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                let (sin, cos) = Angle::turned(rounded.0, sin.0, cos.0);
                (Self(sin), Self(cos))
            }

            #[inline(never)]
            #[cold]
            fn one_by_one(self, function: impl Fn(Self) -> (Self, Self)) -> (Self, Self) {
                Self::with_target_features(
                    #[inline(always)]
                    || function(self),
                )
            }
        }
    )*};
    (@operators $name:ident: $($operator:ident $operation:ident $sign:tt),*) => {$(
        impl $operator for $name {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                Self(self.0 $sign other.0)
            }
        }
    )*};
}

numbers! {
    /// An `f64` in code for AVX2 and FMA.
    Avx2F64(f64), Avx2F64x4: 4, branches: Avx2F64x2: 2, Avx2F64x4;
    /// An `f32` in code for AVX2 and FMA.
    Avx2F32(f32), Avx2F32x8: 8, branches: Avx2F32x4: 4, Avx2F32x4;
}

/// The instructions of one kind of vector. Bits are those of integers as wide as the numbers.
macro_rules! lanes {
    ($(#[$documentation:meta])* $name:ident($register:ident in $class:ident): $width:literal of $float:ident ($number:ident) by $features:literal,
     $splat:ident, $load:ident, $store:ident, $sqrt:ident, $min:ident, $fused:ident,
     [$($operator:ident $operation:ident $instruction:ident),*],
     bits: $to_bits:ident, $from_bits:ident, $splat_bits:ident, $and:ident, $xor:ident, $plus:ident, $minus:ident,
     $shift:ident::<$second_bit_to_sign:literal>, at_most: |$left:ident, $right:ident| $at_most:expr) => {
        $(#[$documentation])*
        #[derive(Clone, Copy)]
        #[repr(transparent)]
        pub struct $name($register);

        impl $name {
            #[inline(always)]
            pub fn to_array(self) -> [$float; $width] {
                let mut numbers = [0.0; $width];
                // SAFETY: see the head of the file.
                unsafe { $store(numbers.as_mut_ptr(), self.0) };
                numbers
            }

            /// `function` of the negative of each lane.
            #[inline(never)]
            #[cold]
            fn negatives_one_by_one(self, function: impl Fn($number) -> ($number, $number)) -> (Self, Self) {
                Self::with_target_features(
                    #[inline(always)]
                    || {
                        let (mut sin, mut cos) = (self.to_array(), self.to_array());
                        for (sin, cos) in sin.iter_mut().zip(&mut cos) {
                            let (one_sin, one_cos) = function($number(-*sin));
                            (*sin, *cos) = (one_sin.0, one_cos.0);
                        }
                        (Self::from(sin), Self::from(cos))
                    },
                )
            }
        }

        impl From<[$float; $width]> for $name {
            #[inline(always)]
            fn from(numbers: [$float; $width]) -> Self {
                // SAFETY: see the head of the file.
                Self(unsafe { $load(numbers.as_ptr()) })
            }
        }

        impl From<$name> for [$float; $width] {
            #[inline(always)]
            fn from(lanes: $name) -> Self {
                lanes.to_array()
            }
        }

        impl From<[$number; $width]> for $name {
            #[inline(always)]
            fn from(numbers: [$number; $width]) -> Self {
                let mut floats = [0.0; $width];
                for (float, number) in floats.iter_mut().zip(numbers) {
                    *float = number.0;
                }
                Self::from(floats)
            }
        }

        impl From<$name> for [$number; $width] {
            #[inline(always)]
            fn from(lanes: $name) -> Self {
                let mut numbers = [$number(0.0); $width];
                for (number, float) in numbers.iter_mut().zip(lanes.to_array()) {
                    *number = $number(float);
                }
                numbers
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.debug_tuple(stringify!($name)).field(&self.to_array()).finish()
            }
        }

        $(impl $operator for $name {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        })*
        assigning!($name);

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: see the head of the file.
                Self(unsafe { $from_bits($xor($to_bits(self.0), $to_bits($splat(-0.0)))) })
            }
        }

        impl Scalar for $name {
            with_target_features!($features);

            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                // SAFETY: see the head of the file.
                Self(unsafe { $splat(value as $float) })
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
                // SAFETY: see the head of the file.
                Self(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn mul_add(self, factor: Self, addend: Self) -> Self {
                if FUSED {
                    // SAFETY: see the head of the file.
                    Self(unsafe { $fused(self.0, factor.0, addend.0) })
                } else {
                    self * factor + addend
                }
            }

            #[inline(always)]
            fn opaque_zero() -> Self {
                #[target_feature(enable = $features)]
                #[inline]
                fn opaque(mut zero: $register) -> $register {
                    // SAFETY: the assembly is a comment: it has no effect that the options exclude, and leaves its operand as it
                    // was.
                    unsafe {
                        asm!("/* {0} */", inout($class) zero, options(pure, nomem, nostack, preserves_flags));
                    }
                    zero
                }
                // SAFETY: see the head of the file.
                Self(unsafe { opaque($splat(0.0)) })
            }
        }

        impl Angle for $name {
            type Number = $number;
            const FUSED: bool = FUSED;

            #[inline(always)]
            fn all_at_most(self, limit: Self) -> bool {
                let ($left, $right) = (self.0, limit.0);
                // SAFETY: see the head of the file.
                unsafe { $at_most }
            }

            #[inline(always)]
            fn lesser(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                Self(unsafe { $min(self.0, other.0) })
            }

            #[inline(always)]
            fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
                // SAFETY: see the head of the file.
                unsafe {
                    let (one, two) = ($splat_bits(1), $splat_bits(2));
                    let (turns, sin, cos) = ($to_bits(rounded.0), $to_bits(sin.0), $to_bits(cos.0));
                    let odd = $minus($splat_bits(0), $and(turns, one));
                    let differing = $and($xor(sin, cos), odd);
                    let sin_sign = $shift::<$second_bit_to_sign>($and(turns, two));
                    let cos_sign = $shift::<$second_bit_to_sign>($and($plus(turns, one), two));
                    let sin = $xor($xor(sin, differing), sin_sign);
                    let cos = $xor($xor(cos, differing), cos_sign);
                    (Self($from_bits(sin)), Self($from_bits(cos)))
                }
            }

            #[inline(always)]
            fn one_by_one(self, function: impl Fn($number) -> ($number, $number)) -> (Self, Self) {
                (-self).negatives_one_by_one(function)
            }
        }
    };
}

lanes! {
    /// Two `f64`.
    Avx2F64x2(__m128d in xmm_reg): 2 of f64 (Avx2F64) by "avx2,fma,bmi1,bmi2",
    _mm_set1_pd, _mm_loadu_pd, _mm_storeu_pd, _mm_sqrt_pd, _mm_min_pd, _mm_fmadd_pd,
    [Add add _mm_add_pd, Sub sub _mm_sub_pd, Mul mul _mm_mul_pd, Div div _mm_div_pd],
    bits: _mm_castpd_si128, _mm_castsi128_pd, _mm_set1_epi64x,
    _mm_and_si128, _mm_xor_si128, _mm_add_epi64, _mm_sub_epi64, _mm_slli_epi64::<62>,
    at_most: |number, limit| _mm_movemask_pd(_mm_cmple_pd(number, limit)) == 0b11
}

lanes! {
    /// Four `f32`.
    Avx2F32x4(__m128 in xmm_reg): 4 of f32 (Avx2F32) by "avx2,fma,bmi1,bmi2",
    _mm_set1_ps, _mm_loadu_ps, _mm_storeu_ps, _mm_sqrt_ps, _mm_min_ps, _mm_fmadd_ps,
    [Add add _mm_add_ps, Sub sub _mm_sub_ps, Mul mul _mm_mul_ps, Div div _mm_div_ps],
    bits: _mm_castps_si128, _mm_castsi128_ps, _mm_set1_epi32,
    _mm_and_si128, _mm_xor_si128, _mm_add_epi32, _mm_sub_epi32, _mm_slli_epi32::<30>,
    at_most: |number, limit| _mm_movemask_ps(_mm_cmple_ps(number, limit)) == 0xf
}

lanes! {
    /// Four `f64`.
    Avx2F64x4(__m256d in ymm_reg): 4 of f64 (Avx2F64) by "avx2,fma,bmi1,bmi2",
    _mm256_set1_pd, _mm256_loadu_pd, _mm256_storeu_pd, _mm256_sqrt_pd, _mm256_min_pd, _mm256_fmadd_pd,
    [Add add _mm256_add_pd, Sub sub _mm256_sub_pd, Mul mul _mm256_mul_pd, Div div _mm256_div_pd],
    bits: _mm256_castpd_si256, _mm256_castsi256_pd, _mm256_set1_epi64x,
    _mm256_and_si256, _mm256_xor_si256, _mm256_add_epi64, _mm256_sub_epi64, _mm256_slli_epi64::<62>,
    at_most: |number, limit| _mm256_movemask_pd(_mm256_cmp_pd::<_CMP_LE_OQ>(number, limit)) == 0xf
}

lanes! {
    /// Eight `f32`.
    Avx2F32x8(__m256 in ymm_reg): 8 of f32 (Avx2F32) by "avx2,fma,bmi1,bmi2",
    _mm256_set1_ps, _mm256_loadu_ps, _mm256_storeu_ps, _mm256_sqrt_ps, _mm256_min_ps, _mm256_fmadd_ps,
    [Add add _mm256_add_ps, Sub sub _mm256_sub_ps, Mul mul _mm256_mul_ps, Div div _mm256_div_ps],
    bits: _mm256_castps_si256, _mm256_castsi256_ps, _mm256_set1_epi32,
    _mm256_and_si256, _mm256_xor_si256, _mm256_add_epi32, _mm256_sub_epi32, _mm256_slli_epi32::<30>,
    at_most: |number, limit| _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(number, limit)) == 0xff
}

lanes! {
    /// Eight `f64`.
    Avx512F64x8(__m512d in zmm_reg): 8 of f64 (Avx2F64) by "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2",
    _mm512_set1_pd, _mm512_loadu_pd, _mm512_storeu_pd, _mm512_sqrt_pd, _mm512_min_pd, _mm512_fmadd_pd,
    [Add add _mm512_add_pd, Sub sub _mm512_sub_pd, Mul mul _mm512_mul_pd, Div div _mm512_div_pd],
    bits: _mm512_castpd_si512, _mm512_castsi512_pd, _mm512_set1_epi64,
    _mm512_and_si512, _mm512_xor_si512, _mm512_add_epi64, _mm512_sub_epi64, _mm512_slli_epi64::<62>,
    at_most: |number, limit| _mm512_cmp_pd_mask::<_CMP_LE_OQ>(number, limit) == 0xff
}

lanes! {
    /// Sixteen `f32`.
    Avx512F32x16(__m512 in zmm_reg): 16 of f32 (Avx2F32) by "avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx2,fma,bmi1,bmi2",
    _mm512_set1_ps, _mm512_loadu_ps, _mm512_storeu_ps, _mm512_sqrt_ps, _mm512_min_ps, _mm512_fmadd_ps,
    [Add add _mm512_add_ps, Sub sub _mm512_sub_ps, Mul mul _mm512_mul_ps, Div div _mm512_div_ps],
    bits: _mm512_castps_si512, _mm512_castsi512_ps, _mm512_set1_epi32,
    _mm512_and_si512, _mm512_xor_si512, _mm512_add_epi32, _mm512_sub_epi32, _mm512_slli_epi32::<30>,
    at_most: |number, limit| _mm512_cmp_ps_mask::<_CMP_LE_OQ>(number, limit) == 0xffff
}
