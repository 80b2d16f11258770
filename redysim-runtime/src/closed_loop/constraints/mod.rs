//! The constraints at one position: their Jacobian J in the metric of the mass matrix, decomposed.

mod augmentation;

use super::{ClosedLoop, LoopError};
use crate::linear_algebra::{MassMetric, OrthogonalDecomposition, WeightedRows, largest, rank_tolerance};
use crate::{ConfigurationSpace, LoopClosure, MassMatrix, Real, Vector};

/// Rows of the loops' Jacobian, decomposed.
pub type LoopDecomposition<S, M, C> = OrthogonalDecomposition<
    S,
    <M as ConfigurationSpace<S>>::Velocities,
    <C as LoopClosure<S, M>>::Rows,
    <C as LoopClosure<S, M>>::Jacobian,
    <C as LoopClosure<S, M>>::Gram,
>;
/// The same in the metric of M.
type WeightedJacobian<S, M, C> = WeightedRows<
    S,
    <M as ConfigurationSpace<S>>::Velocities,
    <C as LoopClosure<S, M>>::Rows,
    <M as ConfigurationSpace<S>>::Matrix,
    <C as LoopClosure<S, M>>::Jacobian,
    <C as LoopClosure<S, M>>::Gram,
>;

/// J(q) and the decomposition of W = J U⁻ᵀ D^−½.
pub struct Constraints<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    pub jacobian: C::Jacobian,
    pub weighted: WeightedJacobian<S, M, C>,
    /// What the metric adds to M: this times JᵀJ.
    pub augmentation: S,
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
        Ok(self.constraints_at(q)?.weighted.decomposition.rank())
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
        let weighted = WeightedRows::new(metric, rows, self.mechanism.nv(), rank_tolerance())?;
        Ok(Constraints { jacobian, weighted, augmentation })
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
    /// Whether all `rows` are independent, with a margin.
    pub fn are_regular(&self, rows: usize) -> bool {
        let decomposition = &self.weighted.decomposition;
        !decomposition.nearly_singular() && decomposition.rank() == rows
    }

    /// The length scale of the mechanism, m.
    pub fn length_scale(&self) -> S {
        length_scale(self.jacobian.as_ref())
    }
}
