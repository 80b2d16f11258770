//! One angle for consecutive parallel axes.
//!
//! Where the axis of a child is parallel to its parent's, the parent may be computed in axes that do not rotate with
//! its joint. Then only what is fixed to the parent is rotated by its angle, a few constants, and everything that
//! passes between the child and the rest of the tree is rotated once, by the sum of the two angles, instead of twice.

use super::neighbourhood::neighbourhood;
use super::{Cost, KeepsDigits};
use redysim_model::Tree;
use redysim_model::parameter::Parameter;

/// The tree with bodies in axes that do not rotate with their joints where that lowers the cost and costs no digits:
/// one after the other, or all at once.
pub fn merged<P: Parameter>(tree: &Tree<P>, cost: Cost<P>, keeps_digits: KeepsDigits<P>) -> Tree<P> {
    let one_by_one = one_by_one(tree, cost, keeps_digits);
    match merged_everywhere(tree) {
        Some(all) if cost(&all) < cost(&one_by_one) && keeps_digits(&all) => all,
        _ => one_by_one,
    }
}

/// The tree with all bodies in such axes whose own axis is parallel to their parent's or a child's; `None` if there is
/// no such body.
pub fn merged_everywhere<P: Parameter>(tree: &Tree<P>) -> Option<Tree<P>> {
    let mut all = tree.clone();
    for body in 0..tree.bodies.len() {
        let below = tree.bodies[body].parent.is_some() && tree.bodies[body].is_parallel();
        let above = tree.children(body).any(|child| tree.bodies[child].is_parallel());
        all.bodies[body].merged_parallel = tree.bodies[body].joint.is_on_axis() && (below || above);
    }
    all.bodies.iter().any(|body| body.merged_parallel).then_some(all)
}

/// The tree with all bodies in such axes that carry one with a parallel axis, and all tips; `None` if no body is one of
/// these.
pub fn merged_carriers<P: Parameter>(tree: &Tree<P>) -> Option<Tree<P>> {
    let mut all = tree.clone();
    for body in 0..tree.bodies.len() {
        let carries = tree.children(body).any(|child| tree.bodies[child].is_parallel());
        let tip = tree.children(body).next().is_none();
        all.bodies[body].merged_parallel = tree.bodies[body].joint.is_on_axis() && (carries || tip);
    }
    all.bodies.iter().any(|body| body.merged_parallel).then_some(all)
}

fn one_by_one<P: Parameter>(tree: &Tree<P>, cost: Cost<P>, keeps_digits: KeepsDigits<P>) -> Tree<P> {
    let mut tree = tree.clone();
    for body in 0..tree.bodies.len() {
        let beside = |child: usize| tree.bodies[child].is_parallel();
        let parallel_child = tree.children(body).any(beside);
        let after_merged =
            tree.bodies[body].parent.is_some_and(|parent| tree.bodies[parent].merged_parallel) && beside(body);
        let tip = tree.children(body).next().is_none();
        if !tree.bodies[body].joint.is_on_axis() || !(parallel_child || after_merged || tip) {
            continue;
        }
        let part = neighbourhood(&tree, body);
        let local = part.index_of(body).expect("the body itself");
        let mut other = part.tree.clone();
        other.bodies[local].merged_parallel = true;
        if cost(&other) < cost(&part.tree) {
            tree.bodies[body].merged_parallel = true;
            if !keeps_digits(&tree) {
                tree.bodies[body].merged_parallel = false;
            }
        }
    }
    tree
}
