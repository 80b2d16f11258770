//! The numbers that dynamics is computed with.

use crate::branches::Branches;
use core::fmt::Debug;
use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// Whether [`Scalar::mul_add`] of the numbers of this crate rounds once.
///
/// That is so where the target that is compiled for has the instruction (on x86-64 by `-C target-cpu` or
/// `-C target-feature=+fma`, on AArch64 always), unless the feature `deterministic` asks for the same bits everywhere or
/// the feature `lanes` is off.
pub const FUSED: bool = cfg!(all(
    feature = "lanes",
    not(feature = "deterministic"),
    any(target_feature = "fma", all(target_arch = "aarch64", target_feature = "neon"))
));

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
    #[inline(always)]
    fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        // Starts from zeros, not from copies of `angles`: loading these as wider vectors than they were stored as stalls
        // the processor (store forwarding fails).
        let (mut sines, mut cosines) = ([Self::from_f64(0.0); N], [Self::from_f64(0.0); N]);
        for ((sin, cos), angle) in sines.iter_mut().zip(&mut cosines).zip(&angles) {
            (*sin, *cos) = angle.sin_cos();
        }
        (sines, cosines)
    }

    /// The same angles, large ones without whole turns, for sums of angles: these would else be rounded to the digits
    /// of their size, and so would their sines.
    #[inline(always)]
    fn without_turns<const N: usize>(angles: [Self; N]) -> [Self; N] {
        angles
    }

    /// The non-negative square root.
    fn sqrt(self) -> Self;

    /// self · factor + addend, rounded once where [`FUSED`] and twice elsewhere: what is faster, never a library call.
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        self * factor + addend
    }

    /// Runs `computation` in code that is compiled for the target features that this number's operations need; plain
    /// numbers need none but those that the program is compiled for. What `computation` calls must be
    /// `#[inline(always)]` to be part of that code.
    #[inline(always)]
    fn with_target_features<R>(computation: impl FnOnce() -> R) -> R {
        computation()
    }

    /// The same numbers, of which the compiler no longer knows how they belong together, so that it makes no wider
    /// vectors of them.
    #[doc(hidden)]
    #[inline(always)]
    fn apart<const N: usize>(numbers: [Self; N]) -> [Self; N] {
        numbers
    }

    /// Zero. Lanes hide its value from the compiler, which would call `memset` for several zeros in a row: all lanes would have
    /// to be saved around the call.
    #[doc(hidden)]
    #[inline(always)]
    fn opaque_zero() -> Self {
        Self::zero()
    }

    /// Whether a function that writes a large matrix computes all sines first and writes all elements last, row by row, as numbers
    /// do. Other scalars compute the sines of a branch before the branch, and write an element as soon as it is known.
    #[doc(hidden)]
    const AT_ONCE: bool = false;

    /// Computes one of the [`Branches`] `B`, and calls `write` with the branch, the index and the value of every result. Numbers
    /// compute all branches with the first one, in the lanes of a vector.
    #[doc(hidden)]
    #[inline(always)]
    fn compute_branch<B: Branches<Self, M, N, K>, const M: usize, const N: usize, const K: usize>(
        branch: usize,
        read: &[Self; M],
        mut write: impl FnMut(usize, usize, Self),
    ) {
        B::compute(
            read,
            #[inline(always)]
            |x| x[branch],
            #[inline(always)]
            |column, value| write(branch, column, value),
        );
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }

    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
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
