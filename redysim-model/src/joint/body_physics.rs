//! What acts in a joint of the tree, as the recursions need it.

use super::stretch::Stretch;
use super::{FRICTION_VELOCITY, Joint, JointPhysics, LinkJoint, MOST_FREEDOMS};
use crate::parameter::{Parameter, ParameterIn, acting};
use redysim_runtime::Scalar;
use std::ops::Range;

/// What acts on one velocity of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VelocityPhysics<P = f64> {
    /// Reflected inertia of the rotor, kg m² or kg.
    pub armature: P,
    /// Viscous damping, N m s/rad or N s/m.
    pub damping: P,
    /// Coulomb friction, N m or N.
    pub friction: P,
    /// The speed at which friction is 1/√2 of its limit, rad/s or m/s.
    pub friction_velocity: P,
    /// Stiffness of the spring, N m/rad or N/m.
    pub stiffness: P,
}

/// What acts in a joint: a [`JointPhysics`] with a number for each velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPhysics<P = f64> {
    /// On each velocity of the joint.
    pub velocities: Vec<VelocityPhysics<P>>,
    /// The coordinates at which the springs are relaxed.
    pub rest: Vec<P>,
}

/// A force for each velocity of a joint; `None` where it is known to be zero.
pub(crate) type Forces<S> = [Option<S>; MOST_FREEDOMS];

impl<P: Copy> BodyPhysics<P> {
    /// Applies `f` to each number.
    pub fn map<Q>(&self, f: impl Fn(P) -> Q) -> BodyPhysics<Q> {
        let velocity = |each: &VelocityPhysics<P>| VelocityPhysics {
            armature: f(each.armature),
            damping: f(each.damping),
            friction: f(each.friction),
            friction_velocity: f(each.friction_velocity),
            stiffness: f(each.stiffness),
        };
        BodyPhysics {
            velocities: self.velocities.iter().map(velocity).collect(),
            rest: self.rest.iter().map(|&rest| f(rest)).collect(),
        }
    }
}

impl<P: Parameter> BodyPhysics<P> {
    /// For a body without a joint: no forces.
    pub(crate) fn none() -> Self {
        BodyPhysics { velocities: Vec::new(), rest: Vec::new() }
    }

    /// What acts in the joint of a link.
    pub fn new(physics: &JointPhysics, joint: LinkJoint) -> Self {
        let [armature, damping, friction, stiffness] =
            [&physics.armature, &physics.damping, &physics.friction, &physics.stiffness]
                .map(|each| each.of_velocities(joint.nv(), 0.0));
        let friction_velocity = physics.friction_velocity.of_velocities(joint.nv(), FRICTION_VELOCITY);
        let of_velocity = |i: usize| VelocityPhysics {
            armature: P::from_f64(armature[i]),
            damping: P::from_f64(damping[i]),
            friction: P::from_f64(friction[i]),
            friction_velocity: P::from_f64(friction_velocity[i]),
            stiffness: P::from_f64(stiffness[i]),
        };
        BodyPhysics {
            velocities: (0..joint.nv()).map(of_velocity).collect(),
            rest: physics.rest_of(joint).into_iter().map(P::from_f64).collect(),
        }
    }

    /// That of a joint which has the coordinates `q` and the velocities `v` of this one.
    pub(crate) fn part(&self, q: Range<usize>, v: Range<usize>) -> Self {
        BodyPhysics { velocities: self.velocities[v].to_vec(), rest: self.rest[q].to_vec() }
    }

    /// Whether one of its parts is not known to be zero.
    pub fn acts(&self) -> bool {
        let parts = |each: &VelocityPhysics<P>| [each.armature, each.damping, each.friction, each.stiffness];
        self.velocities.iter().flat_map(parts).any(|part| part.number() != Some(0.0))
    }

