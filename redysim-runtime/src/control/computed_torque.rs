//! Computed torque of trees.

use super::{check_gains, check_motion, spring_and_damper};
use crate::tangent::error_slope;
use crate::vector::entry;
use crate::{ConfigurationSpace, InverseDynamics, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// Computed torque: τ = M(q) (q̈_d + Kd ė + Kp e) + C(q, q̇) q̇ + g(q), with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
///
/// For a model that is right it leaves the linear error dynamics ë + Kd ė + Kp e = 0, the same for every joint and
/// every pose, exactly where the velocities are the rates of the coordinates. For ė the law takes v_d − v; of a
/// quaternion, whose velocity is in axes that turn, ė is v_d − v − ω × e up to products of errors, so that there the
/// equation holds near the trajectory, and the better the slower it turns beside the gains.
///
/// It takes one inverse dynamics; no matrix is formed. The gains multiply accelerations: Kp 1/s², Kd 1/s. Kd = 2√Kp is
/// critically damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComputedTorque<'m, M, T, V> {
    /// The mechanism as the controller knows it.
    pub mechanism: &'m M,
    /// The motion to follow.
    pub trajectory: T,
    /// Kp, one for each velocity, 1/s².
    pub kp: V,
    /// Kd, one for each velocity, 1/s.
    pub kd: V,
}

impl<N, T, V> ComputedTorque<'_, N, T, V> {
    /// q̈_d + Kd ė + Kp e.
    fn acceleration<S: Real>(&self, t: S, q: &N::Coordinates, v: &V) -> V
    where
        N: ConfigurationSpace<S, Velocities = V>,
        T: Trajectory<S, N::Coordinates, V>,
        V: Vector<S>,
    {
        let desired = self.trajectory.at(t);
        let error = self.mechanism.difference(q, &desired.q);
        V::from_fn(v.as_ref().len(), |i| {
            entry(&desired.a, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
                + entry(&self.kp, i) * entry(&error, i)
        })
    }
}

impl<S, M, N, T> TorqueLaw<S, M> for ComputedTorque<'_, N, T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    N: InverseDynamics<S, Coordinates = M::Coordinates, Velocities = M::Velocities>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        self.mechanism.inverse_dynamics(q, v, &self.acceleration(t, q, v))
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        _mechanism: &M,
        t: S,
        (q, v): (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        let de = error_slope(self.mechanism, q, &self.trajectory.at(t).q, dq)?;
        let a = self.acceleration(t, q, v);
        let da = spring_and_damper(&self.kp, &self.kd, &de, dv);
        self.mechanism.inverse_dynamics_tangent((q, v, &a), (dq, dv, &da))
    }
}
