//! Sine and cosine that are the same on every processor.

use super::angle::{Angle, Number};
use super::fast_path;
use super::reduction::Reduced;
use crate::scalar::Scalar;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Sine and cosine of an angle in radians, with every product and every sum rounded: the same bits on every processor and
/// with every choice of features, those of [`Scalar::sin_cos`] where multiply-adds are not [`FUSED`](crate::FUSED).
///
/// For constants that are computed while code is generated: these are not to depend on the machine that generates it.
pub fn unfused_sin_cos(angle: f64) -> (f64, f64) {
    let (Unfused(sin), Unfused(cos)) = fast_path::sin_cos(Unfused(angle));
    (sin, cos)
}

/// A number whose multiply-adds round twice, the default of [`Scalar::mul_add`].
#[derive(Clone, Copy, Debug)]
struct Unfused(f64);

macro_rules! operators {
    ($($trait:ident $method:ident $operator:tt),*) => {$(
        impl $trait for Unfused {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                Unfused(self.0 $operator other.0)
            }
        }
    )*};
}

operators!(Add add +, Sub sub -, Mul mul *, Div div /);

impl Neg for Unfused {
    type Output = Self;
    fn neg(self) -> Self {
        Unfused(-self.0)
    }
}

impl AddAssign for Unfused {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Unfused {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Scalar for Unfused {
    fn from_f64(value: f64) -> Self {
        Unfused(value)
    }

    fn sin_cos(self) -> (Self, Self) {
        fast_path::sin_cos(self)
    }

    fn sqrt(self) -> Self {
        Unfused(libm::sqrt(self.0))
    }
}

impl Number for Unfused {
    type Kernel = <f64 as Number>::Kernel;
    const HALF_PI: [Self; 2] = [Unfused(f64::HALF_PI[0]), Unfused(f64::HALF_PI[1])];

    fn reduced(self) -> Reduced<Self> {
        Number::reduced(self.0).map(Unfused)
    }
}

impl Angle for Unfused {
    type Number = Self;
    const FUSED: bool = false;

    fn all_at_most(self, limit: Self) -> bool {
        self.0.all_at_most(limit.0)
    }

    fn lesser(self, other: Self) -> Self {
        Unfused(self.0.lesser(other.0))
    }

    fn turned(rounded: Self, sin: Self, cos: Self) -> (Self, Self) {
        let (sin, cos) = Angle::turned(rounded.0, sin.0, cos.0);
        (Unfused(sin), Unfused(cos))
    }

    #[inline(never)]
    #[cold]
    fn one_by_one(self, function: impl Fn(Self) -> (Self, Self)) -> (Self, Self) {
        function(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sum of the bits of all sines and cosines, each times an odd number of its own.
    fn digest(sin_cos: impl Fn(f64) -> (f64, f64)) -> u64 {
        let angles = (1..4000_u32).flat_map(|k| [0.37 * f64::from(k), 1e3 / f64::from(k), 1e9 * f64::from(k)]);
        angles.zip(0_u64..).fold(0, |digest, (angle, index)| {
            let (sin, cos) = sin_cos(angle);
            let of = |x: f64, factor: u64| x.to_bits().wrapping_mul(factor);
            digest.wrapping_add(of(sin, 4 * index + 1)).wrapping_add(of(cos, 4 * index + 3))
        })
    }

    #[test]
    fn sines_and_cosines_have_the_same_bits_on_every_processor() {
        // That of `Scalar::sin_cos` in a program without fused multiply-adds.
        let expected = 0x9f07_255f_bca7_6d19;
        assert_eq!(digest(unfused_sin_cos), expected);
        assert_eq!(digest(Scalar::sin_cos) == expected, !crate::FUSED);
    }
}
