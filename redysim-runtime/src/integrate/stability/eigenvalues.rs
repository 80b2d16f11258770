//! All eigenvalues of a small matrix: reduction to Hessenberg form by eliminations, then the QR algorithm with single
//! complex shifts. G. H. Golub and C. F. Van Loan, *Matrix Computations*, 4th ed., Johns Hopkins (2013), sections 7.4
//! and 7.5.

use crate::integrate::complex::Complex;
use crate::{Real, Vector};

/// A row of complex elements.
pub type Row<S, Y> = <Y as Vector<S>>::Of<Complex<S>>;
/// A square matrix of complex elements, by rows.
pub type Matrix<S, Y> = <Y as Vector<S>>::Of<Row<S, Y>>;

/// Iterations for one eigenvalue; three are usual.
const PATIENCE: u32 = 60;

/// The matrix with `element(i, j)` in row i and column j.
pub fn matrix<S: Real, Y: Vector<S>>(len: usize, mut element: impl FnMut(usize, usize) -> S) -> Matrix<S, Y> {
    Matrix::<S, Y>::from_fn(len, |i| Row::<S, Y>::from_fn(len, |j| Complex::real(element(i, j))))
}

/// The eigenvalues; `None` if an element is not finite, or if the iteration does not converge. Costs about 25 n³
/// operations.
pub fn eigenvalues<S: Real, Y: Vector<S>>(mut matrix: Matrix<S, Y>) -> Option<Row<S, Y>> {
    let mut rows = RowsMut(matrix.as_mut(), core::marker::PhantomData);
    let len = rows.0.len();
    let norm = rows.norm()?;
    rows.reduce();
    let mut values = Row::<S, Y>::from_fn(len, |_| Complex::default());
    let (mut end, mut iterations) = (len, 0);
    while end > 0 {
        let last = end - 1;
        let mut first = last;
        while first > 0 && !rows.is_cut(first, norm) {
            first -= 1;
        }
        if first == last {
            if let Some(value) = values.as_mut().get_mut(last) {
                *value = rows.at(last, last);
            }
            (end, iterations) = (last, 0);
            continue;
        }
        iterations += 1;
        if iterations > PATIENCE {
            return None;
        }
        // A shift out of turn, where the usual one runs in a circle.
        let shift = if iterations % 12 == 0 { rows.at(last, last - 1) } else { rows.shift(last) };
        rows.sweep(first, last, shift);
    }
    Some(values)
}

struct RowsMut<'a, S, R>(&'a mut [R], core::marker::PhantomData<S>);

