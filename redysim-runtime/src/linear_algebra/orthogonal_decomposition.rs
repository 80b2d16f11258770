//! The rows of a matrix W of any rank r: W = T R Q, a complete orthogonal decomposition.
//!
//! Q has r orthonormal rows that span the rows of W, T r orthonormal columns that span its columns, R is upper
//! triangular. So both W⁺ = Qᵀ R⁻¹ Tᵀ and its transpose are at hand, which give least-norm answers whether the rows are
//! independent, redundant or just now singular. Q comes from modified Gram-Schmidt with row pivoting by the remaining
//! lengths, T and R from Gram-Schmidt on the columns of W Qᵀ; every vector is orthogonalised again ("twice is enough":
//! B. N. Parlett, *The Symmetric Eigenvalue Problem*, 1980, § 6.9).

use core::marker::PhantomData;

use super::{RowSet, add_scaled, dot, largest, norm, zeros};
use crate::{Real, Vector};

/// Below this remainder a position is called nearly singular.
const NEARLY_SINGULAR: f64 = 0.03;

/// An element of W is infinite or not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotFinite;

/// W = T R Q, with rows `V` in `W`, and columns `R` in the square matrix `G`.
#[derive(Clone)]
pub struct OrthogonalDecomposition<S, V, R, W, G> {
    /// The rows of Q.
    basis: W,
    /// The columns of T.
    columns: G,
    /// The rows of R.
    triangle: G,
    rank: usize,
    /// The length of a row.
    count: usize,
    nearly_singular: bool,
    dependent: RowSet,
    scalar: PhantomData<(S, V, R)>,
}

