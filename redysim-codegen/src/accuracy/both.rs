//! Exact values and bounds of roundings by one run of a recursion, which is then compiled for one kind of number instead
//! of two.
//!
//! Operations are not inlined, as those of [symbols](crate::symbol).

use super::double_double::DoubleDouble;
use super::rounding::Rounded;
use redysim_runtime::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A value in double-double arithmetic, and beside it in `f64` with a bound of its rounding errors.
#[derive(Clone, Copy, Debug)]
pub struct Both {
    pub exact: DoubleDouble,
    pub rounded: Rounded,
}

impl Both {
    /// A number that is given, so without error.
    pub fn given(value: f64) -> Self {
        Both { exact: DoubleDouble::from_f64(value), rounded: Rounded::given(value) }
    }
}

impl Scalar for Both {
    fn from_f64(value: f64) -> Self {
        Both { exact: DoubleDouble::from_f64(value), rounded: Rounded::from_f64(value) }
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (exact, rounded) = (self.exact.sin_cos(), self.rounded.sin_cos());
        (Both { exact: exact.0, rounded: rounded.0 }, Both { exact: exact.1, rounded: rounded.1 })
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        Both { exact: self.exact.sqrt(), rounded: self.rounded.sqrt() }
    }
}

impl Add for Both {
    type Output = Self;
    #[inline(never)]
    fn add(self, b: Self) -> Self {
        Both { exact: self.exact + b.exact, rounded: self.rounded + b.rounded }
    }
}

impl Sub for Both {
    type Output = Self;
    #[inline(never)]
    fn sub(self, b: Self) -> Self {
        Both { exact: self.exact - b.exact, rounded: self.rounded - b.rounded }
    }
}

impl Mul for Both {
    type Output = Self;
    #[inline(never)]
    fn mul(self, b: Self) -> Self {
        Both { exact: self.exact * b.exact, rounded: self.rounded * b.rounded }
    }
}

impl Div for Both {
    type Output = Self;
    #[inline(never)]
    fn div(self, b: Self) -> Self {
        Both { exact: self.exact / b.exact, rounded: self.rounded / b.rounded }
    }
}

impl Neg for Both {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Both { exact: -self.exact, rounded: -self.rounded }
    }
}

impl AddAssign for Both {
    #[inline(never)]
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl SubAssign for Both {
    #[inline(never)]
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
