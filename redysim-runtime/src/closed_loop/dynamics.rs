//! Accelerations of closed loops, and the forces that keep them closed.

use super::constraints::Constraints;
use super::{ClosedLoop, LoopError};
use crate::linear_algebra::{WeightedRows, add_scaled, difference, largest};
use crate::vector::entry;
use crate::{BiasForces, ConfigurationSpace, LoopClosure, MassMatrix, Real, Vector};

/// Accelerations and constraint forces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstrainedMotion<V, R> {
    /// Joint accelerations, rad/s² or m/s².
    pub accelerations: V,
    /// λ, one for each row: the force at the cut, in the base frame, that side a exerts on side b (N; N m for a row
    /// that aligns directions). Of all that have the same effect, the shortest.
    pub multipliers: R,
    /// How many rows are independent at this position.
    pub rank: usize,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// The accelerations a and the multipliers λ with M a + h = τ + Jᵀ λ and J a = −J̇ q̇, for joint forces `tau`.
    ///
    /// Redundant rows share the constraint force so that |λ| is least. In a singular position, the rows that depend on
    /// others there are left out: the result is finite and the rank is lower.
    ///
    /// M may be singular, as with a rod without mass, if it is positive definite on the velocities that the loops leave
    /// free.
    ///
    /// # Errors
    /// [`LoopError::SingularInertia`] if the loops leave a motion free that moves no mass, and
    /// [`LoopError::NotFinite`].
    pub fn dynamics<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
        tau: &M::Velocities,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
    {
        self.dynamics_with(&self.constraints_at(q)?, q, v, tau, |_| S::zero())
    }

    /// As [`dynamics`](Self::dynamics), with the constraints at `q` given and J a = −J̇ q̇ − feedback(row).
    pub(super) fn dynamics_with<S: Real>(
        &self,
        constraints: &Constraints<S, M, C>,
        q: &M::Coordinates,
        v: &M::Velocities,
        tau: &M::Velocities,
        feedback: impl Fn(usize) -> S,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
    {
        let bias = self.closure.loop_bias(q, v);
        let wanted = C::Rows::from_fn(self.closure.nc(), |row| -entry(&bias, row) - feedback(row));
        let of_tree = self.mechanism.bias_forces(q, v);
        constraints.motion(&wanted, M::Velocities::from_fn(self.mechanism.nv(), |i| entry(tau, i) - entry(&of_tree, i)))
    }
}

impl<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> Constraints<S, M, C> {
    /// The accelerations a and the multipliers λ with M a = `drive` + Jᵀ λ and J a = `wanted`, as far as this can be
    /// reached.
    pub(super) fn motion(
        &self,
        wanted: &C::Rows,
        drive: M::Velocities,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>> {
        let WeightedRows { metric, decomposition } = &self.weighted;
        // In scaled coordinates: s = s₀ + Wᵀ λ with W s = b, so that Q s = R⁻¹ Tᵀ b.
        let mut scaled = drive;
        metric.scale(&mut scaled);
        let change = difference(&decomposition.solve(wanted), &decomposition.coordinates(&scaled));
        let by_loops = decomposition.combination(&change);
        for (scaled, &by_loops) in scaled.as_mut().iter_mut().zip(by_loops.as_ref()) {
            *scaled += by_loops;
        }
        metric.unscale(&mut scaled);
        let mut multipliers = decomposition.multipliers(&change);
        if self.augmentation != S::zero() {
            // Of w Jᵀ J a, which the metric has on the side of the inertia, what can be reached of J a.
            let missed = decomposition.unreachable(wanted);
            add_scaled(multipliers.as_mut(), -self.augmentation, difference(wanted, &missed).as_ref());
        }
        let finite = |values: &[S]| largest(values.iter().copied()).0.is_finite();
        if !(finite(scaled.as_ref()) && finite(multipliers.as_ref())) {
            return Err(LoopError::NotFinite);
        }
        Ok(ConstrainedMotion { accelerations: scaled, multipliers, rank: decomposition.rank() })
    }
}
