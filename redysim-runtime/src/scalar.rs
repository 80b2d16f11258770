//! The numbers that dynamics is computed with.

use crate::trigonometry;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number in the sense of the recursions: a field with sine, cosine and square root.
///
/// There is no order and no conversion to `f64`, so that a scalar may also be a bundle of SIMD lanes, a dual number,
/// or a symbol that records the expression it stands for. What needs comparisons asks for [`Real`].
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
{
    /// The scalar nearest to a constant of the model.
    fn from_f64(value: f64) -> Self;

    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);

    /// Sines and cosines of several angles, at once where that is faster.
    #[inline]
    fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let pairs = angles.map(Self::sin_cos);
        (pairs.map(|(sin, _)| sin), pairs.map(|(_, cos)| cos))
    }

    /// The non-negative square root.
    fn sqrt(self) -> Self;

    /// Zero.
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// One.
    fn one() -> Self {
        Self::from_f64(1.0)
    }

    /// Says what this value is: component `component` of `quantity` of body `body`. A symbolic scalar keeps the name
    /// for the code it will emit; a number returns itself.
    #[inline(always)]
    fn named(self, quantity: &'static str, body: usize, component: &'static str) -> Self {
        let _ = (quantity, body, component);
        self
    }
}

/// A scalar that stands for one real number: ordered, and convertible to `f64`.
///
/// Integrators and trajectories ask for this, since they compare times and errors.
pub trait Real: Scalar + PartialOrd + Default + 'static {
    /// The distance from 1 to the next larger number.
    const EPSILON: Self;

    /// The value as `f64`.
    fn to_f64(self) -> f64;

    /// The absolute value.
    fn abs(self) -> Self;

    /// `self` to the power `exponent`.
    fn powf(self, exponent: Self) -> Self;

    /// Whether the value is neither infinite nor NaN.
    fn is_finite(self) -> bool;

    /// The larger of two numbers; NaN if either is NaN, so that a bad value is never hidden.
    fn maximum(self, other: Self) -> Self {
        if self > other || self.to_f64().is_nan() { self } else { other }
    }

    /// The smaller of two numbers; NaN if either is NaN.
    fn minimum(self, other: Self) -> Self {
        if self < other || self.to_f64().is_nan() { self } else { other }
    }
}

macro_rules! real {
    ($float:ident, $sqrt:path, $fabs:path, $pow:path) => {
        impl Scalar for $float {
            #[inline(always)]
            fn from_f64(value: f64) -> Self {
                value as $float
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                let (sin, cos) = trigonometry::sin_cos(self.into());
                (sin as $float, cos as $float)
            }
            #[inline(always)]
            fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
                let (sines, cosines) = trigonometry::sin_cos_all(angles.map(f64::from));
                (sines.map(|sin| sin as $float), cosines.map(|cos| cos as $float))
            }
            #[inline]
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
        }

        impl Real for $float {
            const EPSILON: Self = $float::EPSILON;
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
            #[inline]
            fn abs(self) -> Self {
                $fabs(self)
            }
            fn powf(self, exponent: Self) -> Self {
                $pow(self, exponent)
            }
            #[inline]
            fn is_finite(self) -> bool {
                $float::is_finite(self)
            }
        }
    };
}

real!(f64, libm::sqrt, libm::fabs, libm::pow);
real!(f32, libm::sqrtf, libm::fabsf, libm::powf);
