//! Computed torque for closed loops.

use core::marker::PhantomData;

use super::LoopForces;
use super::actuation::Actuation;
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{InverseDynamics, LengthMismatch, LoopClosure, Mechanism, Motion, Real, TorqueLaw, Trajectory, Vector};

/// Computed torque of a mechanism with closed loops: the forces of its actuators that give the independent coordinates
/// the accelerations q̈_d + Kd ė + Kp e, with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](crate::ConfigurationSpace::difference).
///
/// The other coordinates follow from the loops, and the forces are those that
/// [`ClosedLoopInverse`](crate::ClosedLoopInverse) finds for such a motion. For a model that is right they leave ë + Kd
/// ė + Kp e = 0, as [`ComputedTorque`](crate::ComputedTorque) does for a tree. The gains multiply accelerations: Kp
/// 1/s², Kd 1/s.
///
/// It expects positions with closed loops: in a [`ClosedLoopSimulation`](crate::ClosedLoopSimulation), the projection.
#[derive(Debug)]
pub struct ClosedLoopComputedTorque<'m, S, M, T, I, C = M, P = I> {
    actuation: Actuation<'m, M, C>,
    trajectory: T,
    kp: I,
    kd: I,
    last_error: Option<LoopError<S>>,
    independent_coordinates: PhantomData<fn() -> P>,
}

impl<'m, S, M, T, I, C, P> ClosedLoopComputedTorque<'m, S, M, T, I, C, P>
where
    S: Real,
    T: Trajectory<S, P, I>,
    I: Vector<S>,
    P: Vector<S>,
{
    /// The law that has the joints of the velocities `independent` (and actuated) follow `trajectory`, which is one as for
    /// [`ClosedLoopInverse::at`](super::ClosedLoopInverse::at). Element i of the gains belongs to velocity `independent[i]`.
    pub fn new(loops: ClosedLoop<'m, M, C>, independent: &'m [usize], trajectory: T, [kp, kd]: [I; 2]) -> Self {
        let actuation = Actuation { loops, independent, actuated: independent };
        Self { actuation, trajectory, kp, kd, last_error: None, independent_coordinates: PhantomData }
    }

    /// Sets which joints have actuators, if not just the independent ones.
    pub fn actuated(self, actuated: &'m [usize]) -> Self {
        Self { actuation: Actuation { actuated, ..self.actuation }, ..self }
    }

    /// Why the forces asked for last are not numbers; `None` if they are.
    pub fn last_error(&self) -> Option<LoopError<S>> {
        self.last_error
    }

    /// Checks that the desired motion and the gains have an element for each independent coordinate and velocity.
    fn check(&self, desired: &Motion<P, I>) -> Result<(), LengthMismatch>
    where
        M: Mechanism,
    {
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
    {
        self.actuation.check()?;
        let desired = self.trajectory.at(t);
        self.check(&desired).map_err(LoopError::WrongLength)?;
        let target = self.actuation.moved_to(q.clone(), &desired.q);
        let error: I = self.actuation.independent_of(&self.actuation.loops.mechanism.difference(q, &target));
        let speeds: I = self.actuation.independent_of(v);
        let wanted = I::from_fn(self.actuation.independent.len(), |i| {
            entry(&desired.a, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(&speeds, i))
                + entry(&self.kp, i) * entry(&error, i)
        });
        self.actuation.forces(q.clone(), &speeds, &wanted)
    }
}

impl<S, M, T, I, C, P> TorqueLaw<S, M> for ClosedLoopComputedTorque<'_, S, M, T, I, C, P>
where
    S: Real,
    M: InverseDynamics<S>,
    C: LoopClosure<S, M>,
    T: Trajectory<S, P, I>,
    I: Vector<S>,
    P: Vector<S>,
{
    fn check_lengths(&self, t: S, _mechanism: &M) -> Result<(), LengthMismatch> {
        // How many coordinates there are is unknown where a velocity is invalid, which `forces` reports.
        if self.actuation.check::<S>().is_err() {
            return Ok(());
        }
        self.check(&self.trajectory.at(t))
    }

    /// Not numbers where no forces give the motion; [`last_error`](Self::last_error) then says why.
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
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
