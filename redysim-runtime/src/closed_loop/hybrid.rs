//! Hybrid dynamics of closed loops: some accelerations are given, and the forces that they take are found.

use super::constraints::{Constraints, Metric};
use super::independent::{check_independent, roundoff_tolerance};
use super::{ClosedLoop, ConstrainedMotion, LoopError};
use crate::linear_algebra::{add_scaled, dot, largest};
use crate::vector::entry;
use crate::{HybridMotion, InverseDynamics, LoopClosure, MassMatrix, Real, Vector};

/// Accelerations, joint forces and constraint forces.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstrainedHybridMotion<V, R> {
    /// Accelerations and forces of all joints, those that are given among them.
    pub motion: HybridMotion<V>,
    /// λ, one for each row; sign and order as in [`ConstrainedMotion`]. Of all that have the same effect on the joints
    /// that are not driven, the shortest.
    pub multipliers: R,
    /// How many rows are independent of each other at this position for the joints that are not driven.
    pub rank: usize,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// The accelerations a, the joint forces τ and the multipliers λ with M a + h = τ + Jᵀ λ and J a = −J̇ q̇, where `u` has
    /// the acceleration of each velocity in `driven` and the joint force of each other: of a robot with closed chains on a
    /// free base, the motion of the base and the forces of the actuators, if `driven` are those that determine its chains.
    ///
    /// With the other velocities p, M_pp a_p = u_p − h_p − M_pd u_d + J_pᵀ λ and J_p a_p = −J̇ q̇ − J_d u_d, which is solved as
    /// [`dynamics`](Self::dynamics) solves it; then τ_d = M_d a + h_d − J_dᵀ λ. Without loops this is
    /// [`HybridDynamics`](crate::HybridDynamics) with another choice of driven joints.
    ///
    /// # Errors
    /// [`LoopError::InconsistentVelocity`] if the loops do not admit the given accelerations,
    /// [`LoopError::VelocityOutOfRange`] and [`LoopError::RepeatedVelocity`] for `driven`, and as
    /// [`dynamics`](Self::dynamics).
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn hybrid_dynamics<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
        u: &M::Velocities,
        driven: &[usize],
    ) -> Result<ConstrainedHybridMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        check_independent(driven, self.mechanism.nv())?;
        let constraints = self.constraints_in(Metric::Mass, q, driven)?;
        self.hybrid_dynamics_with(&constraints, (q, v, u), driven, |_| S::zero())
    }

    /// As [`hybrid_dynamics`](Self::hybrid_dynamics), with the constraints at `q` given, the velocities `driven` held, and
    /// J a = −J̇ q̇ − feedback(row).
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub(super) fn hybrid_dynamics_with<S: Real>(
        &self,
        constraints: &Constraints<S, M, C>,
        (q, v, u): (&M::Coordinates, &M::Velocities, &M::Velocities),
        driven: &[usize],
        feedback: impl Fn(usize) -> S,
    ) -> Result<ConstrainedHybridMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        let Self { mechanism, closure } = self;
        let nv = mechanism.nv();
        let is_driven = |velocity: &usize| driven.contains(velocity);
        let given = M::Velocities::from_fn(nv, |i| if is_driven(&i) { entry(u, i) } else { S::zero() });
        let of_given = mechanism.inverse_dynamics(q, v, &given);
        let drive = |i: usize| if is_driven(&i) { S::zero() } else { entry(u, i) - entry(&of_given, i) };
        let bias = closure.loop_bias(q, v);
        let bias = C::Rows::from_fn(closure.nc(), |row| entry(&bias, row) + feedback(row));
        let rows = constraints.jacobian.as_ref();
        let rate = |row: usize, x: &M::Velocities| rows.get(row).map_or(S::zero(), |row| dot(row.as_ref(), x.as_ref()));
        let wanted = C::Rows::from_fn(closure.nc(), |row| -entry(&bias, row) - rate(row, &given));
        let found = constraints.motion(&wanted, M::Velocities::from_fn(nv, drive))?;
        let ConstrainedMotion { accelerations: mut a, multipliers, rank } = found;
        add_scaled(a.as_mut(), S::one(), given.as_ref());
        let (residual, row) = largest((0..closure.nc()).map(|row| rate(row, &a) + entry(&bias, row)));
        let size = largest(a.as_ref().iter().chain(bias.as_ref()).copied()).0;
        if residual > roundoff_tolerance::<S>() * (S::one() + size) {
            return Err(LoopError::InconsistentVelocity { residual, row });
        }
        let mut forces = mechanism.inverse_dynamics(q, v, &a);
        for (row, &multiplier) in rows.iter().zip(multipliers.as_ref()) {
            add_scaled(forces.as_mut(), -multiplier, row.as_ref());
        }
        if !largest(forces.as_ref().iter().copied()).0.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let tau = M::Velocities::from_fn(nv, |i| if is_driven(&i) { entry(&forces, i) } else { entry(u, i) });
        Ok(ConstrainedHybridMotion { motion: HybridMotion { a, tau }, multipliers, rank })
    }
}
