//! What acts in a joint itself: the inertia of its rotor, damping, friction and a spring.

use crate::parameter::{Parameter, ParameterIn, acting};
use redysim_runtime::Scalar;

/// The physics of a joint beside the bodies that it connects. Each of its numbers holds for every velocity of the
/// joint; with all of them zero, nothing acts.
///
/// The force that a motion takes in the joint is J a + d v + f v/√(v² + ε²) + k (q − q₀), with the armature J, the
/// damping d, the friction f, the friction velocity ε, the stiffness k and the rest q₀. It is part of the joint force
/// τ = M a + bias: the armature of M, the others of the bias.
///
/// Friction is smooth: at speeds far above ε it is Coulomb's, and it does not stick. A joint at rest under a load below
/// f creeps, at about ε times the load's share of f.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct JointPhysics<P = f64> {
    /// Reflected inertia of rotor and gears, kg m² or kg: that of the rotor times the square of the gear ratio.
    pub armature: P,
    /// Viscous damping, N m s/rad or N s/m.
    pub damping: P,
    /// Coulomb friction, N m or N.
    pub friction: P,
    /// The speed at which friction is 1/√2 of its limit, rad/s or m/s; positive.
    pub friction_velocity: P,
    /// Stiffness of the spring, N m/rad or N/m.
    pub stiffness: P,
    /// The coordinate at which the spring is relaxed, rad or m.
    pub rest: P,
}

/// The friction velocity of a joint whose model does not give it, rad/s or m/s.
pub(crate) const FRICTION_VELOCITY: f64 = 0.01;

impl<P: Scalar> Default for JointPhysics<P> {
    /// Nothing acts.
    fn default() -> Self {
        let zero = P::zero();
        JointPhysics {
            armature: zero,
            damping: zero,
            friction: zero,
            friction_velocity: P::from_f64(FRICTION_VELOCITY),
            stiffness: zero,
            rest: zero,
        }
    }
}

impl<P: Scalar> JointPhysics<P> {
    /// Applies `f` to each number.
    #[inline]
    pub fn map<Q>(self, f: impl Fn(P) -> Q) -> JointPhysics<Q> {
        let JointPhysics { armature, damping, friction, friction_velocity, stiffness, rest } = self;
        JointPhysics {
            armature: f(armature),
            damping: f(damping),
            friction: f(friction),
            friction_velocity: f(friction_velocity),
            stiffness: f(stiffness),
            rest: f(rest),
        }
    }
}

impl<P: Parameter> JointPhysics<P> {
    /// Whether one of its parts is not known to be zero.
    pub fn acts(&self) -> bool {
        let JointPhysics { armature, damping, friction, stiffness, .. } = *self;
        [armature, damping, friction, stiffness].into_iter().any(|part| part.number() != Some(0.0))
    }

    /// The armature; `None` if it is known to be zero.
    #[inline]
    pub fn armature<S: Scalar>(&self) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        acting(self.armature)
    }

    /// d v + f v/√(v² + ε²), which takes energy from the mechanism; `None` if it is known to be zero.
    #[inline]
    pub fn dissipative_force<S: Scalar>(&self, v: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        let damping = acting(self.damping).map(|damping: S| damping * v);
        let friction = acting(self.friction).map(|friction: S| {
            let smoothing: S = self.friction_velocity.value();
            friction * v / (v * v + smoothing * smoothing).sqrt()
        });
        sum([damping, friction])
    }

    /// d v + f v/√(v² + ε²) + k (q − q₀); `None` if it is known to be zero.
    #[inline]
    pub fn passive_force<S: Scalar>(&self, q: S, v: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        let spring = acting(self.stiffness).map(|stiffness: S| stiffness * (q - self.rest.value()));
        sum([self.dissipative_force(v), spring])
    }

    /// J a + d v + f v/√(v² + ε²) + k (q − q₀); `None` if it is known to be zero.
    #[inline]
    pub fn force<S: Scalar>(&self, q: S, v: S, a: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        sum([self.armature().map(|armature: S| armature * a), self.passive_force(q, v)])
    }

    /// Twice the energy of the spring, k (q − q₀)², J; `None` if it is known to be zero.
    #[inline]
    pub fn twice_spring_energy<S: Scalar>(&self, q: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        acting(self.stiffness).map(|stiffness: S| {
            let stretch = q - self.rest.value();
            stiffness * (stretch * stretch)
        })
    }
}

/// The sum of forces of which some may not act.
#[inline]
pub(crate) fn sum<S: Scalar>([a, b]: [Option<S>; 2]) -> Option<S> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (one, None) | (None, one) => one,
    }
}
