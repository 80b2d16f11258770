//! Several numbers side by side as one scalar, so that one call of a mechanism's function works on many states at once.
//!
//! Every operation is done in all lanes by one instruction where the target has vectors that wide (AVX-512 has 8 ×
//! `f64` and 16 × `f32`, AVX half of that, SSE2 and NEON a quarter), else by a few. Each lane holds the bits that the
//! same operations on plain numbers would give.
//!
//! Choose a type as wide as the target's vectors. Code for a wider one takes several registers for each value, and so keeps
//! more of them in memory. `batch` chooses by itself.
//!
//! ```
//! use redysim_runtime::Scalar;
//! use redysim_runtime::lanes::F64x8;
//!
//! /// The torque that holds a pendulum of 2 kg m at an angle from below, N m.
//! fn holding<S: Scalar>(angle: S) -> S {
//!     let (sin, _) = angle.sin_cos();
//!     S::from_f64(2.0 * 9.81) * sin
//! }
//!
//! let angles = [0.0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4];
//! assert_eq!(holding(F64x8::from(angles)).to_array(), angles.map(holding));
//! ```

mod angle;
mod scalar;
mod transpose;

pub use transpose::{pack, unpack};

use crate::scalar::Scalar;
use core::fmt;
use core::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};

/// A scalar made of `W` numbers side by side, such as [`F64x8`] of eight `f64`.
pub trait Lanes<T, const W: usize>: Scalar + From<[T; W]> + Into<[T; W]> {}

impl<T, const W: usize, L: Scalar + From<[T; W]> + Into<[T; W]>> Lanes<T, W> for L {}

macro_rules! operators {
    ($lanes:ident: $($operator:ident $operation:ident, $assigning:ident $assignment:ident;)*) => {$(
        impl $operator for $lanes {
            type Output = Self;
            #[inline(always)]
            fn $operation(self, other: Self) -> Self {
                Self($operator::$operation(self.0, other.0))
            }
        }

        impl $assigning for $lanes {
            #[inline(always)]
            fn $assignment(&mut self, other: Self) {
                *self = $operator::$operation(*self, other);
            }
        }
    )*};
}

macro_rules! lanes {
    ($(#[$documentation:meta])* $lanes:ident($wide:ident): $width:literal of $float:ident) => {
        $(#[$documentation])*
        #[derive(Clone, Copy, Default, PartialEq)]
        #[repr(transparent)]
        pub struct $lanes(pub(crate) wide::$wide);

        impl $lanes {
            /// The number in each lane.
            #[inline(always)]
            pub fn to_array(self) -> [$float; $width] {
                self.0.to_array()
            }
        }

        impl From<[$float; $width]> for $lanes {
            #[inline(always)]
            fn from(numbers: [$float; $width]) -> Self {
                Self(numbers.into())
            }
        }

        impl From<$lanes> for [$float; $width] {
            #[inline(always)]
            fn from(lanes: $lanes) -> Self {
                lanes.to_array()
            }
        }

        impl fmt::Debug for $lanes {
            fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.debug_tuple(stringify!($lanes)).field(&self.to_array()).finish()
            }
        }

        operators! { $lanes:
            Add add, AddAssign add_assign;
            Sub sub, SubAssign sub_assign;
            Mul mul, MulAssign mul_assign;
            Div div, DivAssign div_assign;
        }

        impl Neg for $lanes {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self(-self.0)
            }
        }
    };
}

lanes! {
    /// Two `f64`: the vectors of SSE2 (every x86-64) and NEON.
    F64x2(f64x2): 2 of f64
}

lanes! {
    /// Four `f64`: the vectors of AVX.
    F64x4(f64x4): 4 of f64
}

lanes! {
    /// Eight `f64`: the vectors of AVX-512.
    F64x8(f64x8): 8 of f64
}

lanes! {
    /// Four `f32`: the vectors of SSE2 (every x86-64) and NEON.
    F32x4(f32x4): 4 of f32
}

lanes! {
    /// Eight `f32`: the vectors of AVX.
    F32x8(f32x8): 8 of f32
}

lanes! {
    /// Sixteen `f32`: the vectors of AVX-512.
    F32x16(f32x16): 16 of f32
}
