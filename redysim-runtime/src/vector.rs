//! Vectors whose length comes from their type, or, on the generic path, from the model.

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

/// Element `index`; NaN if the vector is too short, which only a `Vec` can be. NaN does not go unnoticed: integrators
/// report it, where a panic would take a controller down and a zero would hide the fault.
pub(crate) fn entry<T: crate::Scalar, V: Vector<T>>(vector: &V, index: usize) -> T {
    vector.as_ref().get(index).copied().unwrap_or_else(|| T::from_f64(f64::NAN))
}
