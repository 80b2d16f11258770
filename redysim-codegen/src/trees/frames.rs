//! The choice of frames.
//!
//! The search starts from [canonical](redysim_model::frames::canonical) frames, so that the result does not depend on
//! the model's own, and tries for each body the few placements that can make a constant vanish.

use super::neighbourhood::neighbourhood;
use super::{Cost, KeepsDigits};
use redysim_model::Tree;
use redysim_model::frames::{
    canonical, reframe, slide_to_child, slide_to_parent, turn_to_child, turn_to_inertia, turn_to_principal_axis,
};
use redysim_model::joint::Vanishing;
use redysim_model::parameter::Parameter;
use redysim_model::regroup::base_parameters;

/// The tree with frames that lower the cost and cost no digits.
pub fn chosen<P: Parameter>(tree: &Tree<P>, cost: Cost<P>, keeps_digits: KeepsDigits<P>) -> Tree<P> {
    let mut best = canonical(tree, keeps_digits);
    for body in (0..best.bodies.len()).rev() {
        if !best.bodies[body].joint.is_on_axis() {
            continue;
        }
        for candidates in [turns, slides] {
            let changes = candidates(&best, body);
            improve(&mut best, body, &changes, cost, keeps_digits);
        }
    }
    best
}

/// Applies the cheapest of the changes (angle, distance) to the frame of `body`, if it is cheaper than none.
fn improve<P: Parameter>(
    tree: &mut Tree<P>,
    body: usize,
    candidates: &[(f64, f64)],
    cost: Cost<P>,
    keeps_digits: KeepsDigits<P>,
) {
    let part = neighbourhood(tree, body);
    let local = part.index_of(body).expect("the body itself");
    let cost = |tree: &Tree<P>| {
        let mut base = base_parameters(tree, Vanishing::SecondMomentZz);
        part.relieve_stand_ins(&mut base);
        cost(&base)
    };
    let mut least = cost(&part.tree);
    let mut best = None;
    for &(angle, distance) in candidates {
        let mut other = part.tree.clone();
        reframe(&mut other, local, angle, distance);
        let price = cost(&other);
        if price < least {
            (least, best) = (price, Some((angle, distance)));
        }
    }
    if let Some((angle, distance)) = best {
        let mut other = tree.clone();
        reframe(&mut other, body, angle, distance);
        if keeps_digits(&other) {
            *tree = other;
        }
    }
}

fn turns<P: Parameter>(tree: &Tree<P>, body: usize) -> Vec<(f64, f64)> {
    let to_children = tree.children(body).filter_map(|child| turn_to_child(tree, child));
    let to_inertia = [turn_to_inertia(tree, body), turn_to_principal_axis(tree, body)].into_iter().flatten();
    to_children.chain(to_inertia).filter(|angle| angle.abs() > 1e-12).map(|angle| (angle, 0.0)).collect()
}

fn slides<P: Parameter>(tree: &Tree<P>, body: usize) -> Vec<(f64, f64)> {
    let to_children = tree.children(body).filter_map(|child| slide_to_child(tree, child));
    let all = to_children.chain(slide_to_parent(tree, body));
    all.filter(|distance| distance.abs() > 1e-12).map(|distance| (0.0, distance)).collect()
}
