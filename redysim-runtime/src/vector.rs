//! Vectors whose length comes from their type, or, on the generic path, from the model.

use core::fmt;

/// A list of values of fixed length: `[T; N]`, or `Vec<T>` with the feature `alloc`.
pub trait Vector<T>: Clone + AsRef<[T]> + AsMut<[T]> {
    /// A vector of as many elements of another kind: `[U; N]`. `Of<Self>` holds the rows of a square matrix.
    type Of<U: Clone>: Vector<U>;

    /// The vector with `element(i)` at index `i`. An array has its own length and does not look at `len`.
    fn from_fn(len: usize, element: impl FnMut(usize) -> T) -> Self;
}

impl<T: Clone, const N: usize> Vector<T> for [T; N] {
    type Of<U: Clone> = [U; N];

    #[inline]
    fn from_fn(len: usize, element: impl FnMut(usize) -> T) -> Self {
        debug_assert_eq!(len, N, "a vector of {len} elements was asked of an array of {N}");
        core::array::from_fn(element)
    }
}

#[cfg(feature = "alloc")]
impl<T: Clone> Vector<T> for alloc::vec::Vec<T> {
    type Of<U: Clone> = alloc::vec::Vec<U>;

    fn from_fn(len: usize, element: impl FnMut(usize) -> T) -> Self {
        (0..len).map(element).collect()
    }
}

/// A vector or a slice has another length than its use needs.
///
/// The length of an array is part of its type, so that this is an error of slices and of `Vec`, and it is found where
/// they enter: when an integration or a batch begins, not while it runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthMismatch {
    /// The name of the vector, as the function or the type calls it.
    pub vector: &'static str,
    /// Its length.
    pub length: usize,
    /// The length that is needed.
    pub expected: usize,
}

impl LengthMismatch {
    /// Checks that a vector has the length `expected`.
    ///
    /// # Errors
    /// If it does not.
    #[inline]
    pub fn check<T>(vector: &'static str, elements: &[T], expected: usize) -> Result<(), Self> {
        let length = elements.len();
        if length == expected { Ok(()) } else { Err(Self { vector, length, expected }) }
    }
}

impl fmt::Display for LengthMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vector, length, expected } = self;
        let elements = if *expected == 1 { "element" } else { "elements" };
        write!(f, "`{vector}` must have {expected} {elements}, but it has {length}")
    }
}

impl core::error::Error for LengthMismatch {}

/// Element `index`, or NaN past the end. Only a `Vec` whose length has not been checked can be too short. Integrators
/// report NaN, where a panic would stop a controller and a zero would hide the error.
pub(crate) fn entry<T: crate::Scalar, V: Vector<T>>(vector: &V, index: usize) -> T {
    vector.as_ref().get(index).copied().unwrap_or_else(|| T::from_f64(f64::NAN))
}
