//! The distribution of masses on joint axes between the bodies.
//!
//! [Base parameters](redysim_model::regroup) make three numbers of each body vanish. The same freedom can make others
//! vanish, such as the parent's first moment, which saves a column of U h and a part of h × a. For each body, the
//! masses on its axis that cancel one number of its parent are tried, and the one that lowers the count most is taken.

use super::neighbourhood::neighbourhood;
use super::{Cost, KeepsDigits};
use crate::symbol::{Symbol, SymbolicTree};
use redysim_model::Tree;
use redysim_model::joint::AxisMass;
use redysim_model::parameter::Parameter;
use redysim_model::pseudo::PseudoInertia;
use redysim_model::regroup::take_from_parent;
use redysim_runtime::Scalar;

/// The tree, of base parameters, with masses on its axes where they lower the cost and cost no digits.
pub fn placed<'p>(
    tree: &SymbolicTree<'p>,
    cost: Cost<Symbol<'p>>,
    keeps_digits: KeepsDigits<Symbol<'p>>,
) -> SymbolicTree<'p> {
    let mut tree = tree.clone();
    for body in (0..tree.bodies.len()).rev() {
        if tree.bodies[body].parent.is_none() || !tree.bodies[body].joint.shares_axis_mass() {
            continue;
        }
        for order in [MomentOrder::Zeroth, MomentOrder::First, MomentOrder::Second] {
            let part = neighbourhood(&tree, body);
            let local = part.index_of(body).expect("the body itself");
            let mut least = cost(&part.tree);
            let mut best = None;
            for amount in candidates(&tree, body, order) {
                let mut other = part.tree.clone();
                take_from_parent(&mut other, local, order.times(amount));
                part.relieve_stand_ins(&mut other);
                let price = cost(&other);
                if price < least {
                    (least, best) = (price, Some(amount));
                }
            }
            if let Some(amount) = best {
                let mut other = tree.clone();
                take_from_parent(&mut other, body, order.times(amount));
                if keeps_digits(&other) {
                    tree = other;
                }
            }
        }
    }
    tree
}

/// The moment of a mass on an axis that is changed.
#[derive(Clone, Copy)]
enum MomentOrder {
    Zeroth,
    First,
    Second,
}

impl MomentOrder {
    /// The largest moment of this order in the robot. Base parameters have moved most of the mass to the ground,
    /// whose other moments depend on where the robot stands.
    fn largest(self, tree: &SymbolicTree) -> f64 {
        let ground = if let MomentOrder::Zeroth = self { tree.ground.mass } else { Symbol::zero() };
        let values = tree.bodies.iter().flat_map(|body| match self {
            MomentOrder::Zeroth => [body.inertia.mass, Symbol::zero(), Symbol::zero()],
            MomentOrder::First => body.inertia.moment.0,
            MomentOrder::Second => [body.inertia.second.xx, body.inertia.second.yy, body.inertia.second.zz],
        });
        values.chain([ground]).fold(0.0, |largest, value| largest.max(value.nominal().abs()))
    }

    fn times<P: Parameter>(self, amount: P) -> AxisMass<P> {
        let none = AxisMass::zero();
        match self {
            MomentOrder::Zeroth => AxisMass { mass: amount, ..none },
            MomentOrder::First => AxisMass { first: amount, ..none },
            MomentOrder::Second => AxisMass { second: amount, ..none },
        }
    }
}

/// The amounts of mass that make one number of the parent vanish.
fn candidates<'p>(tree: &SymbolicTree<'p>, body: usize, order: MomentOrder) -> Vec<Symbol<'p>> {
    let Some(parent) = tree.bodies[body].parent else { return Vec::new() };
    let now = numbers(tree, parent);
    let mut changed = tree.clone();
    take_from_parent(&mut changed, body, order.times(Symbol::Constant(1.0)));
    let then = numbers(&changed, parent);
    // What a unit of mass does to a number does not depend on the number.
    let mut unit = tree.map(|_| 0.0);
    take_from_parent(&mut unit, body, order.times(1.0));
    let changes = numbers(&unit, parent);
    // With a short lever the mass would be large, and cost the others digits.
    let most = order.largest(tree);
    let mut found: Vec<Symbol> = Vec::new();
    for ((now, then), change) in now.into_iter().zip(then).zip(changes) {
        let amount = match (now.number(), then.number()) {
            (Some(0.0), _) => continue,
            (Some(now), Some(then)) => Symbol::Constant(now / (now - then)),
            _ if change == 0.0 => continue,
            _ => now / Symbol::Constant(-change),
        };
        let is_new = |other: &Symbol| amount.number().is_none() || other.number() != amount.number();
        if amount.nominal().abs() <= most && found.iter().all(is_new) {
            found.push(amount);
        }
    }
    found
}

/// The numbers of a body.
fn numbers<P: Parameter>(tree: &Tree<P>, body: usize) -> [P; 10] {
    let PseudoInertia { mass, moment, second: s } = tree.bodies[body].inertia;
    [moment[0], moment[1], moment[2], s.xx, s.yy, s.xy, s.xz, s.yz, s.zz, mass]
}
