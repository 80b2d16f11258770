//! Keeping the vectors of one state as they are written.
//!
//! LLVM joins neighbouring vectors into wider ones, up to the widest of the target: two groups of four angles, the
//! sines and the cosines of a group, the stores of a result, the copy of an array. In code that works on one state this
//! loses more than it wins. Putting two vectors together and taking them apart again takes longer than the few
//! operations that are saved, and with 512 bits, on some processors (Intel's Sapphire Rapids), one instruction costs
//! the scalar code around it 40 ns, more than a whole call of the inverse dynamics of six joints. LLVM has no option
//! for it that a crate could set for its users, so numbers pass through [`Register::apart`], an optimisation barrier,
//! which LLVM cannot look into: what comes out of it has no known neighbours.
//!
//! Lanes pass the zeros of large matrices through [`Register::opaque`], so that LLVM does not call `memset` for them.

#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
use core::arch::{asm, x86_64};

/// Whether the target has vectors of 128 bits for `f64` and `f32`.
pub const VECTORS: bool = cfg!(any(
    target_feature = "sse2",
    all(target_arch = "aarch64", target_feature = "neon"),
    target_feature = "simd128"
));

/// Whether the target has vectors of 512 bits, into which LLVM joins those of 256 bits and single numbers.
pub const JOINED: bool = cfg!(all(target_arch = "x86_64", target_feature = "avx512f"));

/// A number, or several side by side, that a register of the target can hold.
pub trait Register: Copy {
    /// The same bits, of which the compiler no longer knows where they come from, where the target has wider vectors
    /// than 128 bits and, for numbers and vectors of 256 bits, than 256.
    #[inline(always)]
    fn apart(self) -> Self {
        self
    }

    /// The same bits, of which the compiler no longer knows what they are, where the target has vectors of 256 bits.
    #[inline(always)]
    fn opaque(self) -> Self {
        self
    }
}

/// Implements [`Register`] without a barrier, for targets without vectors of 256 bits.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
macro_rules! without_barrier {
    ($($number:ty),*) => {$(
        impl Register for $number {}
    )*};
}

/// Implements [`Register`] with empty assembly as the barrier. `apart` is whether the target has wider vectors, into which LLVM
/// would join these.
#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
macro_rules! with_barrier {
    ($($number:ty, $register:ty, $class:ident, apart: $apart:expr;)*) => {$(
        impl Register for $number {
            #[inline(always)]
            fn apart(self) -> Self {
                if $apart { self.opaque() } else { self }
            }

            #[inline(always)]
            #[allow(unsafe_code)]
            fn opaque(self) -> Self {
                let mut register: $register = bytemuck::cast(self);
                // SAFETY: the assembly is a comment. So it reads and writes no memory (`nomem`), uses no stack
                // (`nostack`), changes no flag (`preserves_flags`), does the same whenever it is run (`pure`), and
                // leaves its one operand as it was, which is a value of the operand's type.
                unsafe {
                    asm!("/* {0} */", inout($class) register, options(pure, nomem, nostack, preserves_flags));
                }
                bytemuck::cast(register)
            }
        }
    )*};
}

#[cfg(all(target_arch = "x86_64", target_feature = "avx"))]
with_barrier! {
    wide::f64x2, x86_64::__m128d, xmm_reg, apart: true;
    wide::f32x4, x86_64::__m128, xmm_reg, apart: true;
    wide::f64x4, x86_64::__m256d, ymm_reg, apart: JOINED;
    wide::f32x8, x86_64::__m256, ymm_reg, apart: JOINED;
    f64, f64, xmm_reg, apart: JOINED;
    f32, f32, xmm_reg, apart: JOINED;
}
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx")))]
without_barrier!(wide::f64x2, wide::f32x4, wide::f64x4, wide::f32x8, f64, f32);

#[cfg(all(target_arch = "x86_64", target_feature = "avx512f"))]
with_barrier! {
    wide::f64x8, x86_64::__m512d, zmm_reg, apart: false;
    wide::f32x16, x86_64::__m512, zmm_reg, apart: false;
}

/// Implements [`Register`] for vectors of 512 bits by their halves, where no register is as large.
#[cfg(not(all(target_arch = "x86_64", target_feature = "avx512f")))]
macro_rules! of_halves {
    ($($number:ty, $half:ty;)*) => {$(
        impl Register for $number {
            #[inline(always)]
            fn opaque(self) -> Self {
                let halves: [$half; 2] = bytemuck::cast(self);
                bytemuck::cast(halves.map(Register::opaque))
            }
        }
    )*};
}

#[cfg(not(all(target_arch = "x86_64", target_feature = "avx512f")))]
of_halves! {
    wide::f64x8, wide::f64x4;
    wide::f32x16, wide::f32x8;
}
