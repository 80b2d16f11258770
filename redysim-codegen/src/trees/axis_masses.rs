//! Which mass on the joint axes goes with which body.
//!
//! [Base parameters](redysim_model::regroup) make three numbers of each body vanish. The same freedom can make others
//! vanish: a mass at the child's origin instead of the parent's first moment, say, which saves a column of U h and a
//! part of h × a. For each body the mass on its axis is tried that cancels one number of its parent's, and kept where
//! the count falls.

use super::neighbourhood::neighbourhood;
use super::{Cost, Keeps};
use redysim_model::Tree;
use redysim_model::joint::{AxisMass, Joint};
use redysim_model::pseudo::PseudoInertia;
use redysim_model::regroup::take_from_parent;

/// The tree, of base parameters, with masses on its axes where they lower the cost and are kept.
pub fn placed(tree: &Tree, cost: Cost, keeps: Keeps) -> Tree {
    let mut tree = tree.clone();
    for body in (0..tree.bodies.len()).rev() {
        if tree.bodies[body].parent.is_none() || tree.bodies[body].joint != Joint::Revolute {
            continue;
        }
        for kind in [Kind::Mass, Kind::First, Kind::Second] {
            let part = neighbourhood(&tree, body);
            let local = part.index_of(body).expect("the body itself");
            let mut least = cost(&part.tree);
            let mut best = None;
            for mass in candidates(&tree, body, kind) {
                let mut other = part.tree.clone();
                take_from_parent(&mut other, local, mass);
                part.relieve_stand_ins(&mut other);
                let price = cost(&other);
                if price < least {
                    (least, best) = (price, Some(mass));
                }
            }
            if let Some(mass) = best {
                let mut other = tree.clone();
                take_from_parent(&mut other, body, mass);
                if keeps(&other) {
                    tree = other;
                }
            }
        }
    }
    tree
}

#[derive(Clone, Copy)]
enum Kind {
    Mass,
    First,
    Second,
}

impl Kind {
    /// The largest of this kind in the robot. Base parameters have moved most of the mass to the ground; its moments
    /// there depend on where the robot stands.
    fn largest(self, tree: &Tree) -> f64 {
        let least = if let Kind::Mass = self { tree.ground.mass } else { 0.0 };
        let values = tree.bodies.iter().flat_map(|body| match self {
            Kind::Mass => [body.inertia.mass, 0.0, 0.0],
            Kind::First => body.inertia.moment.0,
            Kind::Second => [body.inertia.second.xx, body.inertia.second.yy, body.inertia.second.zz],
        });
        values.fold(least, |largest, value| largest.max(value.abs()))
    }

    fn times(self, amount: f64) -> AxisMass {
        match self {
            Kind::Mass => AxisMass { mass: amount, ..AxisMass::default() },
            Kind::First => AxisMass { first: amount, ..AxisMass::default() },
            Kind::Second => AxisMass { second: amount, ..AxisMass::default() },
        }
    }
}

/// The masses that make one number of the parent's vanish.
fn candidates(tree: &Tree, body: usize, kind: Kind) -> Vec<AxisMass> {
    let Some(parent) = tree.bodies[body].parent else { return Vec::new() };
    let now = numbers(tree, parent);
    let mut changed = tree.clone();
    take_from_parent(&mut changed, body, kind.times(1.0));
    let then = numbers(&changed, parent);
    // Where a body is a small lever, a large mass would be wanted, and its digits would be those that the others lose.
    let most = kind.largest(tree);
    let mut found: Vec<AxisMass> = Vec::new();
    for (now, then) in now.into_iter().zip(then) {
        // The number falls by `now − then` for each unit.
        let amount = now / (now - then);
        if now != 0.0 && amount.abs() <= most && !found.contains(&kind.times(amount)) {
            found.push(kind.times(amount));
        }
    }
    found
}

/// The numbers of a body that no choice on its own axis can remove.
fn numbers(tree: &Tree, body: usize) -> [f64; 7] {
    let PseudoInertia { moment, second: s, .. } = tree.bodies[body].inertia;
    [moment[0], moment[1], s.xx, s.yy, s.xy, s.xz, s.yz]
}
