//! The scalars that functions are timed with.

use redysim::Scalar;
use redysim::lanes::{F32x8, F32x16, F64x4, F64x8};

/// A scalar with a name, whose lanes can be filled.
pub trait Numbers: Scalar {
    const NAME: &'static str;
    const LANES: usize;

    /// A scalar whose lanes are the next numbers.
    fn filled(next: impl FnMut() -> f64) -> Self;
}

impl Numbers for f64 {
    const NAME: &'static str = "f64";
    const LANES: usize = 1;

    fn filled(mut next: impl FnMut() -> f64) -> Self {
        next()
    }
}

impl Numbers for f32 {
    const NAME: &'static str = "f32";
    const LANES: usize = 1;

    fn filled(mut next: impl FnMut() -> f64) -> Self {
        next() as f32
    }
}

macro_rules! numbers {
    ($($lanes:ident: $width:literal of $float:ident;)*) => {$(
        impl Numbers for $lanes {
            const NAME: &'static str = stringify!($lanes);
            const LANES: usize = $width;

            fn filled(mut next: impl FnMut() -> f64) -> Self {
                let numbers: [$float; $width] = core::array::from_fn(|_| next() as $float);
                numbers.into()
            }
        }
    )*};
}

numbers! {
    F64x4: 4 of f64;
    F64x8: 8 of f64;
    F32x8: 8 of f32;
    F32x16: 16 of f32;
}
