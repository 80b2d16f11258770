//! Large matrices, written element by element where they are returned.

use crate::scalar::Scalar;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

/// Computes a matrix whose elements `write` gives in the order of its rows.
///
/// The compiler composes a large array literal elsewhere and copies it, and a matrix that begins with zeros goes through
/// the cache twice. Here each element is written once, into the memory of the result.
///
/// ```
/// let matrix: [[f64; 3]; 2] = redysim_runtime::write_matrix(|matrix| {
///     let mut elements = matrix.elements();
///     elements.push(1.0);
///     elements.zeros(2);
///     elements.push(4.0);
///     elements.finish()
/// });
/// assert_eq!(matrix, [[1.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
/// ```
#[doc(hidden)]
#[inline(always)]
#[allow(unsafe_code)]
pub fn write_matrix<S: Scalar, const ROWS: usize, const COLUMNS: usize>(
    write: impl for<'m> FnOnce(Unwritten<'m, S, ROWS, COLUMNS>) -> Written<'m>,
) -> [[S; COLUMNS]; ROWS] {
    let mut matrix = [[const { MaybeUninit::<S>::uninit() }; COLUMNS]; ROWS];
    fill(&mut matrix, write);
    // SAFETY: `MaybeUninit<S>` has the layout of `S`, hence the two types of matrices have the same layout. All elements are
    // initialised: `write` returned a `Written<'m>` for every lifetime `'m`, which is invariant, so that it is the one that
    // `Elements::finish` made of this matrix. `Elements` begins with all elements, writes every one that it takes away,
    // and `finish` takes those that are left.
    unsafe { (&raw const matrix).cast::<[[S; COLUMNS]; ROWS]>().read() }
}

/// A call that is not inlined writes into the memory of the caller's result, since the compiler elides the copy of what a
/// call has written. Inlined, the elements would be local variables until the last of them is known.
#[inline(never)]
fn fill<S, const ROWS: usize, const COLUMNS: usize>(
    matrix: &mut [[MaybeUninit<S>; COLUMNS]; ROWS],
    write: impl for<'m> FnOnce(Unwritten<'m, S, ROWS, COLUMNS>) -> Written<'m>,
) {
    write(Unwritten { elements: matrix, matrix: PhantomData });
}

/// Makes a lifetime invariant, so that it stands for one matrix.
type Invariant<'m> = PhantomData<fn(&'m ()) -> &'m ()>;

/// A matrix without elements yet. Its type has the number of elements, so that the compiler knows it wherever the matrix is
/// written.
#[doc(hidden)]
pub struct Unwritten<'m, S, const ROWS: usize, const COLUMNS: usize> {
    elements: &'m mut [[MaybeUninit<S>; COLUMNS]; ROWS],
    matrix: Invariant<'m>,
}

impl<'m, S: Scalar, const ROWS: usize, const COLUMNS: usize> Unwritten<'m, S, ROWS, COLUMNS> {
    /// Begins with the first element of the first row.
    #[inline(always)]
    pub fn elements(self) -> Elements<'m, S> {
        Elements { rest: self.elements.as_flattened_mut(), matrix: self.matrix }
    }
}

/// A matrix of which the first elements are written.
#[doc(hidden)]
pub struct Elements<'m, S> {
    rest: &'m mut [MaybeUninit<S>],
    matrix: Invariant<'m>,
}

impl<'m, S: Scalar> Elements<'m, S> {
    /// Writes the next element. Has no effect if every element is already written.
    #[inline(always)]
    pub fn push(&mut self, element: S) {
        self.write_all(1, element);
    }

    /// Writes zeros into the next `count` elements.
    #[inline(always)]
    pub fn zeros(&mut self, count: usize) {
        self.write_all(count, S::opaque_zero());
    }

    /// Writes zeros into the elements that are left.
    #[inline(always)]
    pub fn finish(mut self) -> Written<'m> {
        self.zeros(self.rest.len());
        Written { _matrix: self.matrix }
    }

    /// Writes `element` into the next `count` elements. The loop does not change what is left, so that the compiler knows
    /// the place of every element.
    #[inline(always)]
    fn write_all(&mut self, count: usize, element: S) {
        let rest = core::mem::take(&mut self.rest);
        let (next, rest) = rest.split_at_mut(count.min(rest.len()));
        self.rest = rest;
        for place in next {
            place.write(element);
        }
    }
}

/// The proof that all elements of a matrix are written.
#[doc(hidden)]
pub struct Written<'m> {
    _matrix: Invariant<'m>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_written_in_the_order_of_the_rows() {
        let matrix: [[f64; 3]; 2] = write_matrix(|matrix| {
            let mut elements = matrix.elements();
            (1..=6).for_each(|number| elements.push(f64::from(number)));
            elements.finish()
        });
        assert_eq!(matrix, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    }

    #[test]
    #[cfg(feature = "lanes")]
    fn zeros_of_lanes_are_zero_in_every_lane() {
        use crate::lanes::{F32x4, F32x8, F32x16, F64x2, F64x4, F64x8};
        fn check<S: Scalar + PartialEq + core::fmt::Debug>() {
            let one = S::one();
            let matrix: [[S; 5]; 3] = write_matrix(|matrix| {
                let mut elements = matrix.elements();
                elements.zeros(4);
                elements.push(one);
                elements.zeros(6);
                elements.push(one);
                elements.finish()
            });
            let mut expected = [[S::from_f64(0.0); 5]; 3];
            (expected[0][4], expected[2][1]) = (one, one);
            assert_eq!(matrix, expected);
        }
        check::<F64x2>();
        check::<F64x4>();
        check::<F64x8>();
        check::<F32x4>();
        check::<F32x8>();
        check::<F32x16>();
    }

    #[test]
    fn elements_that_are_left_are_zero_and_there_are_no_others() {
        let written = |count: usize| -> [[f64; 2]; 2] {
            write_matrix(|matrix| {
                let mut elements = matrix.elements();
                (0..count).for_each(|_| elements.push(1.0));
                elements.finish()
            })
        };
        assert_eq!(written(0), [[0.0; 2]; 2]);
        assert_eq!(written(3), [[1.0, 1.0], [1.0, 0.0]]);
        assert_eq!(written(5), [[1.0; 2]; 2]);
        let none: [[f64; 0]; 3] = write_matrix(|matrix| matrix.elements().finish());
        assert_eq!(none, [[]; 3]);
    }
}
