//! Linear equations by the LU decomposition with partial pivoting, over real and complex numbers.

use core::marker::PhantomData;
use core::ops::{Div, Mul, Sub};

use crate::{Real, Scalar, Vector};

/// A number one can solve linear equations with.
pub trait Field: Copy + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// The type of magnitudes.
    type Magnitude: Real;

    /// What pivots are chosen by: the absolute value, or a norm within a factor of two of it.
    fn magnitude(self) -> Self::Magnitude;
}

impl<S: Real> Field for S {
    type Magnitude = S;

    fn magnitude(self) -> S {
        self.abs()
    }
}

/// P A = L U, for a matrix whose rows are of type `Y`.
#[derive(Clone, Debug)]
pub struct Lu<T, Y: Vector<T>> {
    /// U, and below its diagonal L without its unit diagonal.
    rows: Y::Of<Y>,
    /// The row that each row was swapped with.
    pivots: Y::Of<usize>,
    element: PhantomData<T>,
}

impl<T: Field, Y: Vector<T>> Lu<T, Y> {
    /// Decomposes the matrix with the given rows; `None` if it is singular or not finite.
    pub fn new(mut rows: Y::Of<Y>) -> Option<Self> {
        let mut pivots = Y::Of::<usize>::from_fn(rows.as_ref().len(), |_| 0);
        for (k, chosen) in pivots.as_mut().iter_mut().enumerate() {
            let below = rows.as_mut().get_mut(k..)?;
            let magnitude = |row: &Y| row.as_ref().get(k).map(|element| element.magnitude());
            let (pivot, largest) = below.iter().map(magnitude).enumerate().try_fold(
                (0, T::Magnitude::zero()),
                |(at, largest), (i, magnitude)| {
                    let magnitude = magnitude?;
                    // Not a number compares as not finite, and ends the search.
                    magnitude.is_finite().then_some(if magnitude > largest { (i, magnitude) } else { (at, largest) })
                },
            )?;
            if largest == T::Magnitude::zero() {
                return None;
            }
            *chosen = k + pivot;
            if let Some((first, others)) = below.split_first_mut()
                && let Some(chosen) = others.get_mut(pivot.wrapping_sub(1))
            {
                core::mem::swap(first, chosen);
            }
            let (row, rest) = below.split_first_mut()?;
            let (&diagonal, right) = row.as_ref().get(k..)?.split_first()?;
            for other in rest {
                let (first, others) = other.as_mut().get_mut(k..)?.split_first_mut()?;
                let factor = *first / diagonal;
                *first = factor;
                for (other, &element) in others.iter_mut().zip(right) {
                    *other = *other - factor * element;
                }
            }
        }
        Some(Self { rows, pivots, element: PhantomData })
    }

    /// Replaces b by the solution x of A x = b.
    pub fn solve(&self, b: &mut Y) {
        let b = b.as_mut();
        for (k, &pivot) in self.pivots.as_ref().iter().enumerate() {
            if pivot != k && pivot < b.len() && k < b.len() {
                b.swap(k, pivot);
            }
        }
        for (k, row) in self.rows.as_ref().iter().enumerate() {
            let (known, rest) = b.split_at_mut(k.min(b.len()));
            if let Some(first) = rest.first_mut() {
                *first = row.as_ref().iter().zip(&*known).fold(*first, |sum, (&l, &x)| sum - l * x);
            }
        }
        for (k, row) in self.rows.as_ref().iter().enumerate().rev() {
            let elements = row.as_ref().get(k..).and_then(<[T]>::split_first);
            let unknowns = b.get_mut(k..).and_then(<[T]>::split_first_mut);
            if let (Some((&diagonal, right)), Some((unknown, known))) = (elements, unknowns) {
                *unknown = right.iter().zip(&*known).fold(*unknown, |sum, (&u, &x)| sum - u * x) / diagonal;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two columns that only pivoting can tell from a singular matrix, solved for a known x.
    #[test]
    fn a_matrix_with_zeros_on_its_diagonal_is_solved() {
        let rows = [[0.0, 2.0, 1.0], [1.0, 0.0, -3.0], [4.0, 1.0, 0.0]];
        let x = [3.0, -2.0, 0.5];
        let mut b = rows.map(|row| (0..3).map(|i| row[i] * x[i]).sum());
        Lu::<f64, [f64; 3]>::new(rows).unwrap().solve(&mut b);
        for (b, x) in b.iter().zip(x) {
            assert!((b - x).abs() < 1e-15, "{b} instead of {x}");
        }
    }

    #[test]
    fn singular_and_non_finite_matrices_are_refused() {
        for rows in [[[1.0, 2.0], [2.0, 4.0]], [[0.0, 1.0], [0.0, 3.0]], [[f64::NAN, 1.0], [1.0, 1.0]]] {
            assert!(Lu::<f64, [f64; 2]>::new(rows).is_none(), "{rows:?}");
        }
    }
}
