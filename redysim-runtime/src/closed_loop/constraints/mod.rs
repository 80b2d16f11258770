//! The constraints at one position: their Jacobian J in the metric of the mass matrix, decomposed.

mod augmentation;
mod decomposition;
pub(super) mod linear_algebra;
mod metric;

use super::{ClosedLoop, LoopError, RowSet};
use crate::{ConfigurationSpace, LoopClosure, MassMatrix, Real, Vector};
use linear_algebra::largest;
use metric::MassMetric;

pub(super) use decomposition::OrthogonalDecomposition;

/// J(q) and the decomposition of W = J U⁻ᵀ D^−½.
pub struct Constraints<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    pub jacobian: C::Jacobian,
    pub metric: MassMetric<M::Matrix>,
    /// What the metric adds to M: this times JᵀJ.
    pub augmentation: S,
    pub decomposition: OrthogonalDecomposition<S, M, C>,
}

/// What the length of a displacement is measured by.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Metric {
    /// The mass matrix, as dynamics asks for.
    Mass,
    /// One for every velocity: the rank does not depend on masses.
    Unit,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// How many of the loops' constraints are independent at `q`, by the rank of J(q) in the metric of M; the loops
    /// need not be closed there.
    ///
    /// # Errors
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
    pub fn rank<S: Real>(&self, q: &M::Coordinates) -> Result<usize, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        Ok(self.constraints_at(q)?.decomposition.rank())
    }

    /// The constraints at `q`, in the metric of M.
    pub(in crate::closed_loop) fn constraints_at<S: Real>(
        &self,
        q: &M::Coordinates,
    ) -> Result<Constraints<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        self.constraints_in(Metric::Mass, q, &[])
    }

    /// The constraints at `q`, in the given metric; the velocities `held` are zero in what is solved.
    pub(in crate::closed_loop) fn constraints_in<S: Real>(
        &self,
        metric: Metric,
        q: &M::Coordinates,
        held: &[usize],
    ) -> Result<Constraints<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let jacobian = self.closure.loop_jacobian(q);
        let mut rows = jacobian.clone();
        for row in rows.as_mut() {
            zero_columns(row, held);
        }
        let of_tree = MassMetric::new(self.matrix(metric, q, held));
        let (metric, augmentation) = match of_tree {
            Ok(of_tree) if of_tree.is_regular() => (of_tree, S::zero()),
            of_tree => {
                let mut matrix = self.matrix(metric, q, held);
                let augmentation = augmentation::augment(&mut matrix, rows.as_ref(), held);
                match MassMetric::new(matrix) {
                    Ok(augmented) if augmented.is_regular() => (augmented, augmentation),
                    _ => (of_tree?, S::zero()),
                }
            }
        };
        for row in rows.as_mut() {
            metric.scale(row);
        }
        let decomposition = OrthogonalDecomposition::new(rows, self.mechanism.nv())?;
        Ok(Constraints { jacobian, metric, augmentation, decomposition })
    }

    /// M(q), or the unit matrix; a velocity that is held is a block by itself.
    fn matrix<S: Real>(&self, metric: Metric, q: &M::Coordinates, held: &[usize]) -> M::Matrix
    where
        M: MassMatrix<S>,
    {
        let mut matrix = self.mechanism.mass_matrix(q);
        for (i, row) in matrix.as_mut().iter_mut().enumerate() {
            for (j, element) in row.as_mut().iter_mut().enumerate() {
                if metric == Metric::Unit || held.contains(&i) || held.contains(&j) {
                    *element = if i == j { S::one() } else { S::zero() };
                }
            }
        }
        matrix
    }
}

/// The length scale of a mechanism as its loops see it, m: the largest element of J, the longest lever.
pub fn length_scale<S: Real, V: Vector<S>>(jacobian: &[V]) -> S {
    let (size, _) = largest(jacobian.iter().map(|row| largest(row.as_ref().iter().copied()).0));
    if size == S::zero() { S::one() } else { size }
}

/// Makes the elements at `held` zero.
pub fn zero_columns<S: Real, V: Vector<S>>(row: &mut V, held: &[usize]) {
    for &held in held {
        if let Some(element) = row.as_mut().get_mut(held) {
            *element = S::zero();
        }
    }
}

impl<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> Constraints<S, M, C> {
    /// The length scale of the mechanism, m.
    pub fn length_scale(&self) -> S {
        length_scale(self.jacobian.as_ref())
    }

    /// The displacement δ of least norm in the metric of M with J δ = b: U⁻ᵀ D^−½ W⁺ b.
    pub fn least_norm(&self, b: &C::Rows) -> M::Velocities {
        let mut displacement = self.decomposition.combination(&self.decomposition.solve(b));
        self.metric.unscale(&mut displacement);
        displacement
    }

    /// The part of the velocity `v` that violates the constraints: v − part is the velocity nearest to v, in the
    /// metric of M, that keeps the loops closed. Nothing is divided by a number that is zero in singular positions.
    pub fn normal_velocity(&self, v: &M::Velocities) -> M::Velocities {
        let mut scaled = v.clone();
        self.metric.scale_velocity(&mut scaled);
        let mut part = self.decomposition.combination(&self.decomposition.coordinates(&scaled));
        self.metric.unscale(&mut part);
        part
    }
}
