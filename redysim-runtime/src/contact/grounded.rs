//! A mechanism with contacts.

use core::fmt;

use super::{Contact, ContactError, ContactLaw, Reaction};
use crate::vector::entry;
use crate::wrapper::{coordinates_of, names_and_sizes_of};
use crate::{
    Arguments, BiasForces, ConfigurationSpace, Energy, ForwardDynamics, FrameState, Frames, HybridDynamics,
    HybridMotion, InverseDynamics, LoopClosure, LoopRows, MassMatrix, MechanicalEnergy, Mechanism, Real, Vector,
    Wrench,
};

/// A mechanism whose frames meet the ground: a mechanism itself, with the contact forces among those that act on it.
///
/// A simulation takes it in the place of the mechanism, whatever the torque law, which may know the bare mechanism:
///
/// M a + C v + g + passive forces − Σ Jᵀ f = τ,
///
/// where f are the forces of the ground at the frames and J are the Jacobians of their origins. The energy of the ground is
/// part of the potential [`energy`](MechanicalEnergy::energy), and what its damping and friction take is part of the
/// [dissipated power](ConfigurationSpace::dissipated_power), so that kinetic and potential energy less E_act of a
/// [`ForwardSimulation`](crate::ForwardSimulation) are constant.
///
/// [`run`](Self::run) integrates from touch-down to lift-off to touch-down. An [`Integrator`](crate::Integrator) by
/// itself moves it as well, but steps from tolerances then become small where the force begins.
pub struct Grounded<'m, S, M, L> {
    mechanism: &'m M,
    contacts: &'m [Contact<S, L>],
}

impl<S, M, L> Clone for Grounded<'_, S, M, L> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S, M, L> Copy for Grounded<'_, S, M, L> {}

impl<S: fmt::Debug, M: Mechanism, L: fmt::Debug> fmt::Debug for Grounded<'_, S, M, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { mechanism, contacts } = self;
        f.debug_struct("Grounded").field("mechanism", &mechanism.name()).field("contacts", contacts).finish()
    }
}

impl<'m, S: Real, M: Frames<S>, L: ContactLaw<S>> Grounded<'m, S, M, L> {
    /// `mechanism` with `contacts`, any number, several of one frame if need be.
    ///
    /// # Errors
    /// The first contact of a frame that the mechanism does not have.
    pub fn new(mechanism: &'m M, contacts: &'m [Contact<S, L>]) -> Result<Self, ContactError<S>> {
        let frames = mechanism.nf();
        let unknown = contacts.iter().enumerate().find(|(_, contact)| contact.frame >= frames);
        match unknown {
            Some((index, contact)) => Err(ContactError::UnknownFrame { contact: index, frame: contact.frame, frames }),
            None => Ok(Self { mechanism, contacts }),
        }
    }

    /// The mechanism without the ground.
    pub fn mechanism(&self) -> &'m M {
        self.mechanism
    }

    /// The contacts.
    pub fn contacts(&self) -> &'m [Contact<S, L>] {
        self.contacts
    }

    /// Calls `see` with each contact and the state of its frame, in order.
    pub(super) fn each(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
        mut see: impl FnMut(&Contact<S, L>, &FrameState<S>),
    ) {
        if self.contacts.is_empty() {
            return;
        }
        let states = self.mechanism.frame_kinematics(q, v);
        for contact in self.contacts {
            if let Some(state) = states.as_ref().get(contact.frame) {
                see(contact, state);
            }
        }
    }

    /// Calls `see` with each contact and what the ground does there, in order.
    pub fn reactions(&self, q: &M::Coordinates, v: &M::Velocities, mut see: impl FnMut(&Contact<S, L>, &Reaction<S>)) {
        self.each(q, v, |contact, state| see(contact, &contact.reaction(state)));
    }

    /// The elastic energy that is stored in the ground, J.
    pub fn ground_energy(&self, q: &M::Coordinates, v: &M::Velocities) -> S {
        let mut sum = S::zero();
        self.reactions(q, v, |_, reaction| sum += reaction.energy);
        sum
    }

    /// The power that damping and friction of the ground take, W.
    pub fn ground_power(&self, q: &M::Coordinates, v: &M::Velocities) -> S {
        let mut sum = S::zero();
        self.reactions(q, v, |_, reaction| sum += reaction.dissipated_power);
        sum
    }

    /// Σ Jᵀ f, N m or N: the joint forces of the ground.
    pub fn ground_forces(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let mut wrenches =
            M::Wrenches::from_fn(self.mechanism.nf(), |_| Wrench { force: [S::zero(); 3], moment: [S::zero(); 3] });
        self.reactions(q, v, |contact, reaction| {
            if let Some(wrench) = wrenches.as_mut().get_mut(contact.frame) {
                for (sum, component) in wrench.force.iter_mut().zip(reaction.force) {
                    *sum += component;
                }
            }
        });
        self.mechanism.frame_forces(q, &wrenches)
    }

    /// `forces` and `factor` times those of the ground.
    fn with_ground(&self, q: &M::Coordinates, v: &M::Velocities, factor: S, forces: &M::Velocities) -> M::Velocities {
        if self.contacts.is_empty() {
            return forces.clone();
        }
        let ground = self.ground_forces(q, v);
        M::Velocities::from_fn(self.mechanism.nv(), |i| entry(forces, i) + factor * entry(&ground, i))
    }
}

