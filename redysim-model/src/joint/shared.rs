//! Inertia that a body and its parent can both carry.

use crate::inertia::Sym3;
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

/// Moments of mass on a joint's axis, about the body's origin: ∫1, ∫z and ∫z².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisMass {
    /// ∫1 dm, kg.
    pub mass: f64,
    /// ∫z dm, kg m.
    pub first: f64,
    /// ∫z² dm, kg m².
    pub second: f64,
}

impl AxisMass {
    /// As the inertia of a body.
    pub fn inertia(self) -> PseudoInertia<f64> {
        let AxisMass { mass, first, second } = self;
        PseudoInertia { mass, moment: Vec3([0.0, 0.0, first]), second: Sym3 { zz: second, ..Sym3::zero() } }
    }
}
