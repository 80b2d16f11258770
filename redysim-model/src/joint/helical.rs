//! A joint that turns its body about z and moves it along in proportion, as a screw does.

use super::{AxisMass, JointPosition, Screw, Vanishing};
use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use redysim_runtime::Scalar;

#[inline]
pub fn screw(pitch: f64) -> Screw {
    Screw { axis: 2, turn: 1.0, slide: pitch }
}

/// The coordinate is the angle.
#[inline]
pub fn position<S: Scalar>(pitch: f64, q: S) -> JointPosition<S> {
    JointPosition::OnAxis { angle: Some(q), displacement: screw(pitch).slide(q) }
}

/// Mass on the axis moves along it, so of what a revolute joint shares the second moment alone is left.
pub fn split<P: Parameter>(inertia: PseudoInertia<P>, vanishing: Vanishing) -> (PseudoInertia<P>, PseudoInertia<P>) {
    let PseudoInertia { second, .. } = inertia;
    let left = vanishing.second_zz(second);
    let own = PseudoInertia { second: Sym3 { zz: left, ..second }, ..inertia };
    (own, AxisMass { second: second.zz - left, ..AxisMass::zero() }.inertia())
}

/// The moment of inertia about the axis, and the mass along it.
pub fn meets(pitch: f64, inertia: PseudoInertia<f64>) -> f64 {
    let Sym3 { xx, yy, zz, .. } = inertia.second;
    let resisting = xx + yy + inertia.mass * pitch * pitch;
    if resisting > 0.0 { resisting / (resisting + 2.0 * zz) } else { 0.0 }
}
