//! Rows in the metric of a mass matrix, of any rank.

use super::{MassMetric, NotFinite, OrthogonalDecomposition};
use crate::{Real, Vector};

/// The rows of J in the metric of M = U D Uᵀ: W = J U⁻ᵀ D^−½, decomposed.
#[derive(Clone)]
pub struct WeightedRows<S, V, R, A, W, G> {
    pub metric: MassMetric<A>,
    pub decomposition: OrthogonalDecomposition<S, V, R, W, G>,
}

impl<S, V, R, A, W, G> WeightedRows<S, V, R, A, W, G>
where
    S: Real,
    V: Vector<S>,
    R: Vector<S>,
    A: Vector<V>,
    W: Vector<V>,
    G: Vector<R>,
{
    /// The rows of J, each of length `count`; a row of W counts as dependent when what remains of it is at most
    /// `tolerance` times the longest.
    pub fn new(metric: MassMetric<A>, mut rows: W, count: usize, tolerance: S) -> Result<Self, NotFinite> {
        for row in rows.as_mut() {
            metric.scale(row);
        }
        Ok(WeightedRows { metric, decomposition: OrthogonalDecomposition::new(rows, count, tolerance)? })
    }

    /// The displacement δ of least norm in the metric of M with J δ = b: U⁻ᵀ D^−½ W⁺ b.
    pub fn least_norm(&self, b: &R) -> V {
        let mut displacement = self.decomposition.combination(&self.decomposition.solve(b));
        self.metric.unscale(&mut displacement);
        displacement
    }

    /// The part of the velocity `v` that changes J v: v − part is the velocity nearest to v, in the metric of M, with
    /// J (v − part) = 0. Nothing is divided by a number that is zero where rows are dependent.
    pub fn normal_velocity(&self, v: &V) -> V {
        let mut scaled = v.clone();
        self.metric.scale_velocity(&mut scaled);
        let mut part = self.decomposition.combination(&self.decomposition.coordinates(&scaled));
        self.metric.unscale(&mut part);
        part
    }
}
