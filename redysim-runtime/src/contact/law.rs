//! What a law of contact is.

use super::{ContactError, HuntCrossleyContact, ReDySimContact};
use crate::Real;

/// The law of the force between a frame and the ground.
///
/// The force may depend on the penetration p, its rate ṗ and the sliding velocity. The laws of the crate are
/// [`ReDySimContact`] and [`HuntCrossleyContact`].
pub trait ContactLaw<S: Real> {
    /// Checks the parameters.
    ///
    /// # Errors
    /// The first that is invalid.
    fn check(&self) -> Result<(), ContactError<S>>;

    /// The penetration at which frame and ground begin to touch, m, zero or above.
    fn onset(&self) -> S;

    /// The normal force at the penetration p, m, and its rate ṗ, m/s, positive on the way into the ground.
    ///
    /// It is asked for at p ≥ [`onset`](Self::onset) and, while an integration looks for the lift-off, at smaller p,
    /// to which it should go on smoothly.
    fn normal(&self, penetration: S, rate: S) -> NormalForce<S>;

    /// The forces along the two tangential directions, N, at the normal force `normal`, N, and the velocities `sliding`
    /// along them, m/s.
    fn friction(&self, normal: S, sliding: [S; 2]) -> [S; 2];
}

/// The force of the ground along its normal. Force, energy U and dissipated power P agree: N ṗ = dU/dt + P.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct NormalForce<S> {
    /// N, the force on the mechanism along the outward normal, N.
    pub force: S,
    /// U, the elastic energy that is stored, J.
    pub energy: S,
    /// P, the power that damping takes, W.
    pub dissipated_power: S,
}

/// One of the laws of the crate, for lists of contacts with different laws.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum AnyContactLaw<S> {
    /// ReDySim's law.
    ReDySim(ReDySimContact<S>),
    /// The law of Hunt and Crossley.
    HuntCrossley(HuntCrossleyContact<S>),
}

impl<S: Real> ContactLaw<S> for AnyContactLaw<S> {
    fn check(&self) -> Result<(), ContactError<S>> {
        match self {
            Self::ReDySim(law) => law.check(),
            Self::HuntCrossley(law) => law.check(),
        }
    }

    fn onset(&self) -> S {
        match self {
            Self::ReDySim(law) => law.onset(),
            Self::HuntCrossley(law) => law.onset(),
        }
    }

    fn normal(&self, penetration: S, rate: S) -> NormalForce<S> {
        match self {
            Self::ReDySim(law) => law.normal(penetration, rate),
            Self::HuntCrossley(law) => law.normal(penetration, rate),
        }
    }

    fn friction(&self, normal: S, sliding: [S; 2]) -> [S; 2] {
        match self {
            Self::ReDySim(law) => law.friction(normal, sliding),
            Self::HuntCrossley(law) => law.friction(normal, sliding),
        }
    }
}
