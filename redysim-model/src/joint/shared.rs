//! Inertia that a body and its parent can both carry.

use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::Vec3;

/// Which number is made zero by the freedom to move an inertia diag(1, 1, 0) across a joint that turns about z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Vanishing {
    /// J_yy, so that J_xx − J_yy is left for J_xx: few terms in ωᵀ J ω.
    TensorYy,
    /// Σ_zz = ½ (J_xx + J_yy − J_zz): few terms in U Σ.
    SecondMomentZz,
}

impl Vanishing {
    /// The Σ_zz with which the number vanishes, of a body with the given second moments.
    pub(super) fn second_zz<P: Parameter>(self, second: Sym3<P>) -> P {
        match self {
            // J_yy is Σ_zz + Σ_xx.
            Vanishing::TensorYy => -second.xx,
            Vanishing::SecondMomentZz => P::zero(),
        }
    }
}

/// Moments of mass on a joint's axis, about the body's origin: ∫1, ∫z and ∫z².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisMass<P = f64> {
    /// ∫1 dm, kg.
    pub mass: P,
    /// ∫z dm, kg m.
    pub first: P,
    /// ∫z² dm, kg m².
    pub second: P,
}

impl<P: Parameter> AxisMass<P> {
    /// No mass.
    pub fn zero() -> Self {
        AxisMass { mass: P::zero(), first: P::zero(), second: P::zero() }
    }

    /// As the inertia of a body.
    pub fn inertia(self) -> PseudoInertia<P> {
        let AxisMass { mass, first, second } = self;
        PseudoInertia { mass, moment: Vec3([P::zero(), P::zero(), first]), second: Sym3 { zz: second, ..Sym3::zero() } }
    }
}
