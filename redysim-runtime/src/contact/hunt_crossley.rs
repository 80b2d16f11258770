//! The law of contact of Hunt and Crossley.

use super::friction::regularised;
use super::{ContactError, ContactLaw, ContactRule, NormalForce};
use crate::Real;

/// The law of Hunt and Crossley with regularised Coulomb friction.
///
/// With the penetration p and the sliding velocity v in the plane, the forces are
///
/// N = k pⁿ (1 + d ṗ), but at least 0, and −μ N v/√(|v|² + ε²).
///
/// The damping fades with the penetration, so that the force begins and ends at zero, and it is never adhesive: where a
/// point leaves faster than 1/d, the ground does not follow it. A body of one mass that meets the ground at the speed u
/// leaves it with the coefficient of restitution e ≈ 1 − (2/3) d u while d u is small. n = 3/2 is the contact of spheres
/// after Hertz. Friction at a speed well below ε is a damper of μ N/ε, so that a body creeps on an inclined plane.
///
/// The energy stored is k pⁿ⁺¹/(n + 1). Source: K. H. Hunt and F. R. E. Crossley, *Coefficient of restitution interpreted
/// as damping in vibroimpact*, J. Appl. Mech. 42 (1975).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct HuntCrossleyContact<S> {
    /// k, N/mⁿ; positive.
    pub stiffness: S,
    /// n; 1 or more.
    pub exponent: S,
    /// d, s/m; zero or positive.
    pub damping: S,
    /// μ; zero or positive.
    pub friction: S,
    /// ε, m/s: the sliding speed at which friction has reached 1/√2 of Coulomb's force; positive.
    pub slip_velocity: S,
}

impl<S: Real> ContactLaw<S> for HuntCrossleyContact<S> {
    fn check(&self) -> Result<(), ContactError<S>> {
        ContactRule::Positive.check("stiffness", self.stiffness)?;
        ContactRule::AtLeastOne.check("exponent", self.exponent)?;
        ContactRule::NotNegative.check("damping", self.damping)?;
        ContactRule::NotNegative.check("friction", self.friction)?;
        ContactRule::Positive.check("slip_velocity", self.slip_velocity)
    }

    fn onset(&self) -> S {
        S::zero()
    }

    fn normal(&self, penetration: S, rate: S) -> NormalForce<S> {
        let depth = penetration.maximum(S::zero());
        let spring = self.stiffness * depth.powf(self.exponent);
        let force = (spring + spring * self.damping * rate).maximum(S::zero());
        NormalForce {
            force,
            energy: spring * depth / (self.exponent + S::one()),
            // What the spring gives up and the body does not receive: all of it where the ground does not follow.
            dissipated_power: (force - spring) * rate,
        }
    }

    fn friction(&self, normal: S, sliding: [S; 2]) -> [S; 2] {
        regularised(self.friction, normal, self.slip_velocity, sliding)
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    const RUBBER: HuntCrossleyContact<f64> =
        HuntCrossleyContact { stiffness: 2e5, exponent: 1.5, damping: 0.4, friction: 0.8, slip_velocity: 0.01 };

    #[test]
    fn the_force_is_that_of_the_formula_and_never_pulls() {
        let force = |p: f64, rate| RUBBER.normal(p, rate).force;
        assert!((force(0.04, 0.5) - 2e5 * 0.008 * 1.2).abs() < 1e-11);
        assert!((force(0.04, -0.5) - 2e5 * 0.008 * 0.8).abs() < 1e-11);
        assert_eq!([force(0.04, -2.6), force(0.0, 1.0), force(-0.01, 5.0)], [0.0; 3]);
        let stored = RUBBER.normal(0.04, 0.0).energy;
        assert!((stored - 2e5 * 0.008 * 0.04 / 2.5).abs() < 1e-12);
    }

    #[test]
    fn a_ground_that_does_not_follow_keeps_no_energy() {
        // N = 0, so that what is lost is the energy of the spring, at the rate k pⁿ |ṗ|.
        let lost = RUBBER.normal(0.04, -3.0).dissipated_power;
        assert!((lost - 2e5 * 0.008 * 3.0).abs() < 1e-10, "{lost}");
    }

    #[test]
    fn invalid_parameters_are_errors_with_name_and_value() {
        let error = HuntCrossleyContact { exponent: 0.5, ..RUBBER }.check().unwrap_err();
        assert_eq!(error.to_string(), "`exponent` of a contact must be 1 or more, and finite, but it is 0.5");
        for law in [
            HuntCrossleyContact { stiffness: 0.0, ..RUBBER },
            HuntCrossleyContact { damping: -0.1, ..RUBBER },
            HuntCrossleyContact { friction: f64::NAN, ..RUBBER },
            HuntCrossleyContact { slip_velocity: 0.0, ..RUBBER },
        ] {
            assert!(law.check().is_err(), "{law:?}");
        }
    }
}
