//! Small vectors and matrices by slices, and the solves of any rank that closed loops and operational space stand on;
//! nothing here can panic.
//!
//! A program without panics cannot take these solves from nalgebra, as `studies/nalgebra` shows for version 0.35: of what
//! reveals a rank, neither basis, order nor solution of `ColPivQR` links into one, nor do `FullPivLU`, `SVD` and
//! `SymmetricEigen`. `Cholesky` does; its sizes are types, which code over arrays and `Vec` alike does not have.

mod mass_metric;
mod orthogonal_decomposition;
mod row_set;
mod weighted_rows;

pub use mass_metric::{MassMetric, NotPositiveDefinite};
pub use orthogonal_decomposition::{NotFinite, OrthogonalDecomposition};
pub use row_set::RowSet;
pub use weighted_rows::WeightedRows;

use crate::vector::entry;
use crate::{Real, Scalar, Vector};

/// A row counts as dependent when what remains of it is at most this part of the longest row.
///
/// At a singular position a residual of rounding size leaves the position uncertain by its root, 10⁻⁸, and what is
/// divided by the remainder σ carries an error of that size over σ. A row left out for one evaluation, on the other
/// hand, costs little, since σ is as small only within a tiny part of a step. Experiments with the N-four-bar (steps of
/// 10⁻² to 5·10⁻⁵ s through ten singular positions) are best between 3·10⁻⁶ and 3·10⁻⁵.
const DEPENDENT: f64 = 1e-5;
/// The tolerance of ranks.
pub fn rank_tolerance<S: Real>() -> S {
    S::from_f64(DEPENDENT).maximum(S::EPSILON.sqrt())
}

/// Σ aᵢ bᵢ.
pub fn dot<S: Scalar>(a: &[S], b: &[S]) -> S {
    a.iter().zip(b).fold(S::zero(), |sum, (&a, &b)| sum + a * b)
}

/// a × b.
pub fn cross<S: Scalar>([a, b, c]: [S; 3], [x, y, z]: [S; 3]) -> [S; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// The Euclidean length.
pub fn norm<S: Scalar>(x: &[S]) -> S {
    dot(x, x).sqrt()
}

/// y += factor · x.
pub fn add_scaled<S: Scalar>(y: &mut [S], factor: S, x: &[S]) {
    for (y, &x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// The largest magnitude and where it is; NaN is larger than anything. Zero for no values.
pub fn largest<S: Real>(values: impl IntoIterator<Item = S>) -> (S, usize) {
    values.into_iter().enumerate().fold((S::zero(), 0), |(largest, at), (index, value)| {
        let size = value.abs();
        if size <= largest || largest.to_f64().is_nan() { (largest, at) } else { (size, index) }
    })
}

/// A vector of zeros.
pub fn zeros<S: Scalar, V: Vector<S>>(len: usize) -> V {
    V::from_fn(len, |_| S::zero())
}

/// The difference of two vectors.
pub fn difference<S: Scalar, V: Vector<S>>(a: &V, b: &V) -> V {
    V::from_fn(a.as_ref().len(), |i| entry(a, i) - entry(b, i))
}

/// The product of a matrix, given by rows, and a vector.
pub fn product<S: Scalar, V: Vector<S>, R: Vector<S>>(rows: &[V], x: &[S]) -> R {
    R::from_fn(rows.len(), |i| rows.get(i).map_or(S::from_f64(f64::NAN), |row| dot(row.as_ref(), x)))
}
