//! Another unit of length, in which a constant of the mechanism becomes 1.
//!
//! With lengths in a unit L and masses in a unit 1/L², moments of inertia, energies and the forces of joints that turn
//! are the same numbers as in m and kg, so nothing has to be converted on the way in or out; but a length L, a mass
//! 1/L² or a first moment 1/L is 1, and multiplies nothing.

use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::roundoff::exact_one;
use crate::tree::Tree;

/// The tree in the unit of length `unit`, m; `None` if a joint moves along its axis, whose coordinate is a length.
pub fn in_unit<P: Parameter>(tree: &Tree<P>, unit: f64) -> Option<Tree<P>> {
    let mut tree = tree.clone();
    tree.gravity = tree.gravity.scale(P::from_f64(1.0 / unit));
    tree.ground = scaled(tree.ground, unit);
    for body in &mut tree.bodies {
        body.joint = body.joint.in_unit(unit)?;
        body.placement.position.0 = body.placement.position.0.map(|length| exact_one(length / unit));
        body.inertia = scaled(body.inertia, unit);
    }
    for spring in &mut tree.springs {
        *spring = spring.in_unit(unit);
    }
    Some(tree)
}

fn scaled<P: Parameter>(inertia: PseudoInertia<P>, unit: f64) -> PseudoInertia<P> {
    let PseudoInertia { mass, moment, second } = inertia;
    let times = |value: P, factor: f64| {
        let product = value * P::from_f64(factor);
        product.number().map_or(product, |number| P::from_f64(exact_one(number)))
    };
    PseudoInertia { mass: times(mass, unit * unit), moment: moment.map(|moment| times(moment, unit)), second }
}
