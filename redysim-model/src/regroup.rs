//! Base parameters: inertia that a joint cannot tell from its parent's is moved to the parent.
//!
//! Mass on the axis of a joint that turns belongs to both bodies: whichever carries it, it moves the same. Of such mass
//! the moments ∫1, ∫z and ∫z² enter, which are three of a body's ten parameters: the mass m, the first moment h_z and
//! the second moment Σ_zz (of which an inertia tensor has diag(1, 1, 0)). Moved to the parent they leave a body with
//! seven. For a joint that moves along z, all second moments about the body's origin can go. Kinetic and potential
//! energy of the whole mechanism, hence M, C and g, stay exactly the same (Gautier & Khalil, "Direct calculation of
//! minimum set of inertial parameters of serial robots", IEEE Trans. Robotics and Automation 6(3), 1990). Energies and
//! wrenches of single links do not, and a body left over need not be a possible one.

use crate::inertia::Sym3;
use crate::joint::{AxisMass, Vanishing};
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Pose, Vec3};
use crate::tree::{Body, Tree};

/// The tree with as much inertia as possible moved towards the ground.
pub fn base_parameters<P: Parameter>(tree: &Tree<P>, vanishing: Vanishing) -> Tree<P> {
    let mut tree = tree.clone();
    for index in (0..tree.bodies.len()).rev() {
        move_to_parent(&mut tree, index, vanishing);
    }
    tree
}

/// The sum, with nothing where only the roundoff of two terms is left.
fn sum<P: Parameter>(a: PseudoInertia<P>, b: PseudoInertia<P>) -> PseudoInertia<P> {
    let add = |a: P, b: P| match (a.number(), b.number(), (a + b).number()) {
        (Some(a), Some(b), Some(sum)) if sum.abs() < 8.0 * f64::EPSILON * a.abs().max(b.abs()) => P::zero(),
        _ => a + b,
    };
    let (s, t) = (a.second.full().0, b.second.full().0);
    let sum = PseudoInertia {
        mass: add(a.mass, b.mass),
        moment: Vec3::from_fn(|i| add(a.moment[i], b.moment[i])),
        second: Sym3::from_upper(|i, j| add(s[i][j], t[i][j])),
    };
    sum.without_roundoff()
}

/// Moves as much inertia of one body as possible to its parent.
pub fn move_to_parent<P: Parameter>(tree: &mut Tree<P>, index: usize, vanishing: Vanishing) {
    let body = &mut tree.bodies[index];
    let (own, shared) = body.joint.split(body.inertia, vanishing);
    body.inertia = own;
    let (parent, moved) = (body.parent, shared.transformed(Pose::constant(body.placement)));
    let carrier = match parent {
        Some(parent) => &mut tree.bodies[parent].inertia,
        None => &mut tree.ground,
    };
    *carrier = sum(*carrier, moved);
}

/// Takes mass on the axis of the joint of `body` from its parent and gives it to the body: the other way round from
/// [`base_parameters`], where that leaves fewer numbers to compute with. What the parent can no longer tell from its
/// own parent's moves on towards the ground.
pub fn take_from_parent<P: Parameter>(tree: &mut Tree<P>, body: usize, mass: AxisMass<P>) {
    let Body { parent, placement, .. } = tree.bodies[body];
    let Some(parent) = parent else { return };
    let minus = AxisMass { mass: -mass.mass, first: -mass.first, second: -mass.second };
    tree.bodies[parent].inertia =
        sum(tree.bodies[parent].inertia, minus.inertia().transformed(Pose::constant(placement)));
    tree.bodies[body].inertia = tree.bodies[body].inertia + mass.inertia();
    let mut at = Some(parent);
    while let Some(ancestor) = at {
        move_to_parent(tree, ancestor, Vanishing::SecondMomentZz);
        at = tree.bodies[ancestor].parent;
    }
}