impl<S, M: Mechanism, L> Mechanism for Grounded<'_, S, M, L> {
    names_and_sizes_of!(mechanism);
}

impl<S: Real, M: Frames<S>, L: ContactLaw<S>> ConfigurationSpace<S> for Grounded<'_, S, M, L> {
    coordinates_of!(mechanism);

    /// Of the mechanism and of the ground.
    fn dissipated_power(&self, q: &Self::Coordinates, v: &Self::Velocities) -> S {
        self.mechanism.dissipated_power(q, v) + self.ground_power(q, v)
    }
}

impl<S: Real, M: Frames<S> + ForwardDynamics<S>, L: ContactLaw<S>> ForwardDynamics<S> for Grounded<'_, S, M, L> {
    fn forward_dynamics(
        &self,
        q: &Self::Coordinates,
        v: &Self::Velocities,
        tau: &Self::Velocities,
    ) -> Self::Velocities {
        self.mechanism.forward_dynamics(q, v, &self.with_ground(q, v, S::one(), tau))
    }

    /// That of the mechanism without contacts; with contacts, it is left to differences.
    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        if self.contacts.is_empty() { self.mechanism.forward_dynamics_tangent(at, slopes) } else { None }
    }
}

impl<S: Real, M: Frames<S> + InverseDynamics<S>, L: ContactLaw<S>> InverseDynamics<S> for Grounded<'_, S, M, L> {
    fn inverse_dynamics(&self, q: &Self::Coordinates, v: &Self::Velocities, a: &Self::Velocities) -> Self::Velocities {
        self.with_ground(q, v, -S::one(), &self.mechanism.inverse_dynamics(q, v, a))
    }
}

impl<S: Real, M: Frames<S> + HybridDynamics<S>, L: ContactLaw<S>> HybridDynamics<S> for Grounded<'_, S, M, L> {
    fn hybrid_dynamics(
        &self,
        q: &Self::Coordinates,
        v: &Self::Velocities,
        u: &Self::Velocities,
    ) -> HybridMotion<Self::Velocities> {
        let mechanism = self.mechanism;
        if self.contacts.is_empty() {
            return mechanism.hybrid_dynamics(q, v, u);
        }
        let ground = self.ground_forces(q, v);
        // What is given of a joint without an actuator is a force, to which that of the ground comes.
        let given = |i: usize| entry(u, i) + if mechanism.is_actuated(i) { S::zero() } else { entry(&ground, i) };
        let HybridMotion { a, tau } = mechanism.hybrid_dynamics(q, v, &M::Velocities::from_fn(mechanism.nv(), given));
        let tau = M::Velocities::from_fn(mechanism.nv(), |i| entry(&tau, i) - entry(&ground, i));
        HybridMotion { a, tau }
    }
}

impl<S: Real, M: Frames<S> + BiasForces<S>, L: ContactLaw<S>> BiasForces<S> for Grounded<'_, S, M, L> {
    fn bias_forces(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Velocities {
        self.with_ground(q, v, -S::one(), &self.mechanism.bias_forces(q, v))
    }
}

impl<S: Real, M: Frames<S> + MassMatrix<S>, L: ContactLaw<S>> MassMatrix<S> for Grounded<'_, S, M, L> {
    fn mass_matrix(&self, q: &Self::Coordinates) -> Self::Matrix {
        self.mechanism.mass_matrix(q)
    }
}

impl<S: Real, M: Frames<S> + MechanicalEnergy<S>, L: ContactLaw<S>> MechanicalEnergy<S> for Grounded<'_, S, M, L> {
    /// With the energy of the ground as part of the potential.
    fn energy(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Energy<S> {
        let Energy { kinetic, potential } = self.mechanism.energy(q, v);
        Energy { kinetic, potential: potential + self.ground_energy(q, v) }
    }
}

impl<S, M: LoopRows, L> LoopRows for Grounded<'_, S, M, L> {
    fn nc(&self) -> usize {
        self.mechanism.nc()
    }
    fn loop_name(&self, row: usize) -> Option<&str> {
        self.mechanism.loop_name(row)
    }
}

impl<'m, S: Real, M: Frames<S> + LoopClosure<S, M>, L: ContactLaw<S>> LoopClosure<S, Self> for Grounded<'m, S, M, L> {
    type Rows = M::Rows;
    type Jacobian = M::Jacobian;
    type Gram = M::Gram;

    fn loop_residual(&self, q: &M::Coordinates) -> Self::Rows {
        self.mechanism.loop_residual(q)
    }
    fn loop_jacobian(&self, q: &M::Coordinates) -> Self::Jacobian {
        self.mechanism.loop_jacobian(q)
    }
    fn loop_bias(&self, q: &M::Coordinates, v: &M::Velocities) -> Self::Rows {
        self.mechanism.loop_bias(q, v)
    }
}
