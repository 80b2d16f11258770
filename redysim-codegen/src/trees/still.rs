//! One angle for consecutive parallel axes.
//!
//! Where the axis of a child is parallel to its parent's, the parent may be computed in axes that do not turn with its
//! joint: what is fixed to the parent is turned by its angle, a few constants, and everything that passes between the
//! child and the rest of the tree is turned once, by the sum of the two angles, instead of twice.

use super::neighbourhood::neighbourhood;
use super::{Cost, KeepsDigits};
use redysim_model::Tree;

/// The tree, with those bodies in still axes for which that lowers the cost and that are kept: one after the other, or
/// all at once.
pub fn stilled(tree: &Tree, cost: Cost, keeps_digits: KeepsDigits) -> Tree {
    let one_by_one = one_by_one(tree, cost, keeps_digits);
    match everywhere(tree) {
        Some(all) if cost(&all) < cost(&one_by_one) && keeps_digits(&all) => all,
        _ => one_by_one,
    }
}

/// The tree with every body in still axes that has a parallel axis beside it; `None` if there is none.
pub fn everywhere(tree: &Tree) -> Option<Tree> {
    let mut all = tree.clone();
    for body in 0..tree.bodies.len() {
        let below = tree.bodies[body].parent.is_some() && tree.bodies[body].is_parallel();
        all.bodies[body].still = below || tree.children(body).any(|child| tree.bodies[child].is_parallel());
    }
    all.bodies.iter().any(|body| body.still).then_some(all)
}

fn one_by_one(tree: &Tree, cost: Cost, keeps_digits: KeepsDigits) -> Tree {
    let mut tree = tree.clone();
    for body in 0..tree.bodies.len() {
        let beside = |child: usize| tree.bodies[child].is_parallel();
        let parallel_child = tree.children(body).any(beside);
        let after_still = tree.bodies[body].parent.is_some_and(|parent| tree.bodies[parent].still) && beside(body);
        let tip = tree.children(body).next().is_none();
        if !parallel_child && !after_still && !tip {
            continue;
        }
        let part = neighbourhood(&tree, body);
        let local = part.index_of(body).expect("the body itself");
        let mut other = part.tree.clone();
        other.bodies[local].still = true;
        if cost(&other) < cost(&part.tree) {
            tree.bodies[body].still = true;
            if !keeps_digits(&tree) {
                tree.bodies[body].still = false;
            }
        }
    }
    tree
}
