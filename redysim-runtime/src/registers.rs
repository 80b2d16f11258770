//! Keeping the vectors of one state at 256 bits.
//!
//! Where the target has AVX-512, LLVM joins neighbouring vectors into 512 bits: two groups of four angles, the stores
//! of a result, the copy of an array. In code that works on one state this loses more than it wins. On some processors
//! (Intel's Sapphire Rapids) one such instruction costs the scalar code around it 40 ns, more than a whole call of the
//! inverse dynamics of six joints. LLVM has no option for it that a crate could set for its users, so numbers pass
//! through [`Register::apart`], which LLVM cannot look into: what comes out of it has no known neighbours.

#[cfg(all(target_arch = "x86_64", target_feature = "avx512f"))]
use core::arch::{asm, x86_64};

/// Whether the target has vectors of 512 bits, into which LLVM joins narrower ones.
pub const JOINED: bool = cfg!(all(target_arch = "x86_64", target_feature = "avx512f"));

/// A number, or several side by side, that a register of the target can hold.
pub trait Register: Copy {
    /// The same bits, of which the compiler knows no longer where they come from, in a register of 256 bits or less.
    /// Wider ones, and those of targets without AVX-512, stay as they are.
    #[inline(always)]
    fn apart(self) -> Self {
        self
    }
}

#[cfg(not(all(target_arch = "x86_64", target_feature = "avx512f")))]
mod known {
    use super::Register;

    impl Register for f32 {}
    impl Register for f64 {}
    impl Register for wide::f64x2 {}
    impl Register for wide::f64x4 {}
    impl Register for wide::f32x4 {}
    impl Register for wide::f32x8 {}
}

#[cfg(all(target_arch = "x86_64", target_feature = "avx512f"))]
macro_rules! registers {
    ($($number:ty, $register:ty, $class:ident;)*) => {$(
        impl Register for $number {
            #[inline(always)]
            #[allow(unsafe_code)]
            fn apart(self) -> Self {
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

#[cfg(all(target_arch = "x86_64", target_feature = "avx512f"))]
registers! {
    f32, f32, xmm_reg;
    f64, f64, xmm_reg;
    wide::f64x2, x86_64::__m128d, xmm_reg;
    wide::f64x4, x86_64::__m256d, ymm_reg;
    wide::f32x4, x86_64::__m128, xmm_reg;
    wide::f32x8, x86_64::__m256, ymm_reg;
}

impl Register for wide::f64x8 {}
impl Register for wide::f32x16 {}
