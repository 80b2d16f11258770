//! Large matrices, written element by element where they are returned.

use crate::scalar::Scalar;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

/// Computes a matrix whose elements `write` gives in an [order of writing](WritingOrder).
///
/// The compiler composes a large array literal elsewhere and copies it, and a matrix that begins with zeros goes through
/// the cache twice. Here each element is written once, into the memory of the result, as soon as it is known.
///
/// Numbers are written [at once](Scalar::AT_ONCE), row by row:
///
/// ```
/// use redysim_runtime::{WritingOrder, write_matrix};
///
/// struct ZerosLast;
/// impl WritingOrder<5> for ZerosLast {
///     const RUNS: [[usize; 2]; 5] = [[0, 1], [3, 1], [1, 1], [2, 1], [4, 2]];
/// }
/// let matrix: [[f64; 3]; 2] = write_matrix(|matrix| {
///     let mut elements = matrix.elements::<ZerosLast, 5>();
///     elements.write(1.0);
///     elements.write(2.0);
///     elements.write(3.0);
///     elements.finish(|rows| [1.0, 3.0, 0.0, 2.0].into_iter().for_each(|element| rows.push(element)))
/// });
/// assert_eq!(matrix, [[1.0, 3.0, 0.0], [2.0, 0.0, 0.0]]);
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
    // `Elements::finish` made of this matrix. `Elements` exists only for an order whose runs have every element once, writes
    // all elements of every run that it goes past, and `finish` goes past the last one; or `finish` lends all elements to
    // `Rows`, which writes every one that it takes away, and whose rest `finish` writes.
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

/// An order in which the elements of a matrix are written: runs of elements that are the same number.
///
/// Each run is the place of its first element, counted through the rows, and the number of its elements. The runs have every
/// element of the matrix once, or the program does not compile.
#[doc(hidden)]
pub trait WritingOrder<const N: usize> {
    /// The runs, in the order in which they are written.
    const RUNS: [[usize; 2]; N];
}

/// Whether `runs` have every element of a matrix once.
const fn have_every_element_once<const ROWS: usize, const COLUMNS: usize>(runs: &[[usize; 2]]) -> bool {
    let mut found = [[false; COLUMNS]; ROWS];
    let (mut run, mut elements) = (0, 0);
    while run < runs.len() {
        let [first, length] = runs[run];
        let mut place = first;
        while place < first + length {
            if place >= ROWS * COLUMNS || found[place / COLUMNS][place % COLUMNS] {
                return false;
            }
            found[place / COLUMNS][place % COLUMNS] = true;
            (place, elements) = (place + 1, elements + 1);
        }
        run += 1;
    }
    elements == ROWS * COLUMNS
}

impl<'m, S: Scalar, const ROWS: usize, const COLUMNS: usize> Unwritten<'m, S, ROWS, COLUMNS> {
    /// Begins with the first run of the order `O`.
    #[inline(always)]
    pub fn elements<O: WritingOrder<N>, const N: usize>(self) -> Elements<'m, S, O, N> {
        const { assert!(have_every_element_once::<ROWS, COLUMNS>(&O::RUNS)) };
        Elements { elements: self.elements.as_flattened_mut(), written: 0, order: PhantomData, matrix: self.matrix }
    }
}

/// A matrix whose elements are written as they become known: runs of the order `O`.
#[doc(hidden)]
pub struct Elements<'m, S, O, const N: usize> {
    elements: &'m mut [MaybeUninit<S>],
    /// The number of runs that are written.
    written: usize,
    order: PhantomData<O>,
    matrix: Invariant<'m>,
}

impl<'m, S: Scalar, O: WritingOrder<N>, const N: usize> Elements<'m, S, O, N> {
    /// Writes `element` into all places of the next run. Has no effect if every run is already written, and for scalars that
    /// write all elements [at once](Scalar::AT_ONCE).
    ///
    /// The compiler knows the places, since the number of runs that are written is one that it knows.
    #[inline(always)]
    pub fn write(&mut self, element: S) {
        if !S::AT_ONCE {
            self.write_run(element);
        }
    }

    /// Writes zeros into the next run.
    #[inline(always)]
    pub fn zeros(&mut self) {
        self.write(S::opaque_zero());
    }

