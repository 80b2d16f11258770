//! PD control with gravity compensation.

use super::{check_gains, check_motion};
use crate::vector::entry;
use crate::{ConfigurationSpace, GravityForces, LengthMismatch, Real, TorqueLaw, Trajectory, Vector};

/// PD control with gravity compensation: τ = Kp e + Kd ė + g(q), with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
///
/// The gravity forces are those of `mechanism`, the robot as the controller knows it. It may be another type than the
/// one that moves, for example with the payload that the controller assumes. If the two have the same gravity forces
/// and the robot has no springs, every set point is an equilibrium. Springs and other passive forces are not
/// compensated. Otherwise the robot rests where Kp e balances the difference: e = Kp⁻¹ (g_robot(q) − g(q)). Source:
/// M. Takegaki and S. Arimoto, *A new feedback method for dynamic control of manipulators*, J. Dyn. Syst. Meas. Control
/// 103 (1981).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PdGravity<'m, M, T, V> {
    /// The mechanism as the controller knows it, with the payload that it assumes.
    pub mechanism: &'m M,
    /// The motion to follow; a [`SetPoint`](crate::SetPoint) for one position.
    pub trajectory: T,
    /// Kp, one for each velocity, N m/rad or N/m.
    pub kp: V,
    /// Kd, one for each velocity, N m s/rad or N s/m.
    pub kd: V,
}

impl<S, M, N, T> TorqueLaw<S, M> for PdGravity<'_, N, T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    N: GravityForces<S, Coordinates = M::Coordinates, Velocities = M::Velocities>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let desired = self.trajectory.at(t);
        let error = self.mechanism.difference(q, &desired.q);
        let gravity = self.mechanism.gravity_forces(q);
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * entry(&error, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
                + entry(&gravity, i)
        })
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)
    }
}
