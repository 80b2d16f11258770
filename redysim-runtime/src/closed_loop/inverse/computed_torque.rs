//! Computed torque for closed loops.

use super::LoopForces;
use super::actuation::Actuation;
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{InverseDynamics, LengthMismatch, LoopClosure, Motion, Real, TorqueLaw, Trajectory, Vector};

/// Computed torque of a mechanism with closed loops: the forces of its actuators that give the independent coordinates
/// the accelerations q̈_d + Kd ė + Kp e, with the error e = q_d(t) − q.
///
/// The other coordinates follow from the loops, and the forces are those that
/// [`ClosedLoopInverse`](crate::ClosedLoopInverse) finds for such a motion. For a model that is right they leave ë + Kd
/// ė + Kp e = 0, as [`ComputedTorque`](crate::ComputedTorque) does for a tree. The gains multiply accelerations: Kp
/// 1/s², Kd 1/s.
///
/// It expects positions with closed loops: in a [`ClosedLoopSimulation`](crate::ClosedLoopSimulation), the projection.
#[derive(Debug)]
pub struct ClosedLoopComputedTorque<'m, S, M, T, I, C = M> {
    actuation: Actuation<'m, M, C>,
    trajectory: T,
    kp: I,
    kd: I,
    last_error: Option<LoopError<S>>,
}

impl<'m, S: Real, M, T, I: Vector<S>, C> ClosedLoopComputedTorque<'m, S, M, T, I, C> {
    /// The law that has the joints of the velocities `independent` (and actuated) follow `trajectory`, whose component
    /// i belongs to velocity `independent[i]` and to its
    /// [coordinate](crate::Mechanism::coordinate_of_velocity), as do those of the gains.
    pub fn new(loops: ClosedLoop<'m, M, C>, independent: &'m [usize], trajectory: T, [kp, kd]: [I; 2]) -> Self {
        let actuation = Actuation { loops, independent, actuated: independent };
        Self { actuation, trajectory, kp, kd, last_error: None }
    }

    /// Sets which joints have actuators, if not just the independent ones.
    pub fn actuated(self, actuated: &'m [usize]) -> Self {
        Self { actuation: Actuation { actuated, ..self.actuation }, ..self }
    }

    /// Why the forces asked for last are not numbers; `None` if they are.
    pub fn last_error(&self) -> Option<LoopError<S>> {
        self.last_error
    }

    /// Checks that the desired motion and the gains have a component for each independent velocity.
    fn check(&self, desired: &Motion<I, I>) -> Result<(), LengthMismatch> {
        self.actuation.check_motion(desired)?;
        self.actuation.check_lengths([("kp", &self.kp), ("kd", &self.kd)])
    }

    /// The motion that is asked for in a state, and the forces that it takes.
    ///
    /// # Errors
    /// As [`ClosedLoopInverse::at`](super::ClosedLoopInverse::at), but for `Unreachable`.
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn forces(
        &self,
        t: S,
        q: &M::Coordinates,
        v: &M::Velocities,
    ) -> Result<LoopForces<M::Coordinates, M::Velocities, C::Rows>, LoopError<S>>
    where
        M: InverseDynamics<S>,
        C: LoopClosure<S, M>,
        T: Trajectory<S, I, I>,
    {
        self.actuation.check()?;
        let desired = self.trajectory.at(t);
        self.check(&desired).map_err(LoopError::WrongLength)?;
        let nan = || S::from_f64(f64::NAN);
        let count = self.actuation.independent.len();
        let mut velocities = self.actuation.independent.iter();
        let speeds = I::from_fn(count, |_| velocities.next().map_or_else(nan, |&velocity| entry(v, velocity)));
        let mut coordinates = self.actuation.coordinates();
        let positions = I::from_fn(count, |_| coordinates.next().flatten().map_or_else(nan, |index| entry(q, index)));
        let wanted = I::from_fn(count, |i| {
            entry(&desired.a, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(&speeds, i))
                + entry(&self.kp, i) * (entry(&desired.q, i) - entry(&positions, i))
        });
        self.actuation.forces(q.clone(), &speeds, &wanted)
    }
}

impl<S, M, T, I, C> TorqueLaw<S, M> for ClosedLoopComputedTorque<'_, S, M, T, I, C>
where
    S: Real,
    M: InverseDynamics<S>,
    C: LoopClosure<S, M>,
    T: Trajectory<S, I, I>,
    I: Vector<S>,
{
    fn check_lengths(&self, t: S, _mechanism: &M) -> Result<(), LengthMismatch> {
        self.check(&self.trajectory.at(t))
    }

    /// Not numbers where no forces give the motion; [`last_error`](Self::last_error) then says why.
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        match self.forces(t, q, v) {
            Ok(found) => {
                self.last_error = None;
                found.forces
            }
            Err(error) => {
                self.last_error = Some(error);
                M::Velocities::from_fn(v.as_ref().len(), |_| S::from_f64(f64::NAN))
            }
        }
    }
}
