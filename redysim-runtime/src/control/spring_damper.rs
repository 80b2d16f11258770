//! Springs and dampers in the joints.

use super::{check_gains, check_motion, spring_and_damper};
use crate::tangent::error_slope;
use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// A spring to a set point: τ = Kp e, with the error e = q_d ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
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
    fn torque(&mut self, mechanism: &M, _t: S, q: &M::Coordinates, _v: &M::Velocities) -> M::Velocities {
        spring(&self.kp, &mechanism.difference(q, &self.target))
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        LengthMismatch::check("target", self.target.as_ref(), mechanism.nq())?;
        LengthMismatch::check("kp", self.kp.as_ref(), mechanism.nv())
    }

    fn torque_tangent(
        &mut self,
        mechanism: &M,
        _t: S,
        (q, _): (&M::Coordinates, &M::Velocities),
        (dq, _): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring(&self.kp, &error_slope(mechanism, q, &self.target, dq)?))
    }
}

/// A spring and a damper to a set point: τ = Kp e − Kd v, with the error e = q_d ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
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
    fn torque(&mut self, mechanism: &M, _t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        spring_and_damper(&self.kp, &self.kd, &mechanism.difference(q, &self.target), v)
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        LengthMismatch::check("target", self.target.as_ref(), mechanism.nq())?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        mechanism: &M,
        _t: S,
        (q, _): (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring_and_damper(&self.kp, &self.kd, &error_slope(mechanism, q, &self.target, dq)?, dv))
    }
}

/// The full name of [`Pd`].
pub type ProportionalDerivative<Q, V> = Pd<Q, V>;

/// A spring and a damper to a moving target: τ = Kp e + Kd (v_d(t) − v), with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
///
/// Of an orientation, v_d is the angular velocity in the desired axes, and v that in the link's.
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
    fn torque(&mut self, mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let desired = self.trajectory.at(t);
        let error = mechanism.difference(q, &desired.q);
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * entry(&error, i) + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
        })
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        mechanism: &M,
        t: S,
        (q, _): (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        let target = self.trajectory.at(t).q;
        Some(spring_and_damper(&self.kp, &self.kd, &error_slope(mechanism, q, &target, dq)?, dv))
    }
}

/// Kp e.
fn spring<S: Real, V: Vector<S>>(kp: &V, e: &V) -> V {
    V::from_fn(e.as_ref().len(), |i| entry(kp, i) * entry(e, i))
}
