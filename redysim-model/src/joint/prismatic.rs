//! A joint that moves its body along z.

use super::{JointPosition, Screw};
use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::Vec3;
use redysim_runtime::Scalar;

pub const SCREW: Screw = Screw::translation(2);

/// The coordinate is the displacement.
#[inline]
pub fn position<S: Scalar>(q: S) -> JointPosition<S> {
    JointPosition::OnAxis { angle: None, displacement: Some(q) }
}

/// The body turns with its parent, so its second moments do not depend on the joint.
pub fn split<P: Parameter>(inertia: PseudoInertia<P>) -> (PseudoInertia<P>, PseudoInertia<P>) {
    let PseudoInertia { mass, moment, second } = inertia;
    let own = PseudoInertia { mass, moment, second: Sym3::zero() };
    (own, PseudoInertia { mass: P::zero(), moment: Vec3::zero(), second })
}

/// The mass.
pub fn meets(inertia: PseudoInertia<f64>) -> f64 {
    if inertia.mass > 0.0 { 1.0 } else { 0.0 }
}