    /// Writes what is left: all elements as `by_rows` gives them for scalars that write all at once, then zeros.
    #[inline(always)]
    pub fn finish(mut self, by_rows: impl FnOnce(&mut Rows<'_, S>)) -> Written<'m> {
        if S::AT_ONCE {
            let mut rows = Rows { rest: self.elements };
            by_rows(&mut rows);
            rows.zeros(rows.rest.len());
        } else {
            for _ in self.written..N {
                self.write_run(S::opaque_zero());
            }
        }
        Written { _matrix: self.matrix }
    }

    #[inline(always)]
    fn write_run(&mut self, element: S) {
        let Some(&[first, length]) = O::RUNS.get(self.written) else { return };
        self.written += 1;
        let Some(places) = self.elements.get_mut(first..first + length) else { return };
        for place in places {
            place.write(element);
        }
    }
}

/// A matrix of which the first elements are written, row by row.
#[doc(hidden)]
pub struct Rows<'m, S> {
    rest: &'m mut [MaybeUninit<S>],
}

impl<S: Scalar> Rows<'_, S> {
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

    /// Row by row, each element by itself.
    struct RowByRow;

    impl<const N: usize> WritingOrder<N> for RowByRow {
        const RUNS: [[usize; 2]; N] = {
            let (mut runs, mut place) = ([[0, 1]; N], 0);
            while place < N {
                runs[place][0] = place;
                place += 1;
            }
            runs
        };
    }

    /// In a matrix of three rows of five: the last element, eleven zeros in three runs, and three elements.
    struct WithRuns;

    impl WritingOrder<7> for WithRuns {
        const RUNS: [[usize; 2]; 7] = [[14, 1], [3, 6], [0, 1], [11, 3], [2, 1], [9, 2], [1, 1]];
    }

    /// A matrix of six elements that are given row by row, of which all but the first `known` are not.
    fn by_rows<S: Scalar>(known: usize, number: impl Fn(usize) -> S) -> [[S; 3]; 2] {
        write_matrix(|matrix| {
            let mut elements = matrix.elements::<RowByRow, 6>();
            (0..known).for_each(|place| elements.write(number(place)));
            elements.finish(|rows| (0..known).for_each(|place| rows.push(number(place))))
        })
    }

    #[test]
    fn numbers_are_written_row_by_row_and_what_is_left_is_zero() {
        let number = |place| place as f64 + 1.0;
        assert_eq!(by_rows(0, number), [[0.0; 3]; 2]);
        assert_eq!(by_rows(4, number), [[1.0, 2.0, 3.0], [4.0, 0.0, 0.0]]);
        assert_eq!(by_rows(7, number), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let none: [[f64; 0]; 3] = write_matrix(|matrix| matrix.elements::<RowByRow, 0>().finish(|_| {}));
        assert_eq!(none, [[]; 3]);
    }

    #[test]
    fn runs_that_leave_out_repeat_or_exceed_elements_are_no_order() {
        assert!(have_every_element_once::<2, 3>(&[[5, 1], [0, 2], [2, 3]]));
        assert!(have_every_element_once::<3, 0>(&[]));
        for wrong in [&[[0, 2], [3, 3]][..], &[[0, 3], [2, 4]], &[[0, 7]], &[[6, 1], [0, 5]], &[[0, 6], [0, 1]]] {
            assert!(!have_every_element_once::<2, 3>(wrong), "{wrong:?}");
        }
    }

    #[cfg(feature = "lanes")]
    mod lanes {
        use super::*;
        use crate::lanes::{F32x4, F32x8, F32x16, F64x2, F64x4, F64x8};

        /// A matrix of which the first `known` runs are written, the second with zeros.
        fn with_runs<S: Scalar>(known: usize) -> [[S; 5]; 3] {
            write_matrix(|matrix| {
                let mut elements = matrix.elements::<WithRuns, 7>();
                (1..=known).for_each(|run| match run {
                    2 => elements.zeros(),
                    _ => elements.write(S::from_f64(run as f64)),
                });
                elements.finish(|_| panic!("lanes are written once they are known"))
            })
        }

        fn check<S: Scalar + PartialEq>() {
            let numbers = |rows: [[u8; 5]; 3]| rows.map(|row| row.map(|number| S::from_f64(f64::from(number))));
            assert_eq!(with_runs::<S>(0), numbers([[0; 5]; 3]));
            assert_eq!(with_runs::<S>(4), numbers([[3, 0, 0, 0, 0], [0; 5], [0, 4, 4, 4, 1]]));
            let all = numbers([[3, 7, 5, 0, 0], [0, 0, 0, 0, 6], [6, 4, 4, 4, 1]]);
            assert_eq!(with_runs::<S>(7), all);
            assert_eq!(with_runs::<S>(9), all);
        }

        #[test]
        fn each_element_is_written_at_its_place_in_the_order_and_what_is_left_is_zero() {
            check::<F64x2>();
            check::<F64x4>();
            check::<F64x8>();
            check::<F32x4>();
            check::<F32x8>();
            check::<F32x16>();
            let number = |place: usize| F64x2::from_f64(place as f64);
            assert_eq!(by_rows(7, number), [[0, 1, 2], [3, 4, 5]].map(|row| row.map(number)));
        }
    }
}
