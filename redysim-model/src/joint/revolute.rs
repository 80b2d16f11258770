//! A joint that turns its body about z.

use super::{AxisMass, JointPosition, Screw, Vanishing};
use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::Vec3;
use redysim_runtime::Scalar;

pub const SCREW: Screw = Screw::rotation(2);

/// The coordinate is the angle.
#[inline]
pub fn position<S: Scalar>(q: S) -> JointPosition<S> {
    JointPosition::OnAxis { angle: Some(q), displacement: None }
}

/// Mass on the axis belongs to both bodies.
pub fn split<P: Parameter>(inertia: PseudoInertia<P>, vanishing: Vanishing) -> (PseudoInertia<P>, PseudoInertia<P>) {
    let PseudoInertia { mass, moment, second } = inertia;
    let left = vanishing.second_zz(second);
    let own = PseudoInertia {
        mass: P::zero(),
        moment: Vec3([moment[0], moment[1], P::zero()]),
        second: Sym3 { zz: left, ..second },
    };
    (own, AxisMass { mass, first: moment[2], second: second.zz - left }.inertia())
}

/// The moment of inertia about the axis.
pub fn meets(inertia: PseudoInertia<f64>) -> f64 {
    let Sym3 { xx, yy, zz, .. } = inertia.second;
    let moment = xx + yy;
    if moment > 0.0 { moment / (moment + 2.0 * zz) } else { 0.0 }
}