    /// The armature of a velocity; `None` if it is known to be zero.
    #[inline]
    pub fn armature<S: Scalar>(&self, velocity: usize) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        acting(self.velocities[velocity].armature)
    }

    /// d v + f v/√(v² + ε²) of a velocity, which takes energy from the mechanism; `None` if it is known to be zero.
    #[inline]
    pub fn dissipative_force<S: Scalar>(&self, velocity: usize, v: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        let VelocityPhysics { damping, friction, friction_velocity, .. } = self.velocities[velocity];
        let damping = acting(damping).map(|damping: S| damping * v);
        let friction = acting(friction).map(|friction: S| {
            let smoothing: S = friction_velocity.value();
            friction * v / (v * v + smoothing * smoothing).sqrt()
        });
        sum([damping, friction])
    }

    /// d v + f v/√(v² + ε²) and the force against the springs, for each velocity of the joint.
    #[inline]
    pub(crate) fn passive_forces<S: Scalar>(&self, joint: Joint, q: &[S], v: &[S]) -> Forces<S>
    where
        P: ParameterIn<S>,
    {
        let mut springs = self.spring_forces(joint, q);
        for ((velocity, &v), spring) in v.iter().enumerate().zip(&mut springs) {
            *spring = sum([self.dissipative_force(velocity, v), *spring]);
        }
        springs
    }

    /// J a, for each velocity of the joint.
    #[inline]
    pub(crate) fn rotor_forces<S: Scalar>(&self, a: &[S]) -> Forces<S>
    where
        P: ParameterIn<S>,
    {
        let mut forces = [None; MOST_FREEDOMS];
        for ((velocity, &a), force) in a.iter().enumerate().zip(&mut forces) {
            *force = self.armature(velocity).map(|armature: S| armature * a);
        }
        forces
    }

    /// J a and the [passive forces](Self::passive_forces), for each velocity of the joint.
    #[inline]
    pub(crate) fn forces<S: Scalar>(&self, joint: Joint, q: &[S], v: &[S], a: &[S]) -> Forces<S>
    where
        P: ParameterIn<S>,
    {
        let mut forces = self.rotor_forces(a);
        for (force, passive) in forces.iter_mut().zip(self.passive_forces(joint, q, v)) {
            *force = sum([*force, passive]);
        }
        forces
    }

    /// Twice the energy of the springs, Σ k e², J; `None` if it is known to be zero.
    #[inline]
    pub fn twice_spring_energy<S: Scalar>(&self, joint: Joint, q: &[S]) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        let (stretch, stiffness) = self.stretch(joint, q)?;
        let energies = stiffness.into_iter().enumerate().filter_map(|(velocity, stiffness)| {
            let stiffness = stiffness?;
            let stretch = stretch.component(velocity);
            Some(stiffness * (stretch * stretch))
        });
        energies.reduce(|sum, energy| sum + energy)
    }

    /// The force against the springs.
    #[inline]
    fn spring_forces<S: Scalar>(&self, joint: Joint, q: &[S]) -> Forces<S>
    where
        P: ParameterIn<S>,
    {
        let Some((stretch, mut loads)) = self.stretch(joint, q) else { return [None; MOST_FREEDOMS] };
        for (velocity, load) in loads.iter_mut().enumerate() {
            *load = load.map(|stiffness| stiffness * stretch.component(velocity));
        }
        stretch.forces(loads, self.is_isotropic())
    }

    /// How far the joint is from where its springs are relaxed, and their stiffness; `None` without springs.
    #[inline]
    fn stretch<S: Scalar>(&self, joint: Joint, q: &[S]) -> Option<(Stretch<S>, Forces<S>)>
    where
        P: ParameterIn<S>,
    {
        let mut stiffness = [None; MOST_FREEDOMS];
        for (stiffness, each) in stiffness.iter_mut().zip(&self.velocities) {
            *stiffness = acting(each.stiffness);
        }
        if stiffness.iter().all(Option::is_none) {
            return None;
        }
        let mut rest = [S::zero(); MOST_COORDINATES];
        rest.iter_mut().zip(&self.rest).for_each(|(rest, given)| *rest = given.value());
        Some((joint.stretch(q, &rest), stiffness))
    }

    /// Whether the stiffness of the last three velocities, those of a rotation, is known to be the same.
    fn is_isotropic(&self) -> bool {
        let mut rotation = self.velocities.iter().rev().take(3).map(|each| each.stiffness.number());
        let last = rotation.next().flatten();
        last.is_some() && rotation.all(|stiffness| stiffness == last)
    }
}

/// The most coordinates of a joint.
const MOST_COORDINATES: usize = MOST_FREEDOMS + 1;

/// The sum of forces of which some may not act.
#[inline]
pub(crate) fn sum<S: Scalar>([a, b]: [Option<S>; 2]) -> Option<S> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (one, None) | (None, one) => one,
    }
}
