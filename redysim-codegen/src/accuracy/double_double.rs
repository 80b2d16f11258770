//! Numbers of about 31 digits, to judge the last digits of `f64` by.
//!
//! A value is an unevaluated sum of two `f64`. Sums and products follow Dekker, "A floating-point technique for
//! extending the available precision", Numerische Mathematik 18, 1971, with Knuth's branch-free exact sum.

use redysim_runtime::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// `high` + `low`, with |low| at most half a unit in the last place of `high`.
#[derive(Clone, Copy, Debug)]
pub struct DoubleDouble {
    high: f64,
    low: f64,
}

/// π/2, to three times the digits of `f64`.
const QUARTER_TURN: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_183_3e-33];

/// a + b as a sum of two numbers, without error.
fn exact_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    let part = high - a;
    DoubleDouble { high, low: (a - (high - part)) + (b - part) }
}

/// a · b as a sum of two numbers, without error.
fn exact_product(a: f64, b: f64) -> DoubleDouble {
    let high = a * b;
    DoubleDouble { high, low: a.mul_add(b, -high) }
}

/// Numbers without error.
pub fn exact(values: &[f64]) -> Vec<DoubleDouble> {
    values.iter().map(|&value| DoubleDouble::from_f64(value)).collect()
}

/// The nearest `f64` of each.
pub fn rounded(values: impl AsRef<[DoubleDouble]>) -> Vec<f64> {
    values.as_ref().iter().map(|value| value.to_f64()).collect()
}

impl DoubleDouble {
    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        self.high
    }

    /// Sine and cosine of an angle of at most an eighth of a turn, by their power series.
    fn small_sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (Self::zero(), Self::zero());
        let mut term = Self::one();
        for power in (0..32).step_by(4) {
            cos += term;
            term = term * self / Self::from_f64(f64::from(power + 1));
            sin += term;
            term = term * self / Self::from_f64(f64::from(power + 2));
            cos -= term;
            term = term * self / Self::from_f64(f64::from(power + 3));
            sin -= term;
            term = term * self / Self::from_f64(f64::from(power + 4));
        }
        (sin, cos)
    }
}

impl Scalar for DoubleDouble {
    fn from_f64(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }
    fn sin_cos(self) -> (Self, Self) {
        let turns = (self.high / QUARTER_TURN[0]).round();
        let reduced = QUARTER_TURN.iter().fold(self, |rest, &part| rest - exact_product(turns, part));
        let (sin, cos) = reduced.small_sin_cos();
        match (turns as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
    fn sqrt(self) -> Self {
        let root = Self::from_f64(self.high.sqrt());
        root + (self - root * root) / (root + root)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let (high, low) = (exact_sum(self.high, b.high), exact_sum(self.low, b.low));
        let sum = exact_sum(high.high, high.low + low.high);
        exact_sum(sum.high, sum.low + low.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        let product = exact_product(self.high, b.high);
        exact_sum(product.high, product.low + (self.high * b.low + self.low * b.high))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    fn div(self, b: Self) -> Self {
        let quotient = |rest: Self| Self::from_f64(rest.high / b.high);
        let first = quotient(self);
        let rest = self - first * b;
        let second = quotient(rest);
        first + second + quotient(rest - second * b)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        DoubleDouble { high: -self.high, low: -self.low }
    }
}

impl AddAssign for DoubleDouble {
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl SubAssign for DoubleDouble {
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
