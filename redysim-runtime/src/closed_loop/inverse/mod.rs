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

/// An independent coordinate moves by no more than this from one closed position to the next, rad or m, so that the
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

    /// The motion and the forces at time `t`. Component i of the trajectory belongs to velocity `independent[i]` and to
    /// its [coordinate](crate::Mechanism::coordinate_of_velocity): the joint has one coordinate, or there is an error.
    /// The position found is the guess for the next instant.
    ///
    /// # Errors
    /// [`LoopError::Unreachable`], [`LoopError::RankDeficient`] if the independent coordinates do not determine the
    /// others, [`LoopError::InconsistentVelocity`] if they contradict each other, [`LoopError::Unactuated`] if there
    /// are too few actuators, [`LoopError::WrongLength`], [`LoopError::RepeatedVelocity`],
    /// [`LoopError::VelocityOutOfRange`], [`LoopError::NoCoordinate`], [`LoopError::SingularInertia`] and
    /// [`LoopError::NotFinite`].
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn at<S: Real, I: Vector<S>>(
        &mut self,
        t: S,
        trajectory: &impl Trajectory<S, I, I>,
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
    fn follow<S: Real, I: Vector<S>>(&self, t: S, wanted: &I) -> Result<Q, LoopError<S>>
    where
        M: MassMatrix<S, Coordinates = Q>,
        C: LoopClosure<S, M>,
        Q: Vector<S>,
    {
        let mut q = self.q.clone();
        let displacement = |(i, coordinate): (usize, Option<usize>)| match coordinate {
            Some(coordinate) => entry(wanted, i) - entry(&q, coordinate),
            None => S::from_f64(f64::NAN),
        };
        let (farthest, at) = largest(self.actuation.coordinates().enumerate().map(displacement));
        if !farthest.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let moves = (farthest.to_f64() / LARGEST_MOVE) as usize + 1;
        let moves = moves.min(MOST_MOVES);
        for left in (0..moves).rev() {
            let part = S::one() / S::from_f64((left + 1) as f64);
            for (i, coordinate) in self.actuation.coordinates().enumerate() {
                let target = entry(wanted, i);
                if let Some(element) = coordinate.and_then(|coordinate| q.as_mut().get_mut(coordinate)) {
                    *element = if left == 0 { target } else { *element + part * (target - *element) };
                }
            }
            let solution =
                self.actuation.loops.solve_position(Metric::Mass, q, self.actuation.independent, ITERATIONS)?;
            if solution.status != NewtonStatus::Converged {
                let velocity = self.actuation.independent.get(at).copied().unwrap_or(0);
                return Err(LoopError::Unreachable { t, velocity, position_residual: solution.position_residual });
            }
            q = solution.q;
        }
        Ok(q)
    }
}
