//! From a guess to closed loops.

use super::NewtonStatus;
use crate::closed_loop::constraints::Metric;
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::linear_algebra::{difference, largest, norm, product};
use crate::{LoopClosure, MassMatrix, Real};

/// Enough to cross several turns by the largest step.
const ITERATIONS: usize = 200;
/// A velocity that violates the constraints by less than this part of the largest speed at the cuts is rounding.
const SLOW: f64 = 1e-10;

/// A closed position near a guess, and a velocity that keeps it closed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Assembly<S, Q, V> {
    /// Joint coordinates.
    pub q: Q,
    /// Joint velocities.
    pub v: V,
    /// The largest component of the displacement from the guess to `q`, by
    /// [`difference`](crate::ConfigurationSpace::difference), rad or m.
    pub largest_displacement: S,
    /// The velocity that it belongs to.
    pub velocity: usize,
    /// The length of the displacement, √Σ δᵢ²; δ = Δq for joints of one coordinate each.
    pub distance: S,
    /// The largest component of the residual that is left, m (or a sine).
    pub position_residual: S,
    /// Its row.
    pub row: usize,
    /// How many rows are independent there.
    pub rank: usize,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// Closes the loops from the guess `q` and fits the velocities to the guess `v`, with the velocities `held`, and
    /// the positions of their joints, as they are; the others move as little as they can, in the metric of M (or, where
    /// that does not close them, of the displacements themselves).
    ///
    /// It stays on the branch of the guess: no joint moves by more than 0.2 rad (or m) in one iteration, and none
    /// of these enlarges the residual. The result is closed to 10⁻¹⁴ of the mechanism's size.
    ///
    /// # Errors
    /// [`LoopError::VelocityOutOfRange`], [`LoopError::CannotClose`], [`LoopError::NoConvergence`],
    /// [`LoopError::InconsistentVelocity`] if held velocities cannot be met, [`LoopError::SingularInertia`] and
    /// [`LoopError::NotFinite`].
    pub fn assemble<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
        held: &[usize],
    ) -> Result<Assembly<S, M::Coordinates, M::Velocities>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let count = self.mechanism.nv();
        if let Some(&velocity) = held.iter().find(|&&velocity| velocity >= count) {
            return Err(LoopError::VelocityOutOfRange { velocity, count });
        }
        let mut solution = self.solve_position(Metric::Mass, q.clone(), held, ITERATIONS)?;
        if solution.status != NewtonStatus::Converged {
            // In the metric of M, a loop of links that weigh next to nothing seems to constrain nothing.
            solution = self.solve_position(Metric::Unit, q.clone(), held, ITERATIONS)?;
        }
        let (position_residual, row) = (solution.position_residual, solution.row);
        match solution.status {
            NewtonStatus::Converged => {}
            NewtonStatus::Stalled => return Err(LoopError::CannotClose { position_residual, row }),
            NewtonStatus::IterationLimit => return Err(LoopError::NoConvergence { position_residual, row }),
        }
        let (asked, _) = largest(v.as_ref().iter().copied());
        let mut v = v.clone();
        // The second time takes away what rounding left of the first.
        for _ in 0..2 {
            let rates: C::Rows = product(solution.constraints.jacobian.as_ref(), v.as_ref());
            v = difference(&v, &solution.constraints.weighted.least_norm(&rates));
        }
        if largest(v.as_ref().iter().copied()).0 <= S::EPSILON * asked {
            // The loops stop all that was asked for: what is left is roundoff of it.
            for (velocity, speed) in v.as_mut().iter_mut().enumerate() {
                *speed = if held.contains(&velocity) { *speed } else { S::zero() };
            }
        }
        let rates: C::Rows = product(solution.constraints.jacobian.as_ref(), v.as_ref());
        let (residual, at_row) = largest(rates.as_ref().iter().copied());
        let (fastest, _) = largest(v.as_ref().iter().copied());
        if !fastest.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let slow = S::from_f64(SLOW).maximum(S::from_f64(100.0) * S::EPSILON);
        if residual > slow * solution.constraints.length_scale() * fastest.maximum(S::EPSILON * asked) {
            return Err(LoopError::InconsistentVelocity { residual, row: at_row });
        }
        let displacement = self.mechanism.difference(q, &solution.q);
        let (largest_displacement, velocity) = largest(displacement.as_ref().iter().copied());
        let distance = norm(displacement.as_ref());
        Ok(Assembly {
            q: solution.q,
            v,
            largest_displacement,
            velocity,
            distance,
            position_residual,
            row,
            rank: solution.constraints.weighted.decomposition.rank(),
        })
    }
}
