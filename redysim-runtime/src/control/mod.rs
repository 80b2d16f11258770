//! Torque laws: what the actuators do.
//!
//! | law | τ |
//! |---|---|
//! | [`ZeroTorque`] | 0 |
//! | [`Proportional`], [`Pd`] | a spring, and a damper, to a set point |
//! | [`TrackingPd`] | the same to a motion |
//! | [`Pid`] | with integral action, whose state the simulation integrates |
//! | [`PdGravity`] | a spring and a damper to a motion, and the gravity forces of a model |
//! | [`ComputedTorque`] | the inverse dynamics of a model, with feedback |
//! | [`HybridComputedTorque`] | the same of mechanisms of which some joints have no actuator |
//! | [`Impedance`] | springs and dampers on a frame, and gravity forces or the bias of a model |
//! | [`Limited`] | any law within the limits of the actuators |
//!
//! All but [`Impedance`] take one gain for each velocity. Their position errors are e = q_d ⊟ q, the mechanism's
//! [`difference`](ConfigurationSpace::difference): q_d − q of joints of one coordinate, and of an orientation the rotation
//! vector in the link's axes that leads to the desired one the shorter way, |e| ≤ π. Torques are N m (N for a prismatic
//! joint), proportional gains N m/rad (N/m) and derivative gains N m s/rad (N s/m) by default. One gain for all joints is
//! written `[50.0; Kr5::NV]`, or for any mechanism [`uniform`]. A simulation checks the lengths of gains and targets
//! before it starts ([`TorqueLaw::check_lengths`]).
//!
//! For a constant set point of a spherical joint and equal gains, the springs have the potential ½ Kp |e|², and with dampers
//! an isolated body comes to rest at its target from almost every state. At half a turn, |e| = π, the moment is
//! discontinuous; no continuous law stabilises an orientation globally (S. P. Bhat and D. S. Bernstein, *A topological
//! obstruction to continuous global stabilization of rotational motion*, Syst. Control Lett. 39, 2000). Of a free joint e is
//! the logarithm of SE(3), whose linear part is coupled to the rotation; its springs have no potential in general.

mod computed_torque;
mod hybrid_computed_torque;
mod impedance;
mod limited;
mod pd_gravity;
mod pid;
mod rotation_vector;
mod spring_damper;

use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Mechanism, Motion, Real, Scalar, Vector};

pub use computed_torque::ComputedTorque;
pub use hybrid_computed_torque::HybridComputedTorque;
pub use impedance::{Compensation, FrameGains, FrameTrajectory, Impedance};
pub use limited::Limited;
pub use pd_gravity::PdGravity;
pub use pid::{Pid, tracking_rates};
pub use spring_damper::{Pd, Proportional, ProportionalDerivative, TrackingPd};

/// What the actuators do. Every closure `FnMut(S, &Coordinates, &Velocities) -> Velocities` is one.
///
/// Integrators ask at points of their own choice, also at points of steps that they then reject: a law that remembers
/// should remember by time, not by call.
///
/// What a law remembers of the past, such as the integral of an error, is its state z, with rates ż(t, q, v, z):
/// [`state_count`](Self::state_count), [`initial_state`](Self::initial_state) and
/// [`torque_with_state`](Self::torque_with_state). A simulation integrates z with the motion, so that every method and
/// its error control apply to it, and rejected steps leave no trace. By default, a law has no state.
pub trait TorqueLaw<S: Scalar, M: ConfigurationSpace<S>> {
    /// The joint forces of `mechanism`, the one that moves, at time `t` (s) for coordinates `q` and velocities `v`.
    fn torque(&mut self, mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities;

    /// Checks, before a simulation of `mechanism` begins at the time `t`, that the vectors of the law have the lengths
    /// that it needs. Arrays always have. By default, nothing is checked.
    ///
    /// # Errors
    /// The first vector that has another length.
    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        let _ = (t, mechanism);
        Ok(())
    }

