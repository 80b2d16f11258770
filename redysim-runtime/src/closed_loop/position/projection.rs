//! The projection of position and velocity onto the constraints, as after a step of integration.

use super::NewtonSolution;
use crate::closed_loop::constraints::{Constraints, Metric};
use crate::closed_loop::independent::roundoff_tolerance;
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::linear_algebra::{difference, largest, product};
use crate::vector::entry;
use crate::{ConfigurationSpace, LoopClosure, MassMatrix, Real, Vector};

/// A handful of iterations are enough from near; where the mechanism is singular, each only halves the error.
const ITERATIONS: usize = 20;

/// A position and a velocity that keep the loops closed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Projection<S, Q, V> {
    /// Joint coordinates.
    pub q: Q,
    /// Joint velocities.
    pub v: V,
    /// The largest component of the residual that is left, m (or a sine).
    pub position_residual: S,
    /// How many rows are independent there.
    pub rank: usize,
}

/// A projection and the constraints there.
pub struct ProjectedPoint<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    pub projection: Projection<S, M::Coordinates, M::Velocities>,
    pub constraints: Constraints<S, M, C>,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// The nearest position and velocity, in the metric of M, that keep the loops closed.
    ///
    /// Positions by Newton's method, δq = −M⁻¹Jᵀ (J M⁻¹ Jᵀ)⁺ r, until the residual r is below 10⁻¹⁴ of the mechanism's
    /// size or shrinks no more; velocities by v − M⁻¹Jᵀ (J M⁻¹ Jᵀ)⁺ J v. The pseudo-inverse leaves alone what a
    /// singular position does not determine.
    ///
    /// # Errors
    /// [`LoopError::NoConvergence`] if more than 10⁻⁶ of the mechanism's size (3·10⁻³ in `f32`) stays open;
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
    pub fn project<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
    ) -> Result<Projection<S, M::Coordinates, M::Velocities>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        Ok(self.project_with_constraints(q, v, &[])?.projection)
    }

    /// The projection with the velocities `held`, and the positions of their joints, as they are, and the constraints there.
    ///
    /// # Errors
    /// Also [`LoopError::InconsistentVelocity`] if the loops do not admit the velocities that are held.
    pub(in crate::closed_loop) fn project_with_constraints<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
        held: &[usize],
    ) -> Result<ProjectedPoint<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let NewtonSolution { q, constraints, position_residual, row, .. } =
            self.solve_position(Metric::Mass, q.clone(), held, ITERATIONS)?;
        let open = S::from_f64(1e-6).maximum(S::from_f64(10.0) * S::EPSILON.sqrt());
        if position_residual > open * constraints.length_scale() {
            return Err(LoopError::NoConvergence { position_residual, row });
        }
        // A velocity that a `Vec` lacks is NaN, and seen to be.
        let normal = constraints.weighted.normal_velocity(v);
        let mut v = M::Velocities::from_fn(self.mechanism.nv(), |i| entry(v, i) - entry(&normal, i));
        if !held.is_empty() {
            // What is left of J v is that of the velocities held.
            let rates: C::Rows = product(constraints.jacobian.as_ref(), v.as_ref());
            v = difference(&v, &constraints.weighted.least_norm(&rates));
            let rates: C::Rows = product(constraints.jacobian.as_ref(), v.as_ref());
            let (residual, row) = largest(rates.as_ref().iter().copied());
            let (fastest, _) = largest(v.as_ref().iter().copied());
            if residual > roundoff_tolerance::<S>() * constraints.length_scale() * (S::one() + fastest) {
                return Err(LoopError::InconsistentVelocity { residual, row });
            }
        }
        if !largest(v.as_ref().iter().copied()).0.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let rank = constraints.weighted.decomposition.rank();
        Ok(ProjectedPoint { projection: Projection { q, v, position_residual, rank }, constraints })
    }
}
