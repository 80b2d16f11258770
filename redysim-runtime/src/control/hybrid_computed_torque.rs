//! Computed torque of mechanisms of which some joints have no actuator.

use super::{check_gains, check_motion};
use crate::vector::entry;
use crate::{ConfigurationSpace, HybridDynamics, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// Computed torque of a mechanism of which some joints have no actuator, such as a walking robot on a free base.
///
/// Each joint that has one gets the acceleration
///
/// a = q̈_d + Kd ė + Kp e, with the error e = q_d(t) ⊟ q,
///
/// and the others move as the dynamics has it. The forces are those of [`HybridDynamics`] under the external joint forces f,
/// such as [`Grounded::ground_forces`](crate::Grounded::ground_forces) of the feet: the law knows them as a robot
/// does that measures the forces on its feet. For a right model, the error dynamics of the actuated joints is
/// ë + Kd ė + Kp e = 0, whatever the others do.
///
/// Nothing drives the joints without an actuator: their gains and their desired motion have no effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HybridComputedTorque<'m, M, T, V, A, F> {
    /// The mechanism as the controller knows it.
    pub mechanism: &'m M,
    /// The motion to follow.
    pub trajectory: T,
    /// Kp, one for each velocity, 1/s².
    pub kp: V,
    /// Kd, one for each velocity, 1/s.
    pub kd: V,
    /// Which velocities have an actuator in the model of `mechanism`: `ACTUATED` of a compiled type.
    pub actuated: A,
    /// f(q, q̇), N m or N: what acts on the mechanism beside gravity, passive forces and actuators.
    pub external: F,
}

impl<S, M, N, T, A, F> TorqueLaw<S, M> for HybridComputedTorque<'_, N, T, M::Velocities, A, F>
where
    S: Real,
    M: ConfigurationSpace<S>,
    N: HybridDynamics<S, Coordinates = M::Coordinates, Velocities = M::Velocities>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
    A: AsRef<[bool]>,
    F: Fn(&M::Coordinates, &M::Velocities) -> M::Velocities,
{
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let desired = self.trajectory.at(t);
        let error = self.mechanism.difference(q, &desired.q);
        let external = (self.external)(q, v);
        let is_actuated = |i: usize| self.actuated.as_ref().get(i).copied().unwrap_or_default();
        let given = M::Velocities::from_fn(v.as_ref().len(), |i| {
            if !is_actuated(i) {
                return entry(&external, i);
            }
            entry(&desired.a, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
                + entry(&self.kp, i) * entry(&error, i)
        });
        let found = self.mechanism.hybrid_dynamics(q, v, &given).tau;
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            if is_actuated(i) { entry(&found, i) - entry(&external, i) } else { S::zero() }
        })
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)?;
        LengthMismatch::check("actuated", self.actuated.as_ref(), mechanism.nv())
    }
}
