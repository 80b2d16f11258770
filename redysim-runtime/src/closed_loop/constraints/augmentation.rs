//! M + w JᵀJ: the mass matrix of a tree with its constraints (the augmented Lagrangian formulation).

use super::length_scale;
use crate::closed_loop::ClosedLoop;
use crate::linear_algebra::largest;
use crate::vector::entry;
use crate::{LoopClosure, MassMatrix, Real, Vector};

impl<M, C> ClosedLoop<'_, M, C> {
    /// M + w JᵀJ at `q`, with w > 0 so that the largest elements of both terms are alike. It is positive definite
    /// exactly if M is so on the velocities that the loops leave free, that is, if
    /// [`dynamics`](ClosedLoop::dynamics) has a solution.
    pub fn augmented_mass_matrix<S: Real>(&self, q: &M::Coordinates) -> M::Matrix
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let mut matrix = self.mechanism.mass_matrix(q);
        augment(&mut matrix, self.closure.loop_jacobian(q).as_ref(), &[]);
        matrix
    }
}

/// Adds w JᵀJ to the matrix M of a tree, with J given by `rows`, and returns w.
///
/// What keeps the loops closed has the same motion whatever w is, since J a is prescribed: only the multipliers are
/// less by w J a. And where M is positive definite on the motions that the loops allow, M + w JᵀJ is positive definite
/// for every w > 0, though M may be singular: a rod without mass moves with the links that hold it. w makes the largest
/// elements of both terms alike, so that neither costs the other digits.
pub fn augment<S: Real, V: Vector<S>, A: Vector<V>>(matrix: &mut A, rows: &[V], held: &[usize]) -> S {
    let diagonal = matrix.as_ref().iter().enumerate().filter(|(i, _)| !held.contains(i));
    let (heaviest, _) = largest(diagonal.map(|(i, row)| entry(row, i)));
    let lever = length_scale(rows);
    let weight = heaviest / (lever * lever);
    for (i, row) in matrix.as_mut().iter_mut().enumerate() {
        for (j, element) in row.as_mut().iter_mut().enumerate() {
            let gram = rows.iter().fold(S::zero(), |sum, row| sum + entry(row, i) * entry(row, j));
            *element += weight * gram;
        }
    }
    weight
}
