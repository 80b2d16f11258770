//! Numbers that carry a bound of the rounding errors they have collected.
//!
//! Running error analysis (Wilkinson; Higham, "Accuracy and Stability of Numerical Algorithms", section 3.3): each
//! operation adds half a unit in the last place of its result to the propagated errors of its operands. Constants of a
//! model have been computed with a few roundings each, which a pass over expressions may do in another order.
//!
//! Operations are not inlined, as those of [symbols](crate::symbol).

use super::with_error::WithError;
use redysim_runtime::Scalar;
use std::ops::{Add, Div, Mul, Neg};

/// The largest relative error of one operation, 2⁻⁵³.
const UNIT: f64 = 0.5 * f64::EPSILON;
/// Roundings of a constant.
const OF_CONSTANT: f64 = 8.0;
/// Roundings of a sine or a cosine.
const OF_SINE: f64 = 2.0;

/// The error is a bound.
#[derive(Clone, Copy, Debug)]
pub enum Bound {}

/// A value computed in `f64`, with a bound of its distance from the exact value: |`value` − exact| ≤ `error`. The bound
/// is infinite or NaN where none is known.
pub type Rounded = WithError<Bound>;

impl Rounded {
    /// A number that is given, so without error.
    pub fn given(value: f64) -> Self {
        Rounded::new(value, 0.0)
    }

    /// The bound of the distance from the exact value.
    #[cfg(feature = "source")]
    pub(crate) fn error_bound(self) -> f64 {
        self.error
    }

    /// A result with the errors of its operands, and those of its own roundings.
    fn result(value: f64, from_operands: f64, roundings: f64) -> Self {
        // The bound is computed with roundings, too: a part in 10⁹ covers them. Below the normal numbers the error of
        // an operation is absolute.
        let own = roundings * UNIT * value.abs() + f64::MIN_POSITIVE;
        Rounded::new(value, (from_operands + own) * (1.0 + 1e-9))
    }

    /// Whether two numbers may be the same in exact arithmetic.
    ///
    /// Where no bound is known, after an overflow or a division by what may be zero, the two may be the same. A number
    /// whose bound is known and NaN may not.
    pub fn may_equal(self, other: Self) -> bool {
        let bound = self.error + other.error;
        let same = self.value == other.value || (self.value - other.value).abs() <= bound;
        let known = |number: Self| number.value.is_finite() && number.error.is_finite();
        same || !(known(self) || known(other)) || (bound.is_infinite() && !self.value.is_nan() && !other.value.is_nan())
    }
}

impl Scalar for Rounded {
    fn from_f64(value: f64) -> Self {
        Rounded::result(value, 0.0, if value == 0.0 || value == 1.0 { 0.0 } else { OF_CONSTANT })
    }
    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = redysim_model::rotation::sin_cos(self.value);
        // No sine changes by more than its angle, and none by more than 2.
        let change = self.error.min(2.0);
        (Rounded::result(sin, change, OF_SINE), Rounded::result(cos, change, OF_SINE))
    }
    #[inline(never)]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let least = (self.value - self.error).max(0.0).sqrt();
        Rounded::result(root, self.error / (root + least), 1.0)
    }
}

impl Add for Rounded {
    type Output = Self;
    #[inline(never)]
    fn add(self, b: Self) -> Self {
        Rounded::result(self.value + b.value, self.error + b.error, 1.0)
    }
}

impl Mul for Rounded {
    type Output = Self;
    #[inline(never)]
    fn mul(self, b: Self) -> Self {
        let errors = self.value.abs() * b.error + self.error * b.value.abs() + self.error * b.error;
        // An infinite bound of one factor leaves the product unbounded, even where the other factor is zero.
        let unknown = self.error.is_infinite() || b.error.is_infinite();
        let errors = if errors.is_nan() && unknown { f64::INFINITY } else { errors };
        Rounded::result(self.value * b.value, errors, 1.0)
    }
}

impl Div for Rounded {
    type Output = Self;
    #[inline(never)]
    fn div(self, b: Self) -> Self {
        let quotient = self.value / b.value;
        let least = b.value.abs() - b.error;
        let errors = if least > 0.0 { (self.error + quotient.abs() * b.error) / least } else { f64::INFINITY };
        Rounded::result(quotient, errors, 1.0)
    }
}

impl Neg for Rounded {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        Rounded::new(-self.value, self.error)
    }
}
