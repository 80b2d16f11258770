//! Code for the instructions that the processor turns out to have, in a program compiled for any x86-64.
//!
//! A number's type fixes the instructions: the operators of `x86::Avx512F64x8` are instructions of AVX-512, whatever
//! the program is compiled for, and its `with_target_features` compiles what it runs for a processor that has them. So
//! a function that takes any [`Scalar`](crate::Scalar) becomes code for AVX-512 by being called with these lanes, and
//! the only question that is left for run time is which of its forms to call. [`batch`](crate::batch) asks it once for
//! each call, [`Dispatched`] once when it is made.

mod single_calls;
#[cfg(all(test, target_arch = "x86_64"))]
mod tests;
#[cfg(target_arch = "x86_64")]
pub(crate) mod x86;

pub use single_calls::{Dispatch, Dispatched};

/// What a processor may have beyond what the program is compiled for, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Instructions {
    /// Those that the program is compiled for.
    Compiled,
    /// AVX2 and fused multiply-add: `x86-64-v3`, about every x86-64 processor since 2015.
    Avx2,
    /// AVX-512 with its extensions F, BW, CD, DQ and VL: `x86-64-v4`.
    Avx512,
}

impl Instructions {
    /// The best instructions of this processor; [`Compiled`](Self::Compiled) if the program is compiled for them.
    pub fn detected() -> Self {
        match Self::of_processor() {
            Self::Avx512 if cfg!(target_feature = "avx512f") => Self::Compiled,
            Self::Avx2 if cfg!(target_feature = "fma") => Self::Compiled,
            best => best,
        }
    }

    /// The best instructions of this processor, independent of the program's target.
    #[cfg(target_arch = "x86_64")]
    pub(crate) fn of_processor() -> Self {
        use std::is_x86_feature_detected as has;
        let avx2 = has!("avx2") && has!("fma") && has!("bmi1") && has!("bmi2");
        let avx512 = has!("avx512f") && has!("avx512bw") && has!("avx512cd") && has!("avx512dq") && has!("avx512vl");
        match (avx2, avx512) {
            (true, true) => Self::Avx512,
            (true, false) => Self::Avx2,
            (false, _) => Self::Compiled,
        }
    }

    /// The best instructions of this processor, independent of the program's target.
    #[cfg(not(target_arch = "x86_64"))]
    pub(crate) fn of_processor() -> Self {
        Self::Compiled
    }
}
