//! Newton's method for the position constraints, on the branch of its guess.

use crate::closed_loop::constraints::{Constraints, Metric};
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::linear_algebra::{largest, norm};
use crate::vector::entry;
use crate::{ConfigurationSpace, LoopClosure, MassMatrix, Real, Vector};

/// The largest component of a step, rad or m: far below the distance of assembly modes.
const LARGEST_STEP: f64 = 0.2;
/// How often a step that enlarges the residual is halved.
const HALVINGS: usize = 20;
/// An iteration after which the residual is not below this part of the one before is slow.
const SHRINKING: f64 = 0.999;
/// After so many slow iterations in a row, the residual is as small as it gets.
const SLOW_ITERATIONS: usize = 10;

/// Where the iteration ended.
pub struct NewtonSolution<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    pub q: M::Coordinates,
    /// The constraints there.
    pub constraints: Constraints<S, M, C>,
    /// The largest component of the residual there.
    pub position_residual: S,
    /// Its row.
    pub row: usize,
    pub status: NewtonStatus,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum NewtonStatus {
    /// The residual is zero to rounding.
    Converged,
    /// No step makes the residual much smaller.
    Stalled,
    /// The iterations are used up.
    IterationLimit,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// Moves the coordinates that are not held, by steps that are shortest in the given metric, until the loops are
    /// closed to 10⁻¹⁴ of the mechanism's size (45 roundoff units) or the residual shrinks no more.
    pub(in crate::closed_loop) fn solve_position<S: Real>(
        &self,
        metric: Metric,
        mut q: M::Coordinates,
        held: &[usize],
        iterations: usize,
    ) -> Result<NewtonSolution<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let mut residual = self.closure.loop_residual(&q);
        let (mut count, mut slow) = (0, 0);
        loop {
            let (position_residual, row) = largest(residual.as_ref().iter().copied());
            if !position_residual.is_finite() {
                return Err(LoopError::NotFinite);
            }
            let constraints = self.constraints_in(metric, &q, held)?;
            if position_residual <= S::from_f64(45.0) * S::EPSILON * constraints.length_scale() {
                return Ok(NewtonSolution { q, constraints, position_residual, row, status: NewtonStatus::Converged });
            }
            if count == iterations {
                return Ok(NewtonSolution {
                    q,
                    constraints,
                    position_residual,
                    row,
                    status: NewtonStatus::IterationLimit,
                });
            }
            let next = self.newton_step(&q, &residual, &constraints);
            let Some((next, residual_there)) = next.filter(|_| slow < SLOW_ITERATIONS) else {
                return Ok(NewtonSolution { q, constraints, position_residual, row, status: NewtonStatus::Stalled });
            };
            let shrinks = norm(residual_there.as_ref()) < S::from_f64(SHRINKING) * norm(residual.as_ref());
            slow = if shrinks { 0 } else { slow + 1 };
            (q, residual) = (next, residual_there);
            count += 1;
        }
    }

    /// A step that makes the residual smaller, and the residual after it.
    fn newton_step<S: Real>(
        &self,
        q: &M::Coordinates,
        residual: &C::Rows,
        constraints: &Constraints<S, M, C>,
    ) -> Option<(M::Coordinates, C::Rows)>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let step = constraints.weighted.least_norm(residual);
        let (farthest, _) = largest(step.as_ref().iter().copied());
        let mut part = (S::from_f64(LARGEST_STEP) / farthest).minimum(S::one());
        let before = norm(residual.as_ref());
        for _ in 0..HALVINGS {
            let back = M::Velocities::from_fn(self.mechanism.nv(), |i| -(part * entry(&step, i)));
            let moved = self.mechanism.integrate(q, &back);
            let residual = self.closure.loop_residual(&moved);
            if norm(residual.as_ref()) < before {
                return Some((moved, residual));
            }
            part = S::from_f64(0.5) * part;
        }
        None
    }
}
