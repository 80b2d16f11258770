//! States in lanes, and back.

use crate::lanes::{self, Lanes};
use crate::{Real, Scalar};

/// A plain number with lanes to work on several at once: `f64` and `f32`, and no other.
pub trait Batched: Real + Send + Sync + Wider {
    /// The lanes of one vector of the target that the program is compiled for.
    type Lanes: Packed<Self>;
    /// The number of these lanes.
    const WIDTH: usize = <Self::Lanes as Packed<Self>>::WIDTH;
}

/// The lanes for instructions that the processor may have beyond those that the program is compiled for.
pub(crate) trait Wider: Real {
    /// Those of AVX2.
    type Avx2: Packed<Self>;
    /// Those of AVX-512.
    type Avx512: Packed<Self>;
}

/// Lanes to which states are brought, and from which results are.
pub trait Packed<T: Real>: Scalar + sealed::Sealed {
    /// The number of lanes.
    const WIDTH: usize;

    /// Up to [`WIDTH`](Self::WIDTH) states in lanes; lanes without a state repeat the last one.
    fn pack<const N: usize>(states: &[[T; N]]) -> [Self; N];

    /// Writes as many states as `states` has.
    fn unpack<const N: usize>(lanes: [Self; N], states: &mut [[T; N]]);

    /// Writes one element of as many matrices as there are.
    fn spread<const N: usize>(self, matrices: &mut [[[T; N]; N]], row: usize, column: usize);
}

mod sealed {
    /// Keeps other types from being lanes.
    pub trait Sealed {}
}

macro_rules! packed {
    ($($lanes:path: $width:literal of $float:ident;)*) => {$(
        impl sealed::Sealed for $lanes {}

        impl Packed<$float> for $lanes {
            const WIDTH: usize = $width;

            #[inline(always)]
            fn pack<const N: usize>(states: &[[$float; N]]) -> [Self; N] {
                pack::<_, _, $width, N>(states)
            }

            #[inline(always)]
            fn unpack<const N: usize>(lanes: [Self; N], states: &mut [[$float; N]]) {
                unpack::<_, _, $width, N>(lanes, states);
            }

            #[inline(always)]
            fn spread<const N: usize>(self, matrices: &mut [[[$float; N]; N]], row: usize, column: usize) {
                let numbers: [$float; $width] = self.into();
                if let Some(matrices) = matrices.first_chunk_mut::<$width>() {
                    // As many as there are lanes: no loop is left.
                    matrices.iter_mut().zip(numbers).for_each(|(matrix, number)| matrix[row][column] = number);
                } else {
                    matrices.iter_mut().zip(numbers).for_each(|(matrix, number)| matrix[row][column] = number);
                }
            }
        }
    )*};
}

packed! {
    lanes::F64x2: 2 of f64;
    lanes::F64x4: 4 of f64;
    lanes::F64x8: 8 of f64;
    lanes::F32x8: 8 of f32;
    lanes::F32x16: 16 of f32;
}

#[cfg(target_arch = "x86_64")]
mod wider {
    use super::{Packed, Wider, pack, sealed, unpack};
    use crate::dispatch::x86;

    packed! {
        x86::Avx2F64x4: 4 of f64;
        x86::Avx512F64x8: 8 of f64;
        x86::Avx2F32x8: 8 of f32;
        x86::Avx512F32x16: 16 of f32;
    }

    impl Wider for f64 {
        type Avx2 = x86::Avx2F64x4;
        type Avx512 = x86::Avx512F64x8;
    }

    impl Wider for f32 {
        type Avx2 = x86::Avx2F32x8;
        type Avx512 = x86::Avx512F32x16;
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl<T: Batched> Wider for T {
    type Avx2 = T::Lanes;
    type Avx512 = T::Lanes;
}

// Wider lanes than the target's vectors do not fit its registers: forward dynamics then takes half as long again.
impl Batched for f64 {
    #[cfg(target_feature = "avx512f")]
    type Lanes = lanes::F64x8;
    #[cfg(all(target_feature = "avx", not(target_feature = "avx512f")))]
    type Lanes = lanes::F64x4;
    #[cfg(not(target_feature = "avx"))]
    type Lanes = lanes::F64x2;
}

impl Batched for f32 {
    #[cfg(target_feature = "avx512f")]
    type Lanes = lanes::F32x16;
    #[cfg(not(target_feature = "avx512f"))]
    type Lanes = lanes::F32x8;
}

#[inline(always)]
fn pack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(states: &[[T; N]]) -> [L; N] {
    if let Some(states) = states.first_chunk::<W>() {
        return lanes::pack(states);
    }
    let last = states.last().copied().unwrap_or([T::default(); N]);
    let mut filled = [last; W];
    filled.iter_mut().zip(states).for_each(|(filled, state)| *filled = *state);
    lanes::pack(&filled)
}

#[inline(always)]
fn unpack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(lanes: [L; N], states: &mut [[T; N]]) {
    let found: [[T; N]; W] = lanes::unpack(lanes);
    if let Some(states) = states.first_chunk_mut::<W>() {
        *states = found;
    } else {
        states.iter_mut().zip(found).for_each(|(state, found)| *state = found);
    }
}
