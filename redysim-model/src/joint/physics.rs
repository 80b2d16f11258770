//! What acts in a joint itself: the inertia of its rotors, damping, friction and springs.

use super::LinkJoint;
use crate::per_velocity::PerVelocity;

/// The physics of a joint beside the bodies that it connects. With all of its numbers zero, nothing acts.
///
/// The force that a motion takes in the joint is J a + d v + f v/√(v² + ε²) for each velocity, with the armature J, the
/// damping d, the friction f and the friction velocity ε, and with the force of the springs. It is part of the joint force
/// τ = M a + bias: the armature of M, the others of the bias.
///
/// Springs of stiffness k have the energy ½ Σ k e², with the displacement e from where they are relaxed. Where velocities
/// are the rates of coordinates q, e is q − q₀ and the force k (q − q₀), with the rest q₀. The others are the rotation
/// vector from the link's axes at rest to its axes, at most half a turn, and for a free joint before it the displacement
/// of the link's origin, in its axes at rest; the force is the gradient of the energy, for rotations of one stiffness
/// k e.
///
/// The armature is that of a rotor for each velocity, geared to that velocity, as in MuJoCo: the rotors turn against the
/// parent, have the energy ½ Σ J v², and have no bias force, also where velocities are those of a frame that turns.
///
/// Friction is smooth: at speeds far above ε it is Coulomb's, and it does not stick. A joint at rest under a load below
/// f creeps, at about ε times the load's share of f.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct JointPhysics {
    /// Reflected inertia of rotor and gears, kg m² or kg: that of the rotor times the square of the gear ratio.
    pub armature: PerVelocity<f64>,
    /// Viscous damping, N m s/rad or N s/m.
    pub damping: PerVelocity<f64>,
    /// Coulomb friction, N m or N.
    pub friction: PerVelocity<f64>,
    /// The speed at which friction is 1/√2 of its limit, rad/s or m/s; positive.
    pub friction_velocity: PerVelocity<f64>,
    /// Stiffness of the springs, N m/rad or N/m.
    pub stiffness: PerVelocity<f64>,
    /// The coordinates at which the springs are relaxed; empty for the zero position.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "crate::serde::coordinates"))]
    pub rest: Vec<f64>,
}

/// The friction velocity of a joint whose model does not give it, rad/s or m/s.
pub(crate) const FRICTION_VELOCITY: f64 = 0.01;

impl Default for JointPhysics {
    /// Nothing acts.
    fn default() -> Self {
        JointPhysics {
            armature: 0.0.into(),
            damping: 0.0.into(),
            friction: 0.0.into(),
            friction_velocity: FRICTION_VELOCITY.into(),
            stiffness: 0.0.into(),
            rest: Vec::new(),
        }
    }
}

impl JointPhysics {
    /// The coordinates of a joint at which its springs are relaxed.
    pub fn rest_of(&self, joint: LinkJoint) -> Vec<f64> {
        let mut rest = vec![0.0; joint.nq()];
        joint.neutral(&mut rest);
        rest.iter_mut().zip(&self.rest).for_each(|(rest, given)| *rest = *given);
        rest
    }
}