impl<S, V, R, W, G> OrthogonalDecomposition<S, V, R, W, G>
where
    S: Real,
    V: Vector<S>,
    R: Vector<S>,
    W: Vector<V>,
    G: Vector<R>,
{
    /// Decomposes the matrix with the given rows, each of length `count`. A row counts as dependent when what remains
    /// of it is at most `tolerance` times the longest row.
    pub fn new(mut rows: W, count: usize, tolerance: S) -> Result<Self, NotFinite> {
        let nc = rows.as_ref().len();
        let mut basis = rows.clone();
        let mut columns = G::from_fn(nc, |_| zeros(nc));
        let mut used: R = zeros(nc);
        let mut rank = 0;
        let (mut longest, mut nearly_singular) = (S::zero(), false);
        for step in 0..nc {
            // A row in use has become zero.
            let (size, pivot) = largest(rows.as_ref().iter().map(|row| norm(row.as_ref())));
            if !size.is_finite() {
                return Err(NotFinite);
            }
            longest = longest.maximum(size);
            // Rows that are redundant at every position leave nothing but rounding.
            let rounding = S::from_f64(1e3) * S::EPSILON * longest;
            nearly_singular |= rounding < size && size < S::from_f64(NEARLY_SINGULAR) * longest;
            if size <= tolerance * longest {
                break;
            }
            let Some(row) = rows.as_mut().get_mut(pivot) else { break };
            let Some((before, [next, ..])) = basis.as_mut().split_at_mut_checked(step) else { break };
            let Some((columns_before, [column, ..])) = columns.as_mut().split_at_mut_checked(step) else { break };
            for (base, column) in before.iter().zip(columns_before) {
                let along = dot(row.as_ref(), base.as_ref());
                add_scaled(row.as_mut(), -along, base.as_ref());
                add_at(column, pivot, along);
            }
            let size = norm(row.as_ref());
            for (base, element) in next.as_mut().iter_mut().zip(row.as_mut()) {
                *base = *element / size;
                *element = S::zero();
            }
            add_at(column, pivot, size);
            add_at(&mut used, pivot, S::one());
            for (row, of_row) in rows.as_mut().iter_mut().zip(column.as_mut()) {
                let along = dot(row.as_ref(), next.as_ref());
                add_scaled(row.as_mut(), -along, next.as_ref());
                *of_row += along;
            }
            rank = step + 1;
        }
        let unused = used.as_ref().iter().enumerate().filter(|(_, used)| **used == S::zero());
        let dependent = unused.fold(RowSet::default(), |rows, (row, _)| rows.with(row));
        let triangle = orthonormalise(&mut columns, rank);
        Ok(Self { basis, columns, triangle, rank, count, nearly_singular, dependent, scalar: PhantomData })
    }

    /// The length of a row.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How many rows are independent at this position.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Whether a row is nearly dependent on the others, but not so at every position.
    pub fn nearly_singular(&self) -> bool {
        self.nearly_singular
    }

    /// The rows that depend on the others at this position.
    pub fn dependent_rows(&self) -> RowSet {
        self.dependent
    }

    /// Q s.
    pub fn coordinates(&self, s: &V) -> R {
        let mut coordinates: R = zeros(self.basis.as_ref().len());
        for (coordinate, base) in coordinates.as_mut().iter_mut().zip(self.basis.as_ref()).take(self.rank) {
            *coordinate = dot(base.as_ref(), s.as_ref());
        }
        coordinates
    }

    /// Qᵀ c.
    pub fn combination(&self, coordinates: &R) -> V {
        let mut sum = V::from_fn(self.count, |_| S::zero());
        for (base, &coordinate) in self.basis.as_ref().iter().zip(coordinates.as_ref()).take(self.rank) {
            add_scaled(sum.as_mut(), coordinate, base.as_ref());
        }
        sum
    }

    /// R⁻¹ Tᵀ b, so that s = Qᵀ R⁻¹ Tᵀ b is the shortest of the solutions of W s = b (in the sense of least squares).
    pub fn solve(&self, b: &R) -> R {
        let mut solution: R = zeros(b.as_ref().len());
        for (j, (column, row)) in
            self.columns.as_ref().iter().zip(self.triangle.as_ref()).enumerate().take(self.rank).rev()
        {
            let Some((_, [diagonal, beside @ ..])) = row.as_ref().split_at_checked(j) else { continue };
            let Some((_, [element, known @ ..])) = solution.as_mut().split_at_mut_checked(j) else { continue };
            *element = (dot(column.as_ref(), b.as_ref()) - dot(beside, known)) / *diagonal;
        }
        solution
    }

    /// T R⁻ᵀ c, the shortest λ with Wᵀ λ = Qᵀ c.
    pub fn multipliers(&self, coordinates: &R) -> R {
        let mut rest = coordinates.clone();
        let mut multipliers: R = zeros(rest.as_ref().len());
        for (j, (column, row)) in self.columns.as_ref().iter().zip(self.triangle.as_ref()).enumerate().take(self.rank) {
            let Some((_, [diagonal, beside @ ..])) = row.as_ref().split_at_checked(j) else { continue };
            let Some((_, [element, later @ ..])) = rest.as_mut().split_at_mut_checked(j) else { continue };
            let factor = *element / *diagonal;
            add_scaled(later, -factor, beside);
            add_scaled(multipliers.as_mut(), factor, column.as_ref());
        }
        multipliers
    }

    /// b − T Tᵀ b, what no s can reach.
    pub fn unreachable(&self, b: &R) -> R {
        let mut rest = b.clone();
        for column in self.columns.as_ref().iter().take(self.rank) {
            let along = dot(column.as_ref(), rest.as_ref());
            add_scaled(rest.as_mut(), -along, column.as_ref());
        }
        rest
    }
}

/// Makes the first `rank` of the vectors orthonormal; returns the rows of R, with column j before = Σ_k R_kj · column k
/// after.
fn orthonormalise<S: Real, R: Vector<S>, G: Vector<R>>(columns: &mut G, rank: usize) -> G {
    let nc = columns.as_ref().len();
    let mut triangle = G::from_fn(nc, |_| zeros(nc));
    for j in 0..rank {
        let Some((before, [column, ..])) = columns.as_mut().split_at_mut_checked(j) else { break };
        for _ in 0..2 {
            for (done, row) in before.iter().zip(triangle.as_mut()) {
                let along = dot(done.as_ref(), column.as_ref());
                add_scaled(column.as_mut(), -along, done.as_ref());
                add_at(row, j, along);
            }
        }
        let size = norm(column.as_ref());
        for element in column.as_mut() {
            *element = *element / size;
        }
        if let Some(row) = triangle.as_mut().get_mut(j) {
            add_at(row, j, size);
        }
    }
    triangle
}

fn add_at<S: Real, R: Vector<S>>(vector: &mut R, index: usize, value: S) {
    if let Some(element) = vector.as_mut().get_mut(index) {
        *element += value;
    }
}