    /// The derivative of the joint forces along `(dq, dv)`, (∂τ/∂q) dq + (∂τ/∂v) dv, for the Jacobians of implicit
    /// integrators. `None`, the default, leaves it to differences of [`torque`](Self::torque).
    fn torque_tangent(
        &mut self,
        mechanism: &M,
        t: S,
        at: (&M::Coordinates, &M::Velocities),
        slopes: (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        let _ = (mechanism, t, at, slopes);
        None
    }

    /// How many states z the law has; a simulation's [`extended_state`](crate::ForwardSimulation::extended_state) ends
    /// with them.
    fn state_count(&self, mechanism: &M) -> usize {
        let _ = mechanism;
        0
    }

    /// State `index` at the start; zero by default.
    fn initial_state(&self, index: usize) -> S {
        let _ = index;
        S::zero()
    }

    /// The joint forces at time `t` for the position and velocity `at` = (q, v) and the states `state`; their rates ż are
    /// written to `rates`, which has the length of `state`. For a law without states it is [`torque`](Self::torque).
    fn torque_with_state(
        &mut self,
        mechanism: &M,
        t: S,
        at: (&M::Coordinates, &M::Velocities),
        state: &[S],
        rates: &mut [S],
    ) -> M::Velocities {
        let _ = (state, rates);
        self.torque(mechanism, t, at.0, at.1)
    }

    /// Adds the anti-windup correction for the saturation error τ_applied − τ to the rates. [`Limited`] calls it; by
    /// default, nothing is added.
    fn track(&self, saturation_error: &M::Velocities, rates: &mut [S]) {
        let _ = (saturation_error, rates);
    }
}

impl<S, M, F> TorqueLaw<S, M> for F
where
    S: Scalar,
    M: ConfigurationSpace<S>,
    F: FnMut(S, &M::Coordinates, &M::Velocities) -> M::Velocities,
{
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        self(t, q, v)
    }
}

/// The same gain, or whatever else belongs to a joint, for all joints of a mechanism.
pub fn uniform<S: Scalar, M: ConfigurationSpace<S>>(mechanism: &M, gain: S) -> M::Velocities {
    M::Velocities::from_fn(mechanism.nv(), |_| gain)
}

/// Zero torque: τ = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ZeroTorque;

impl<S: Scalar, M: ConfigurationSpace<S>> TorqueLaw<S, M> for ZeroTorque {
    fn torque(&mut self, _mechanism: &M, _t: S, _q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |_| S::zero())
    }

    fn torque_tangent(
        &mut self,
        _mechanism: &M,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (_, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(M::Velocities::from_fn(dv.as_ref().len(), |_| S::zero()))
    }
}

/// Checks that there is a gain Kp and a gain Kd for each velocity.
fn check_gains<S: Scalar, V: Vector<S>>(mechanism: &impl Mechanism, kp: &V, kd: &V) -> Result<(), LengthMismatch> {
    LengthMismatch::check("kp", kp.as_ref(), mechanism.nv())?;
    LengthMismatch::check("kd", kd.as_ref(), mechanism.nv())
}

/// Checks that a motion moves all coordinates.
pub(crate) fn check_motion<S: Scalar, Q: Vector<S>, V: Vector<S>>(
    mechanism: &impl Mechanism,
    motion: &Motion<Q, V>,
) -> Result<(), LengthMismatch> {
    LengthMismatch::check("trajectory.q", motion.q.as_ref(), mechanism.nq())?;
    LengthMismatch::check("trajectory.v", motion.v.as_ref(), mechanism.nv())?;
    LengthMismatch::check("trajectory.a", motion.a.as_ref(), mechanism.nv())
}

/// Kp e − Kd v, also of slopes of e and v.
fn spring_and_damper<S: Real, V: Vector<S>>(kp: &V, kd: &V, e: &V, v: &V) -> V {
    V::from_fn(v.as_ref().len(), |i| entry(kp, i) * entry(e, i) - entry(kd, i) * entry(v, i))
}
