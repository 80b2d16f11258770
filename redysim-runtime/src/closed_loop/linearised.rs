//! The loops at one position, ready to be solved.

use super::linear::largest;
use super::mass_metric::MassMetric;
use super::row_space::RowSpace;
use super::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{LoopClosure, MassMatrix, Mechanism, Real, Vector};

/// J(q) and the decomposition of W = J U⁻ᵀ D^−½.
pub(super) struct Linearised<S: Real, M: Mechanism<S>, C: LoopClosure<S, M>> {
    pub jacobian: C::Jacobian,
    pub metric: MassMetric<M::Matrix>,
    /// What the metric adds to M: this times JᵀJ.
    pub augmentation: S,
    pub space: RowSpace<S, M, C>,
}

/// What the length of a displacement is measured by.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Metric {
    /// The mass matrix, as dynamics asks for.
    Mass,
    /// One for every coordinate: the rank does not depend on masses.
    Unit,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// How many of the loops' conditions are independent at `q`, by the rank of J(q) in the metric of M; the loops need
    /// not be closed there.
    ///
    /// # Errors
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
    pub fn rank<S: Real>(&self, q: &M::Coordinates) -> Result<usize, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        Ok(self.linearise(q, &[])?.space.rank())
    }

    /// The loops at `q`, in the metric of M; the coordinates `held` do not move in what is solved.
    pub(super) fn linearise<S: Real>(
        &self,
        q: &M::Coordinates,
        held: &[usize],
    ) -> Result<Linearised<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        self.linearise_in(Metric::Mass, q, held)
    }

    /// As [`linearise`](Self::linearise), in the given metric.
    pub(super) fn linearise_in<S: Real>(
        &self,
        metric: Metric,
        q: &M::Coordinates,
        held: &[usize],
    ) -> Result<Linearised<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let jacobian = self.closure.loop_jacobian(q);
        let mut rows = jacobian.clone();
        for row in rows.as_mut() {
            without(row, held);
        }
        let of_tree = MassMetric::new(self.matrix(metric, q, held));
        let (metric, augmentation) = match of_tree {
            Ok(of_tree) if of_tree.is_regular() => (of_tree, S::zero()),
            of_tree => {
                let mut matrix = self.matrix(metric, q, held);
                let augmentation = augment(&mut matrix, rows.as_ref(), held);
                match MassMetric::new(matrix) {
                    Ok(augmented) if augmented.is_regular() => (augmented, augmentation),
                    _ => (of_tree?, S::zero()),
                }
            }
        };
        for row in rows.as_mut() {
            metric.scale(row);
        }
        Ok(Linearised { jacobian, metric, augmentation, space: RowSpace::new(rows, self.mechanism.nv())? })
    }

    /// M(q), or the unit matrix; a coordinate that is held is a block by itself.
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

/// Adds w JᵀJ to the matrix M of a tree, with J given by `rows`, and returns w (the augmented Lagrangian formulation).
///
/// What keeps the loops closed has the same motion whatever w is, since J a is prescribed: only the multipliers are
/// less by w J a. And where M is positive definite on the motions that the loops allow, M + w JᵀJ is positive definite
/// for every w > 0, though M may be singular: a rod without mass moves with the links that hold it. w makes the largest
/// elements of both terms alike, so that neither costs the other digits.
fn augment<S: Real, V: Vector<S>, A: Vector<V>>(matrix: &mut A, rows: &[V], held: &[usize]) -> S {
    let diagonal = matrix.as_ref().iter().enumerate().filter(|(i, _)| !held.contains(i));
    let (heaviest, _) = largest(diagonal.map(|(i, row)| entry(row, i)));
    let lever = size(rows);
    let weight = heaviest / (lever * lever);
    for (i, row) in matrix.as_mut().iter_mut().enumerate() {
        for (j, element) in row.as_mut().iter_mut().enumerate() {
            let gram = rows.iter().fold(S::zero(), |sum, row| sum + entry(row, i) * entry(row, j));
            *element += weight * gram;
        }
    }
    weight
}

/// The size of a mechanism as its loops see it, m: the largest element of J, the longest lever.
pub(super) fn size<S: Real, V: Vector<S>>(jacobian: &[V]) -> S {
    let (size, _) = largest(jacobian.iter().map(|row| largest(row.as_ref().iter().copied()).0));
    if size == S::zero() { S::one() } else { size }
}

/// Makes the elements at `held` zero.
pub(super) fn without<S: Real, V: Vector<S>>(row: &mut V, held: &[usize]) {
    for &held in held {
        if let Some(element) = row.as_mut().get_mut(held) {
            *element = S::zero();
        }
    }
}

impl<S: Real, M: Mechanism<S>, C: LoopClosure<S, M>> Linearised<S, M, C> {
    /// The size of the mechanism, m.
    pub fn scale(&self) -> S {
        size(self.jacobian.as_ref())
    }

    /// The displacement δ, shortest in the metric of M, with J δ = b: U⁻ᵀ D^−½ W⁺ b.
    pub fn shortest(&self, b: &C::Rows) -> M::Velocities {
        let mut displacement = self.space.combination(&self.space.solve(b));
        self.metric.unscale(&mut displacement);
        displacement
    }

    /// The part of the velocity `v` that pulls the loops apart: v − part is the velocity nearest to v, in the metric of
    /// M, that keeps them closed. It takes no division by what may be singular.
    pub fn pulling_apart(&self, v: &M::Velocities) -> M::Velocities {
        let mut scaled = v.clone();
        self.metric.scale_velocity(&mut scaled);
        let mut part = self.space.combination(&self.space.coordinates(&scaled));
        self.metric.unscale(&mut part);
        part
    }
}
