//! ReDySim's law of contact.

use super::friction::by_arctangent;
use super::{ContactError, ContactLaw, ContactRule, NormalForce};
use crate::Real;

/// The penetration below which ReDySim's ground does not act, m.
const ONSET: f64 = 1e-5;
/// ReDySim's margin for the depth at which the damping has faded in.
const MARGIN: f64 = 1.2;

/// ReDySim's law of contact: a linear spring, and a damper that is as strong on the way in at any depth but fades on
/// the way out.
///
/// With the penetration p and the velocity v along the outward normal, the normal force at p ≥ p₀ = 10⁻⁵ m is
///
/// N = K p − c v,  c = C_v, but where v > 0 and p ≤ z_l = 1.2 v_max C_v/K: c = C_v (3 s² − 2 s³), s = p/z_l,
///
/// and 0 above. The cubic has c(z_l) = C_v and c′(z_l) = 0. The friction force along each of the two tangential
/// directions of the ground is
///
/// −(2/π) μ |N| atan(C_h v_t/((2/π) μ |N|)).
///
/// On the way in N is positive. On the way out it pulls nowhere as long as v < 16/15 v_max: there K p = 1.2 v_max C_v s
/// is larger than c v, since 3 s − 2 s² ≤ 9/8, and deeper than z_l, K p > 1.2 v_max C_v. At a larger speed the law itself
/// is adhesive at some depths, and it is kept as it is, so that results are those of ReDySim: choose v_max at or above
/// the speeds at which feet leave the ground. [`HuntCrossleyContact`](super::HuntCrossleyContact) never pulls.
///
/// At touch-down with the speed u, the force jumps from 0 to C_v u, and friction is that of each direction by itself, so
/// that a diagonal sliding motion may have up to √2 μ |N|.
///
/// The energy stored is K (p² − p₀²)/2. Source: the ground model of the legged examples of ReDySim (S. V. Shah, P. V.
/// Nandihal and S. K. Saha, *Theor. Appl. Mech. Lett.* 2, 063011, 2012), whose `g_prop` is [K, C_v, v_max, μ, C_h, …]; there
/// C_v = 20 √(K Σm).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct ReDySimContact<S> {
    /// K, N/m; positive.
    pub stiffness: S,
    /// C_v, N s/m; zero or positive.
    pub damping: S,
    /// v_max, m/s: the speed up to which a point that leaves the ground is not held back; positive.
    pub leaving_speed: S,
    /// μ; zero or positive.
    pub friction: S,
    /// C_h, N s/m: the friction at small speeds, as a damper; zero or positive.
    pub sliding_damping: S,
}

impl<S: Real> ReDySimContact<S> {
    /// z_l, m: the penetration at which the damping on the way out is that on the way in.
    pub fn fading_depth(&self) -> S {
        S::from_f64(MARGIN) * self.leaving_speed * self.damping / self.stiffness
    }

    /// c, N s/m, at a penetration and a velocity along the outward normal.
    fn damping_at(&self, penetration: S, velocity: S) -> S {
        let depth = self.fading_depth();
        if velocity <= S::zero() || penetration > depth || depth == S::zero() {
            return self.damping;
        }
        let share = penetration / depth;
        self.damping * share * share * (S::from_f64(3.0) - share - share)
    }
}

impl<S: Real> ContactLaw<S> for ReDySimContact<S> {
    fn check(&self) -> Result<(), ContactError<S>> {
        ContactRule::Positive.check("stiffness", self.stiffness)?;
        ContactRule::NotNegative.check("damping", self.damping)?;
        ContactRule::Positive.check("leaving_speed", self.leaving_speed)?;
        ContactRule::NotNegative.check("friction", self.friction)?;
        ContactRule::NotNegative.check("sliding_damping", self.sliding_damping)
    }

    fn onset(&self) -> S {
        S::from_f64(ONSET)
    }

