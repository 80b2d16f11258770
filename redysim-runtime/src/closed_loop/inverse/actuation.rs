//! The forces of the actuators for given accelerations of the independent joints.

use super::LoopForces;
use crate::closed_loop::constraints::{LoopDecomposition, zero_columns};
use crate::closed_loop::independent::{Completion, check_independent, roundoff_tolerance, without_columns};
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::linear_algebra::{add_scaled, dot, largest, product, zeros};
use crate::vector::entry;
use crate::{InverseDynamics, LengthMismatch, LoopClosure, Mechanism, Motion, Real, Vector};

/// Closed loops, the velocities that determine all others, and those that have actuators.
#[derive(Clone, Copy, Debug)]
pub(super) struct Actuation<'m, M, C> {
    pub loops: ClosedLoop<'m, M, C>,
    pub independent: &'m [usize],
    pub actuated: &'m [usize],
}

impl<M, C> Actuation<'_, M, C> {
    /// Checks that all velocities exist, that no independent one is repeated, and that each of these has a coordinate.
    pub fn check<S: Real>(&self) -> Result<(), LoopError<S>>
    where
        M: InverseDynamics<S>,
    {
        let count = self.loops.mechanism.nv();
        check_independent(self.independent, count)?;
        if let Some(&velocity) = self.actuated.iter().find(|&&index| index >= count) {
            return Err(LoopError::VelocityOutOfRange { velocity, count });
        }
        match self.independent.iter().zip(self.coordinates()).find(|(_, coordinate)| coordinate.is_none()) {
            Some((&velocity, _)) => Err(LoopError::NoCoordinate { velocity }),
            None => Ok(()),
        }
    }

    /// The coordinates of the independent velocities, in their order; `None` for one whose joint has several.
    pub fn coordinates(&self) -> impl Iterator<Item = Option<usize>> + '_
    where
        M: Mechanism,
    {
        self.independent.iter().map(|&velocity| self.loops.mechanism.coordinate_of_velocity(velocity))
    }

    /// Checks that a trajectory has a component for each independent velocity.
    pub fn check_motion<S: Real, I: Vector<S>>(&self, wanted: &Motion<I, I>) -> Result<(), LengthMismatch> {
        let Motion { q, v, a } = wanted;
        self.check_lengths([("trajectory.q", q), ("trajectory.v", v), ("trajectory.a", a)])
    }

    /// Checks that vectors have a component for each independent velocity.
    pub fn check_lengths<S: Real, I: Vector<S>, const N: usize>(
        &self,
        vectors: [(&'static str, &I); N],
    ) -> Result<(), LengthMismatch> {
        let expected = self.independent.len();
        vectors.into_iter().try_for_each(|(name, vector)| LengthMismatch::check(name, vector.as_ref(), expected))
    }

    /// Motion and forces at the closed position `q` for these velocities and accelerations of the independent joints.
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn forces<S: Real, I: Vector<S>>(
        &self,
        q: M::Coordinates,
        v_independent: &I,
        a_independent: &I,
    ) -> Result<LoopForces<M::Coordinates, M::Velocities, C::Rows>, LoopError<S>>
    where
        M: InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        let ClosedLoop { mechanism, closure } = self.loops;
        let completion = Completion::new(self.loops, &q, self.independent)?;
        let jacobian = &completion.jacobian;
        let v = completion.complete(v_independent, &zeros(closure.nc()))?;
        let a = completion.complete(a_independent, &closure.loop_bias(&q, &v))?;
        let of_tree = mechanism.inverse_dynamics(&q, &v, &a);
        if !largest(of_tree.as_ref().iter().copied()).0.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let rank = without_columns::<S, M, C>(mechanism, jacobian, &[])?.rank();
        let unactuated = without_columns::<S, M, C>(mechanism, jacobian, self.actuated)?;
        let multipliers = self.multipliers(jacobian, &unactuated, &of_tree);
        let mut forces = of_tree.clone();
        for (row, &multiplier) in jacobian.as_ref().iter().zip(multipliers.as_ref()) {
            add_scaled(forces.as_mut(), -multiplier, row.as_ref());
        }
        let small = roundoff_tolerance::<S>();
        let (most, _) = largest(of_tree.as_ref().iter().copied());
        for (velocity, force) in forces.as_mut().iter_mut().enumerate() {
            if !self.actuated.contains(&velocity) {
                if force.abs() > small * most {
                    return Err(LoopError::Unactuated { velocity, force: *force });
                }
                *force = S::zero();
            }
        }
        let redundancy = rank - unactuated.rank().min(rank);
        Ok(LoopForces { motion: Motion { q, v, a }, forces, multipliers, rank, redundancy })
    }

    /// The shortest [τ; λ]: λ = λ₀ + y, where λ₀ balances the joints without actuators and y does not act on them,
    /// (1 + P J_a J_aᵀ P) y = P J_a (τ_a − J_aᵀ λ₀), with P the projection onto the multipliers that do not.
    fn multipliers<S: Real>(
        &self,
        jacobian: &C::Jacobian,
        unactuated: &LoopDecomposition<S, M, C>,
        of_tree: &M::Velocities,
    ) -> C::Rows
    where
        M: InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        let nc = self.loops.closure.nc();
        let mut of_unactuated = of_tree.clone();
        zero_columns(&mut of_unactuated, self.actuated);
        let mut multipliers = unactuated.multipliers(&unactuated.coordinates(&of_unactuated));
        if unactuated.rank() == nc {
            return multipliers;
        }
        let mut rest = of_tree.clone();
        for (row, &multiplier) in jacobian.as_ref().iter().zip(multipliers.as_ref()) {
            add_scaled(rest.as_mut(), -multiplier, row.as_ref());
        }
        // Columns of P J_a, one after the other: y is found by the rank-one updates of a recursive least-norm solution.
        let mut inverse = C::Gram::from_fn(nc, |i| {
            let unit = C::Rows::from_fn(nc, |j| if i == j { S::one() } else { S::zero() });
            unactuated.unreachable(&unit)
        });
        let distinct =
            self.actuated.iter().enumerate().filter(|(i, a)| !self.actuated.iter().take(*i).any(|b| b == *a));
        let mut y: C::Rows = zeros(nc);
        for (_, &index) in distinct {
            let column = C::Rows::from_fn(nc, |i| jacobian.as_ref().get(i).map_or(S::zero(), |row| entry(row, index)));
            let gain: C::Rows = product(inverse.as_ref(), column.as_ref());
            let size = S::one() + dot(column.as_ref(), gain.as_ref());
            let missing = (entry(&rest, index) - dot(column.as_ref(), y.as_ref())) / size;
            add_scaled(y.as_mut(), missing, gain.as_ref());
            for (row, &factor) in inverse.as_mut().iter_mut().zip(gain.as_ref()) {
                add_scaled(row.as_mut(), -factor / size, gain.as_ref());
            }
        }
        add_scaled(multipliers.as_mut(), S::one(), y.as_ref());
        multipliers
    }
}