impl<S: Real, R: AsRef<[Complex<S>]> + AsMut<[Complex<S>]>> RowsMut<'_, S, R> {
    fn at(&self, i: usize, j: usize) -> Complex<S> {
        self.0.get(i).and_then(|row| row.as_ref().get(j)).copied().unwrap_or_default()
    }

    fn set(&mut self, i: usize, j: usize, value: Complex<S>) {
        if let Some(element) = self.0.get_mut(i).and_then(|row| row.as_mut().get_mut(j)) {
            *element = value;
        }
    }

    /// The largest element; `None` if one is not finite.
    fn norm(&self) -> Option<S> {
        let norm = self.0.iter().flat_map(|row| row.as_ref()).fold(S::zero(), |norm, z| norm.maximum(z.abs()));
        norm.is_finite().then_some(norm)
    }

    /// Makes all elements below the subdiagonal zero, by a similarity.
    fn reduce(&mut self) {
        let len = self.0.len();
        for column in 0..len.saturating_sub(2) {
            let below = column + 1;
            let mut pivot = below;
            for i in below + 1..len {
                if self.at(i, column).abs() > self.at(pivot, column).abs() {
                    pivot = i;
                }
            }
            if self.at(pivot, column).abs() == S::zero() {
                continue;
            }
            if pivot != below {
                for j in 0..len {
                    let (a, b) = (self.at(pivot, j), self.at(below, j));
                    self.set(pivot, j, b);
                    self.set(below, j, a);
                }
                for i in 0..len {
                    let (a, b) = (self.at(i, pivot), self.at(i, below));
                    self.set(i, pivot, b);
                    self.set(i, below, a);
                }
            }
            for i in below + 1..len {
                let factor = self.at(i, column) / self.at(below, column);
                for j in column..len {
                    self.set(i, j, self.at(i, j) - factor * self.at(below, j));
                }
                for k in 0..len {
                    self.set(k, below, self.at(k, below) + factor * self.at(k, i));
                }
            }
        }
    }

    /// Whether the element left of (i, i) is as good as zero.
    fn is_cut(&self, i: usize, norm: S) -> bool {
        let neighbours = self.at(i, i).abs() + self.at(i - 1, i - 1).abs();
        self.at(i, i - 1).abs() <= S::EPSILON * neighbours.maximum(S::EPSILON * norm)
    }

    /// The eigenvalue of the last two rows and columns that is nearer to the last element (Wilkinson's shift).
    fn shift(&self, last: usize) -> Complex<S> {
        let (a, b) = (self.at(last - 1, last - 1), self.at(last - 1, last));
        let (c, d) = (self.at(last, last - 1), self.at(last, last));
        let half = (a - d).scale(S::from_f64(0.5));
        let root = (half * half + b * c).sqrt();
        let (plus, minus) = (half + root, half - root);
        let far = if plus.abs() > minus.abs() { plus } else { minus };
        if far.abs() == S::zero() { d } else { d - b * c / far }
    }

    /// One step of the QR algorithm on the rows `first` to `last`: a rotation that the shift asks for, and those that
    /// restore the Hessenberg form.
    fn sweep(&mut self, first: usize, last: usize, shift: Complex<S>) {
        for k in first..last {
            let (x, y) = if k == first {
                (self.at(k, k) - shift, self.at(k + 1, k))
            } else {
                (self.at(k, k - 1), self.at(k + 1, k - 1))
            };
            let size = (x.abs() * x.abs() + y.abs() * y.abs()).sqrt();
            if size == S::zero() {
                continue;
            }
            let (c, s) = (x.scale(S::one() / size), y.scale(S::one() / size));
            for j in k.saturating_sub(1).max(first)..=last {
                let (upper, lower) = (self.at(k, j), self.at(k + 1, j));
                self.set(k, j, c.conj() * upper + s.conj() * lower);
                self.set(k + 1, j, c * lower - s * upper);
            }
            for i in first..=last.min(k + 2) {
                let (left, right) = (self.at(i, k), self.at(i, k + 1));
                self.set(i, k, left * c + right * s);
                self.set(i, k + 1, right * c.conj() - left * s.conj());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted<const N: usize>(rows: [[f64; N]; N]) -> Vec<(f64, f64)> {
        let found = eigenvalues::<f64, [f64; N]>(matrix::<f64, [f64; N]>(N, |i, j| rows[i][j])).unwrap();
        let mut found: Vec<_> = found.iter().map(|z| (z.re, z.im)).collect();
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        found
    }

    extern crate std;
    use std::vec::Vec;

    fn assert_near(found: &[(f64, f64)], expected: &[(f64, f64)], roundoff: f64) {
        for (f, e) in found.iter().zip(expected) {
            assert!((f.0 - e.0).abs() < roundoff && (f.1 - e.1).abs() < roundoff, "{found:?} instead of {expected:?}");
        }
    }

    /// The companion matrix of (x + 1)(x − 2)(x + 300)(x² + 2x + 401).
    #[test]
    fn real_and_complex_eigenvalues_of_a_companion_matrix_are_found() {
        let multiply = |p: &[f64], q: &[f64]| {
            let mut product = std::vec![0.0; p.len() + q.len() - 1];
            for (i, a) in p.iter().enumerate() {
                for (j, b) in q.iter().enumerate() {
                    product[i + j] += a * b;
                }
            }
            product
        };
        let factors: [&[f64]; 4] = [&[1.0, 1.0], &[-2.0, 1.0], &[300.0, 1.0], &[401.0, 2.0, 1.0]];
        let p = factors.into_iter().fold(std::vec![1.0], |p, q| multiply(&p, q));
        let rows: [[f64; 5]; 5] =
            core::array::from_fn(|i| core::array::from_fn(|j| if i == 0 { -p[4 - j] } else { f64::from(i == j + 1) }));
        let expected = [(-300.0, 0.0), (-1.0, -20.0), (-1.0, 0.0), (-1.0, 20.0), (2.0, 0.0)];
        let mut found = sorted(rows);
        // The three of one real part are sorted by their imaginary parts only.
        found[1..4].sort_by(|a, b| a.1.partial_cmp(&b.1).unwrap());
        assert_near(&found, &expected, 1e-9);
    }

    #[test]
    fn rotations_permutations_and_zero_have_theirs() {
        assert_near(&sorted([[0.0, 1.0], [-1.0, 0.0]]), &[(0.0, -1.0), (0.0, 1.0)], 1e-15);
        assert_near(&sorted([[0.0; 3]; 3]), &[(0.0, 0.0); 3], 1e-300);
        let circle = sorted([[0.0, 0.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]);
        assert!(circle.iter().all(|&(re, im)| (re.hypot(im) - 1.0).abs() < 1e-14), "{circle:?}");
        assert!((circle[0].0 + 1.0).abs() < 1e-14 && (circle[3].0 - 1.0).abs() < 1e-14, "{circle:?}");
    }

    #[test]
    fn what_is_not_finite_has_none() {
        assert!(eigenvalues::<f64, [f64; 1]>([[Complex { re: f64::NAN, im: 0.0 }]]).is_none());
    }
}
