//! The factorisation M = U D Uᵀ of the generalised inertia matrix (DeNOC's reverse Gaussian elimination).

use super::trace::Trace;
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// M = U D Uᵀ with U unit upper triangular in the order of bodies and D diagonal.
///
/// Elimination runs from the tips to the ground, so an element of U is zero wherever one joint does not carry the
/// other, as in M itself: nothing is filled in, and nothing is computed for such pairs. The freedoms of one joint stand
/// for a chain of joints of one freedom each.
#[derive(Clone, Debug)]
pub struct Factorisation<S> {
    /// Row by row in the order of bodies; only entries (ancestor, freedom) are used.
    upper: Vec<Vec<S>>,
    /// 1/D.
    inverse_pivots: Vec<S>,
    /// For each freedom, the one before it on the way to the ground.
    parents: Vec<Option<usize>>,
    /// For each freedom, its velocity in the model's order.
    velocities: Vec<usize>,
}

impl<S: Scalar> Factorisation<S> {
    /// Factorises the mass matrix of `tree`, given by rows in the model's order.
    pub fn new(tree: &Tree<impl Copy>, trace: &impl Trace<S>, matrix: &[Vec<S>]) -> Self {
        Factorisation::of_joints(tree, trace, matrix, |_| true)
    }

    /// Factorises the rows and columns of the velocities for which `wanted` holds: the mass matrix of the tree if the
    /// others do not move.
    pub fn of_joints(
        tree: &Tree<impl Copy>,
        trace: &impl Trace<S>,
        matrix: &[Vec<S>],
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let (mut velocities, mut parents, mut names) = (Vec::new(), Vec::new(), Vec::new());
        let mut last: Vec<Option<usize>> = Vec::with_capacity(tree.bodies.len());
        for (index, body) in tree.bodies.iter().enumerate() {
            let mut before = body.parent.and_then(|parent| last[parent]);
            for (i, velocity) in body.v.clone().enumerate().filter(|(_, velocity)| wanted(*velocity)) {
                names.push((index, body.joint.component(i)));
                parents.push(before);
                before = Some(velocities.len());
                velocities.push(velocity);
            }
            last.push(before);
        }
        let mut upper: Vec<Vec<S>> =
            velocities.iter().map(|&i| velocities.iter().map(|&j| matrix[i][j]).collect()).collect();
        let mut inverse_pivots = vec![S::zero(); velocities.len()];
        for k in (0..velocities.len()).rev() {
            let inverse = S::one() / upper[k][k];
            let (body, component) = names[k];
            trace.name(upper[k][k], "D", body, component);
            trace.name(inverse, "inv_D", body, component);
            inverse_pivots[k] = inverse;
            for i in ancestors(&parents, k) {
                let factor = inverse * upper[i][k];
                for j in std::iter::once(i).chain(ancestors(&parents, i)) {
                    let update = factor * upper[j][k];
                    upper[j][i] -= update;
                }
                upper[i][k] = factor;
            }
        }
        Factorisation { upper, inverse_pivots, parents, velocities }
    }

    /// M⁻¹ b, with b and the result in the model's order; of joints that are not factorised, b is ignored and the result
    /// is zero.
    pub fn solve(&self, b: &[S]) -> Vec<S> {
        let mut x: Vec<S> = self.velocities.iter().map(|&i| b[i]).collect();
        for k in (0..x.len()).rev() {
            for i in ancestors(&self.parents, k) {
                let update = self.upper[i][k] * x[k];
                x[i] -= update;
            }
        }
        for (value, &inverse) in x.iter_mut().zip(&self.inverse_pivots) {
            *value = *value * inverse;
        }
        for k in 0..x.len() {
            for i in ancestors(&self.parents, k) {
                let update = self.upper[i][k] * x[i];
                x[k] -= update;
            }
        }
        let mut result = vec![S::zero(); b.len()];
        for (&velocity, value) in self.velocities.iter().zip(x) {
            result[velocity] = value;
        }
        result
    }
}

/// The freedoms on the way from `freedom` to the ground, without itself.
fn ancestors(parents: &[Option<usize>], freedom: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(parents[freedom], |&at| parents[at])
}
