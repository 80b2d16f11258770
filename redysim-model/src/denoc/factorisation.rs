//! The factorisation M = U D Uᵀ of the generalised inertia matrix (DeNOC's reverse Gaussian elimination).

use super::trace::Trace;
use crate::joint::Screw;
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The order in which the freedoms of a mechanism are eliminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EliminationOrder {
    /// From the tips to the ground. Nothing is filled in.
    TipsFirst,
    /// The displacements of the whole mechanism, then all others from the tips to the ground.
    ///
    /// These are the freedoms between the ground and the first joint that turns. A displacement of the whole mechanism
    /// meets a constant mass, so these pivots are numbers, and what is left is the motion about the centre of mass: the
    /// others meet three freedoms less of a free base. In return every joint then couples to every other.
    DisplacementsFirst,
}

impl EliminationOrder {
    /// The orders that differ for a tree.
    pub fn all_of<P>(tree: &Tree<P>) -> impl Iterator<Item = EliminationOrder> {
        let displaces = displacements(tree).contains(&true);
        [Some(EliminationOrder::TipsFirst), displaces.then_some(EliminationOrder::DisplacementsFirst)]
            .into_iter()
            .flatten()
    }
}

/// For each velocity of all joints, whether it displaces the whole mechanism, without turning it.
fn displacements<P>(tree: &Tree<P>) -> Vec<bool> {
    let mut displaces = vec![false; tree.nv_of_all()];
    let mut unturned = vec![false; tree.bodies.len()];
    let whole = tree.bodies.iter().filter(|body| body.parent.is_none()).count() == 1;
    for (index, body) in tree.bodies.iter().enumerate() {
        let on_unturned = body.parent.map_or(whole, |parent| unturned[parent] && tree.children(parent).count() == 1);
        let slides = |screw: Screw| screw.turn == 0.0;
        unturned[index] = on_unturned && body.joint.screws().all(slides);
        for (velocity, screw) in body.v.clone().zip(body.joint.screws()) {
            displaces[velocity] = on_unturned && slides(screw);
        }
    }
    displaces
}

/// M = U D Uᵀ with U unit upper triangular in the order of bodies and D diagonal.
///
/// Elimination runs from the tips to the ground, so an element of U is zero wherever one joint does not carry the
/// other, as in M itself: nothing is filled in, and nothing is computed for such pairs. The freedoms of one joint stand
/// for a chain of joints with one degree of freedom each.
#[derive(Clone, Debug)]
pub struct Factorisation<S> {
    /// Row by row in the order of bodies; only entries (ancestor, freedom) are used.
    upper: Vec<Vec<S>>,
    /// 1/D.
    inverse_pivots: Vec<S>,
    /// For each freedom, its parent in the [elimination tree](elimination_tree).
    parents: Vec<Option<usize>>,
    /// For each freedom, its velocity in the model's order.
    velocities: Vec<usize>,
}

impl<S: Scalar> Factorisation<S> {
    /// Factorises the mass matrix of `tree`, given by rows in the model's order.
    pub fn new(order: EliminationOrder, tree: &Tree<impl Copy>, trace: &impl Trace<S>, matrix: &[Vec<S>]) -> Self {
        Factorisation::of_joints(order, tree, trace, matrix, |_| true)
    }

    /// Factorises the rows and columns of the velocities for which `wanted` holds: the mass matrix of the tree if the
    /// others do not move.
    pub fn of_joints(
        order: EliminationOrder,
        tree: &Tree<impl Copy>,
        trace: &impl Trace<S>,
        matrix: &[Vec<S>],
        wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let nv = tree.nv();
        let of_body = |body: usize| tree.bodies[body].v.clone().map(move |velocity| (velocity, body));
        let is_wanted = |&(velocity, _): &(usize, usize)| velocity < nv && wanted(velocity);
        let mut rows: Vec<(usize, usize)> = tree.outward().flat_map(of_body).filter(is_wanted).collect();
        if order == EliminationOrder::DisplacementsFirst {
            let displaces = displacements(tree);
            rows.sort_by_key(|&(velocity, _)| displaces[velocity]);
        }
        let mut freedoms = vec![None; tree.nv_of_all()];
        for (freedom, &(velocity, _)) in rows.iter().enumerate() {
            freedoms[velocity] = Some(freedom);
        }
        for (k, mimic) in tree.mimics.iter().enumerate() {
            freedoms[nv + k] = freedoms[mimic.v];
        }
        let parents = elimination_tree(tree, rows.len(), &freedoms);
        let velocities: Vec<usize> = rows.iter().map(|&(velocity, _)| velocity).collect();
        let mut upper: Vec<Vec<S>> =
            velocities.iter().map(|&i| velocities.iter().map(|&j| matrix[i][j]).collect()).collect();
        let mut inverse_pivots = vec![S::zero(); velocities.len()];
        for k in (0..velocities.len()).rev() {
            let inverse = S::one() / upper[k][k];
            let (velocity, body) = rows[k];
            let component = tree.bodies[body].joint.component(velocity - tree.bodies[body].v.start);
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

/// For each freedom, the last of the others that its elimination changes: in a tree, the one before it on the way to the
/// ground (Liu, "The role of elimination trees in sparse factorization", SIAM J. Matrix Anal. Appl. 11(1), 1990). A joint
/// that mimics another couples this one to all that it carries and that carries it.
///
/// `freedoms` has the freedom of each velocity of all joints.
fn elimination_tree(tree: &Tree<impl Copy>, count: usize, freedoms: &[Option<usize>]) -> Vec<Option<usize>> {
    let of_body = |body: usize| freedoms[tree.bodies[body].v.clone()].iter().filter_map(|freedom| *freedom);
    let mut coupled = Vec::new();
    for body in tree.outward() {
        for at in std::iter::successors(Some(body), |&at| tree.bodies[at].parent) {
            let pairs = of_body(body).flat_map(|i| of_body(at).map(move |j| (i.min(j), i.max(j))));
            coupled.extend(pairs.filter(|(first, last)| first < last));
        }
    }
    coupled.sort_unstable_by_key(|&(first, _)| std::cmp::Reverse(first));
    let mut parents: Vec<Option<usize>> = vec![None; count];
    for (first, last) in coupled {
        let mut at = last;
        while let Some(parent) = parents[at].filter(|_| at != first) {
            at = parent;
        }
        if at != first {
            parents[at] = Some(first);
        }
    }
    parents
}

/// The freedoms on the way from `freedom` to the root of the elimination tree, without itself.
fn ancestors(parents: &[Option<usize>], freedom: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(parents[freedom], |&at| parents[at])
}
