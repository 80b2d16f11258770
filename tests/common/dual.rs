//! Dual numbers: derivatives along a direction, exact to roundoff.

use redysim::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// x + ε ẋ with ε² = 0.
#[derive(Clone, Copy, Debug)]
pub struct Dual<S> {
    pub value: S,
    pub rate: S,
}

/// The numbers `values`, which change at `rates`.
pub fn moving<S: Scalar>(values: &[S], rates: &[S]) -> Vec<Dual<S>> {
    values.iter().zip(rates).map(|(&value, &rate)| Dual { value, rate }).collect()
}

impl<S: Scalar> Scalar for Dual<S> {
    fn from_f64(value: f64) -> Self {
        Dual { value: S::from_f64(value), rate: S::zero() }
    }
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (Dual { value: sin, rate: cos * self.rate }, Dual { value: cos, rate: -sin * self.rate })
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Dual { value: root, rate: self.rate / (root + root) }
    }
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Dual { value: self.value + b.value, rate: self.rate + b.rate }
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Dual { value: self.value * b.value, rate: self.rate * b.value + self.value * b.rate }
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let value = self.value / b.value;
        Dual { value, rate: (self.rate - value * b.rate) / b.value }
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Dual { value: -self.value, rate: -self.rate }
    }
}

impl<S: Scalar> AddAssign for Dual<S> {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<S: Scalar> SubAssign for Dual<S> {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
