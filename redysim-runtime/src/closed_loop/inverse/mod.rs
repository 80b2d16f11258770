//! Inverse dynamics of closed loops: joint forces for a trajectory of the independent coordinates.

mod actuation;
mod computed_torque;

use super::constraints::Metric;
use super::position::NewtonStatus;
use super::{ClosedLoop, LoopError};
use crate::linear_algebra::largest;
use crate::vector::entry;
use crate::{InverseDynamics, LoopClosure, MassMatrix, Motion, Real, Trajectory, Vector};
use actuation::Actuation;

pub use computed_torque::ClosedLoopComputedTorque;

/// No component of the independent displacement from one closed position to the next exceeds this, rad or m, so that the
/// branch is kept between instants far apart. Where that takes more than `MOST_MOVES`, the moves are longer.
const LARGEST_MOVE: f64 = 0.1;
const MOST_MOVES: usize = 10_000;
const ITERATIONS: usize = 100;

/// Finds the joint forces that make a mechanism with closed loops follow a trajectory of its independent coordinates.
///
/// Instant by instant, positions follow by Newton's method from the previous instant, velocities and accelerations from
/// the loops, then the forces of the actuators together with the multipliers.
#[derive(Debug)]
pub struct ClosedLoopInverse<'m, M, Q, C = M> {
    actuation: Actuation<'m, M, C>,
    q: Q,
}

/// The motion and the forces at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LoopForces<Q, V, R> {
    /// Coordinates, velocities and accelerations of all joints.
    pub motion: Motion<Q, V>,
    /// Joint forces, N m or N; zero where no actuator is.
    pub forces: V,
    /// λ, one for each row; sign and order as in [`ConstrainedMotion`](crate::ConstrainedMotion).
    pub multipliers: R,
    /// How many rows are independent at this position.
    pub rank: usize,
    /// How many actuators there are more than the motion needs. If any, |τ|² + |λ|² is the least.
    pub redundancy: usize,
}

impl<'m, M, Q, C> ClosedLoopInverse<'m, M, Q, C> {
    /// The inverse dynamics of `loops` with the velocities `independent` prescribed (and actuated), beginning on the
    /// branch of the guess `q`.
    pub fn new(loops: ClosedLoop<'m, M, C>, independent: &'m [usize], q: Q) -> Self {
        Self { actuation: Actuation { loops, independent, actuated: independent }, q }
    }

    /// Sets which joints have actuators, if not just the independent ones.
    pub fn actuated(self, actuated: &'m [usize]) -> Self {
        Self { actuation: Actuation { actuated, ..self.actuation }, ..self }
    }

    /// The motion and the forces at time `t`. Element i of the trajectory's velocities and accelerations belongs to velocity
    /// `independent[i]`; its coordinates are those that these velocities change, in their order, each once: the
    /// [coordinate](crate::Mechanism::coordinate_of_velocity) of a joint that has one, the quaternion of a spherical joint, all
    /// of whose velocities are independent, or none, and position and quaternion of a free joint.
    ///
    /// The position found is the guess for the next instant; an orientation turns the shortest way there.
    ///
    /// # Errors
    /// [`LoopError::Unreachable`], [`LoopError::RankDeficient`] if the independent coordinates do not determine the
    /// others, [`LoopError::InconsistentVelocity`] if they contradict each other, [`LoopError::Unactuated`] if there
    /// are too few actuators, [`LoopError::WrongLength`], [`LoopError::RepeatedVelocity`],
    /// [`LoopError::VelocityOutOfRange`], [`LoopError::PartOfJoint`], [`LoopError::NoCoordinate`],
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn at<S: Real, P: Vector<S>, I: Vector<S>>(
        &mut self,
        t: S,
        trajectory: &impl Trajectory<S, P, I>,
    ) -> Result<LoopForces<Q, M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + InverseDynamics<S, Coordinates = Q>,
        C: LoopClosure<S, M>,
        Q: Vector<S>,
    {
        self.actuation.check()?;
        let wanted = trajectory.at(t);
        self.actuation.check_motion(&wanted).map_err(LoopError::WrongLength)?;
        let q = self.follow(t, &wanted.q)?;
        let found = self.actuation.forces(q, &wanted.v, &wanted.a)?;
        self.q = found.motion.q.clone();
        Ok(found)
    }

    /// The closed position with the independent coordinates at `wanted`, on the branch of the previous one.
    fn follow<S: Real, P: Vector<S>>(&self, t: S, wanted: &P) -> Result<Q, LoopError<S>>
    where
        M: MassMatrix<S, Coordinates = Q>,
        C: LoopClosure<S, M>,
        Q: Vector<S>,
    {
        let Actuation { loops, independent, .. } = self.actuation;
        let mechanism = loops.mechanism;
        let mut q = self.q.clone();
        let way = mechanism.difference(&q, &self.actuation.moved_to(q.clone(), wanted));
        let (farthest, at) = largest(independent.iter().map(|&velocity| entry(&way, velocity)));
        if !farthest.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let moves = (farthest.to_f64() / LARGEST_MOVE) as usize + 1;
        let moves = moves.min(MOST_MOVES);
        for left in (0..moves).rev() {
            let mut target = self.actuation.moved_to(q.clone(), wanted);
            if left > 0 {
                let part = S::one() / S::from_f64((left + 1) as f64);
                let way = mechanism.difference(&q, &target);
                target = mechanism.integrate(&q, &M::Velocities::from_fn(mechanism.nv(), |i| part * entry(&way, i)));
            }
            let solution = loops.solve_position(Metric::Mass, target, independent, ITERATIONS)?;
            if solution.status != NewtonStatus::Converged {
                let velocity = independent.get(at).copied().unwrap_or(0);
                return Err(LoopError::Unreachable { t, velocity, position_residual: solution.position_residual });
            }
            q = solution.q;
        }
        Ok(q)
    }
}