    fn normal(&self, penetration: S, rate: S) -> NormalForce<S> {
        let onset: S = self.onset();
        let damping = self.damping_at(penetration, -rate);
        NormalForce {
            force: self.stiffness * penetration + damping * rate,
            energy: S::from_f64(0.5) * self.stiffness * (penetration - onset) * (penetration + onset),
            dissipated_power: damping * rate * rate,
        }
    }

    fn friction(&self, normal: S, sliding: [S; 2]) -> [S; 2] {
        sliding.map(|velocity| by_arctangent(self.friction, normal, self.sliding_damping, velocity))
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    const QUADRUPED: ReDySimContact<f64> = ReDySimContact {
        stiffness: 2500.0,
        damping: 3464.1016151377544,
        leaving_speed: 4.5,
        friction: 0.7,
        sliding_damping: 1500.0,
    };

    #[test]
    fn the_force_is_that_of_the_formula() {
        let depth = 1.2 * 4.5 * 3464.1016151377544 / 2500.0;
        assert_eq!(QUADRUPED.fading_depth(), depth);
        let force = |p, v: f64| QUADRUPED.normal(p, -v).force;
        assert_eq!(force(0.01, -0.2), 25.0 + 0.2 * 3464.1016151377544);
        assert_eq!(force(0.01, 0.0), 25.0);
        // a₃ and a₄ of c = a₄ p³ + a₃ p², from c(z_l) = C_v and c′(z_l) = 0.
        let (a3, a4) = (3.0 * 3464.1016151377544 / depth.powi(2), -2.0 * 3464.1016151377544 / depth.powi(3));
        for p in [1e-5_f64, 0.01, 1.0, 7.0] {
            let c = a4 * p.powi(3) + a3 * p.powi(2);
            assert!((force(p, 0.3) - (2500.0 * p - c * 0.3)).abs() < 1e-11 * 2500.0 * p, "{p}");
        }
        assert_eq!(force(8.0, 0.3), 2500.0 * 8.0 - 3464.1016151377544 * 0.3);
    }

    #[test]
    fn the_damping_and_its_slope_are_continuous_where_it_has_faded_in() {
        let (depth, step) = (QUADRUPED.fading_depth(), 1e-5);
        let at = |p| QUADRUPED.damping_at(p, 1.0);
        assert!((at(depth) - QUADRUPED.damping).abs() < 1e-11);
        // The slope grows from 0 by c″ = −6 C_v/z_l² times the step.
        let slope = (at(depth) - at(depth - step)) / step;
        assert!(slope.abs() < 6.0 * QUADRUPED.damping / depth.powi(2) * step, "{slope}");
        assert_eq!(at(depth + step), QUADRUPED.damping);
        assert_eq!(at(0.0), 0.0);
    }

    #[test]
    fn feet_are_never_held_back_below_sixteen_fifteenths_of_the_leaving_speed() {
        let smallest = |speed: f64| {
            let forces = (1..=4000).map(|k| QUADRUPED.normal(f64::from(k) * 0.0025, -speed).force);
            forces.fold(f64::INFINITY, f64::min)
        };
        assert!(smallest(0.999 * 4.5 * 16.0 / 15.0) > 0.0);
        assert!(smallest(1.001 * 4.5 * 16.0 / 15.0) < 0.0);
    }

    #[test]
    fn invalid_parameters_are_errors_with_name_and_value() {
        let error = ReDySimContact { leaving_speed: 0.0, ..QUADRUPED }.check().unwrap_err();
        let expected = "`leaving_speed` of a contact must be positive and finite, but it is 0.0";
        assert_eq!(error.to_string(), expected);
        for law in [
            ReDySimContact { stiffness: f64::NAN, ..QUADRUPED },
            ReDySimContact { damping: -1.0, ..QUADRUPED },
            ReDySimContact { friction: -0.1, ..QUADRUPED },
            ReDySimContact { sliding_damping: f64::INFINITY, ..QUADRUPED },
        ] {
            assert!(law.check().is_err(), "{law:?}");
        }
        assert_eq!(ReDySimContact { damping: 0.0, friction: 0.0, ..QUADRUPED }.check(), Ok(()));
    }
}
