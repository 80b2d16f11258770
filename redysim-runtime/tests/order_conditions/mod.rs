// Rooted trees and the order conditions of Runge-Kutta methods (Butcher's theory), for the tests of coefficients.

use redysim_runtime::Real;
use std::collections::BTreeSet;

/// A rooted tree: its branches, sorted, so that equal trees are equal.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Tree(Vec<Tree>);

impl Tree {
    fn order(&self) -> usize {
        1 + self.0.iter().map(Tree::order).sum::<usize>()
    }

    /// γ: the product of the orders of all subtrees.
    fn density(&self) -> f64 {
        self.order() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// Φ_k, one for each stage: Π over branches of Σ_j a_kj Φ_j(branch).
    fn elementary_weights<const STAGES: usize>(&self, rows: [&[f64]; STAGES]) -> [f64; STAGES] {
        self.0.iter().fold([1.0; STAGES], |weights, branch| {
            let inner = branch.elementary_weights(rows);
            std::array::from_fn(|k| weights[k] * dot(rows[k], &inner))
        })
    }

    /// All trees with one more leaf.
    fn grown(&self) -> Vec<Tree> {
        let mut grown = vec![self.with_branches(|branches| branches.push(Tree(vec![])))];
        for (i, branch) in self.0.iter().enumerate() {
            grown.extend(branch.grown().into_iter().map(|new| self.with_branches(|branches| branches[i] = new)));
        }
        grown
    }

    fn with_branches(&self, change: impl FnOnce(&mut Vec<Tree>)) -> Tree {
        let mut branches = self.0.clone();
        change(&mut branches);
        branches.sort();
        Tree(branches)
    }
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn trees(order: usize) -> BTreeSet<Tree> {
    if order == 1 { [Tree(vec![])].into() } else { trees(order - 1).iter().flat_map(Tree::grown).collect() }
}

/// The largest violation of b·Φ(t) = θ^order / γ(t) over all trees of one order, of the method with the given rows of
/// a, which may end where only zeros follow.
pub fn defect<const STAGES: usize>(rows: [&[f64]; STAGES], order: usize, b: &[f64], theta: f64) -> f64 {
    let exact = |tree: &Tree| theta.powi(order as i32) / tree.density();
    trees(order)
        .iter()
        .map(|tree| (dot(b, &tree.elementary_weights(rows)) - exact(tree)).abs())
        .fold(0.0, Real::maximum)
}

/// The values of polynomials without constant terms.
pub fn values<const STAGES: usize>(polynomials: [&[f64]; STAGES], theta: f64) -> [f64; STAGES] {
    polynomials.map(|polynomial| (1..).zip(polynomial).map(|(power, c)| c * theta.powi(power)).sum())
}
