//! Springs and dampers in the joints.

use super::{check_coordinates, check_gains, check_motion, spring_and_damper};
use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// A spring to a set point: τ = Kp (q_d − q).
#[doc(alias = "P")]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Proportional<Q, V> {
    /// The set point q_d.
    pub target: Q,
    /// Kp, one for each velocity.
    pub kp: V,
}

impl<S: Real, M: ConfigurationSpace<S>> TorqueLaw<S, M> for Proportional<M::Coordinates, M::Velocities> {
    fn torque(&mut self, _t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |i| entry(&self.kp, i) * (entry(&self.target, i) - entry(q, i)))
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_coordinates(mechanism, "target", &self.target)?;
        LengthMismatch::check("kp", self.kp.as_ref(), mechanism.nv())
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(M::Velocities::from_fn(dv.as_ref().len(), |i| -entry(&self.kp, i) * entry(dq, i)))
    }
}

/// A spring and a damper to a set point: τ = Kp (q_d − q) − Kd q̇.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Pd<Q, V> {
    /// The set point q_d.
    pub target: Q,
    /// Kp, one for each velocity.
    pub kp: V,
    /// Kd, one for each velocity.
    pub kd: V,
}

impl<S: Real, M: ConfigurationSpace<S>> TorqueLaw<S, M> for Pd<M::Coordinates, M::Velocities> {
    fn torque(&mut self, _t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * (entry(&self.target, i) - entry(q, i)) - entry(&self.kd, i) * entry(v, i)
        })
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_coordinates(mechanism, "target", &self.target)?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring_and_damper(&self.kp, &self.kd, dq, dv))
    }
}

/// The full name of [`Pd`].
pub type ProportionalDerivative<Q, V> = Pd<Q, V>;

/// A spring and a damper to a moving target: τ = Kp (q_d(t) − q) + Kd (q̇_d(t) − q̇).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TrackingPd<T, V> {
    /// The motion to follow.
    pub trajectory: T,
    /// Kp, one for each velocity.
    pub kp: V,
    /// Kd, one for each velocity.
    pub kd: V,
}

impl<S, M, T> TorqueLaw<S, M> for TrackingPd<T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let desired = self.trajectory.at(t);
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * (entry(&desired.q, i) - entry(q, i))
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
        })
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        let desired = self.trajectory.at(t);
        check_coordinates(mechanism, "trajectory.q", &desired.q)?;
        check_motion(mechanism, &desired)?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring_and_damper(&self.kp, &self.kd, dq, dv))
    }
}
