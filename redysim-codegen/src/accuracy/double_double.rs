//! Numbers of about 31 digits, to judge the last digits of `f64` by.
//!
//! A number is an unevaluated sum of two `f64`. Sums and products follow Dekker, "A floating-point technique for
//! extending the available precision", Numerische Mathematik 18, 1971, with Knuth's branch-free exact sum.
//!
//! Operations are not inlined, as those of [symbols](crate::symbol).

use super::with_error::WithError;
use redysim_runtime::Scalar;
use std::ops::{Add, Div, Mul, Neg};

/// The number is the sum of value and error.
#[derive(Clone, Copy, Debug)]
pub enum Rest {}

/// `value` + `error`, with |error| at most half a unit in the last place of `value`.
pub type DoubleDouble = WithError<Rest>;

/// π/2, to three times the digits of `f64`.
const QUARTER_TURN: [f64; 3] = [std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_183_3e-33];

/// a + b as a sum of two numbers, without error.
fn exact_sum(a: f64, b: f64) -> DoubleDouble {
    let sum = a + b;
    let part = sum - a;
    DoubleDouble::new(sum, (a - (sum - part)) + (b - part))
}

/// a · b as a sum of two numbers, without error.
fn exact_product(a: f64, b: f64) -> DoubleDouble {
    let product = a * b;
    DoubleDouble::new(product, a.mul_add(b, -product))
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
        self.value
    }

    /// Sine and cosine of an angle of at most an eighth of a turn, by their power series.
    fn small_sin_cos(self) -> (Self, Self) {
        let (mut sin, mut cos) = (Self::zero(), Self::zero());
        let mut term = Self::one();
        for power in (0..32).step_by(4) {
            cos += term;
            term = (term * self).divided_by(f64::from(power + 1));
            sin += term;
            term = (term * self).divided_by(f64::from(power + 2));
            cos -= term;
            term = (term * self).divided_by(f64::from(power + 3));
            sin -= term;
            term = (term * self).divided_by(f64::from(power + 4));
        }
        (sin, cos)
    }

    /// The quotient by a number without error, in a third of the operations of a division by any other.
    fn divided_by(self, divisor: f64) -> Self {
        let quotient = self.value / divisor;
        // Exact, as the remainder of every division is.
        let remainder = quotient.mul_add(-divisor, self.value);
        exact_sum(quotient, (remainder + self.error) / divisor)
    }
}

impl Scalar for DoubleDouble {
    fn from_f64(value: f64) -> Self {
        DoubleDouble::new(value, 0.0)
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let turns = (self.value / QUARTER_TURN[0]).round();
        let reduced = QUARTER_TURN.iter().fold(self, |rest, &part| rest - exact_product(turns, part));
        let (sin, cos) = reduced.small_sin_cos();
        match (turns as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = Self::from_f64(self.value.sqrt());
        root + (self - root * root) / (root + root)
    }
}

impl Add for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn add(self, b: Self) -> Self {
        let (values, errors) = (exact_sum(self.value, b.value), exact_sum(self.error, b.error));
        let sum = exact_sum(values.value, values.error + errors.value);
        exact_sum(sum.value, sum.error + errors.error)
    }
}

impl Mul for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn mul(self, b: Self) -> Self {
        let product = exact_product(self.value, b.value);
        exact_sum(product.value, product.error + (self.value * b.error + self.error * b.value))
    }
}

impl Div for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn div(self, b: Self) -> Self {
        let quotient = |rest: Self| Self::from_f64(rest.value / b.value);
        let first = quotient(self);
        let rest = self - first * b;
        let second = quotient(rest);
        first + second + quotient(rest - second * b)
    }
}

impl Neg for DoubleDouble {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        DoubleDouble::new(-self.value, -self.error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sine and cosine of angles, each as the nearest `f64` and the nearest `f64` of what is left, from power series in
    /// rational numbers.
    const KNOWN: [(f64, [f64; 2], [f64; 2]); 3] = [
        (0.7, [0.644217687237691, 2.8740567927338755e-18], [0.7648421872844885, -4.013780434022238e-17]),
        (1.0, [0.8414709848078965, 1.776845092935536e-18], [0.5403023058681398, -4.760954612604417e-17]),
        (100.0, [-0.5063656411097588, -3.050947053792115e-18], [0.8623188722876839, 4.334809858136501e-17]),
    ];

    #[test]
    fn sines_and_cosines_have_thirty_digits() {
        for (angle, sine, cosine) in KNOWN {
            let (found_sine, found_cosine) = DoubleDouble::from_f64(angle).sin_cos();
            for (found, [value, rest]) in [(found_sine, sine), (found_cosine, cosine)] {
                assert_eq!(found.value, value, "at {angle}");
                // The reduction of the angle, and sixteen terms.
                assert!((found.error - rest).abs() <= 1e-30, "at {angle}: {:e} instead of {rest:e}", found.error);
            }
        }
    }
}
