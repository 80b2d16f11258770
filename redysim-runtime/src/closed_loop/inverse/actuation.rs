//! The forces of the actuators for given accelerations of the independent joints.

use super::LoopForces;
use crate::closed_loop::constraints::{LoopDecomposition, zero_columns};
use crate::closed_loop::independent::{Completion, check_independent, roundoff_tolerance, without_columns};
use crate::closed_loop::{ClosedLoop, LoopError};
use crate::linear_algebra::{add_scaled, dot, largest, product, zeros};
use crate::vector::entry;
use crate::{
    ConfigurationSpace, InverseDynamics, LengthMismatch, LoopClosure, Mechanism, Motion, Real, Vector,
    VelocityCoordinates,
};

/// Closed loops, the velocities that determine all others, and those that have actuators.
#[derive(Clone, Copy, Debug)]
pub(super) struct Actuation<'m, M, C> {
    pub loops: ClosedLoop<'m, M, C>,
    pub independent: &'m [usize],
    pub actuated: &'m [usize],
}

impl<M, C> Actuation<'_, M, C> {
    /// Checks that all velocities exist, that no independent one is repeated, and that a trajectory can prescribe each.
    pub fn check<S: Real>(&self) -> Result<(), LoopError<S>>
    where
        M: InverseDynamics<S>,
    {
        let count = self.loops.mechanism.nv();
        check_independent(self.independent, count)?;
        if let Some(&velocity) = self.actuated.iter().find(|&&index| index >= count) {
            return Err(LoopError::VelocityOutOfRange { velocity, count });
        }
        self.independent.iter().try_for_each(|&velocity| self.check_prescribed(velocity))
    }

    /// Checks that the independent velocities determine the coordinates that this one of them changes: of an orientation all
    /// three, of a position in the axes of its link those of the orientation too.
    fn check_prescribed<S>(&self, velocity: usize) -> Result<(), LoopError<S>>
    where
        M: Mechanism,
    {
        let mechanism = self.loops.mechanism;
        let all_that_change = |coordinates: VelocityCoordinates| {
            let missing = (0..mechanism.nv())
                .find(|i| mechanism.coordinates_of_velocity(*i) == coordinates && !self.independent.contains(i));
            missing.map_or(Ok(()), |missing| Err(LoopError::PartOfJoint { velocity, missing }))
        };
        match mechanism.coordinates_of_velocity(velocity) {
            VelocityCoordinates::One(_) => Ok(()),
            orientation @ VelocityCoordinates::Quaternion(_) => all_that_change(orientation),
            position @ VelocityCoordinates::Position(first) => {
                all_that_change(position).and_then(|()| all_that_change(VelocityCoordinates::Quaternion(first + 3)))
            }
            VelocityCoordinates::Unknown => Err(LoopError::NoCoordinate { velocity }),
        }
    }

    /// The independent coordinates, those that the independent velocities change, in the order of a trajectory: that of the
    /// velocities, each coordinate once.
    fn coordinates(&self) -> impl Iterator<Item = usize> + '_
    where
        M: Mechanism,
    {
        let changed_by = |velocity: usize| self.loops.mechanism.coordinates_of_velocity(velocity);
        let is_new = move |(i, velocity): &(usize, &usize)| {
            !self.independent.iter().take(*i).any(|earlier| changed_by(*earlier) == changed_by(**velocity))
        };
        let velocities = self.independent.iter().enumerate().filter(is_new);
        velocities.flat_map(move |(_, &velocity)| changed_by(velocity).indices())
    }

    /// Checks that a trajectory has an element for each independent coordinate and velocity.
    pub fn check_motion<S: Real, P: Vector<S>, I: Vector<S>>(&self, wanted: &Motion<P, I>) -> Result<(), LengthMismatch>
    where
        M: Mechanism,
    {
        LengthMismatch::check("trajectory.q", wanted.q.as_ref(), self.coordinates().count())?;
        self.check_lengths([("trajectory.v", &wanted.v), ("trajectory.a", &wanted.a)])
    }

    /// Checks that vectors have an element for each independent velocity.
    pub fn check_lengths<S: Real, I: Vector<S>, const N: usize>(
        &self,
        vectors: [(&'static str, &I); N],
    ) -> Result<(), LengthMismatch> {
        let expected = self.independent.len();
        vectors.into_iter().try_for_each(|(name, vector)| LengthMismatch::check(name, vector.as_ref(), expected))
    }

    /// The position `q` with these independent coordinates.
    pub fn moved_to<S: Real, P: Vector<S>>(&self, mut q: M::Coordinates, independent: &P) -> M::Coordinates
    where
        M: ConfigurationSpace<S>,
    {
        for (coordinate, &value) in self.coordinates().zip(independent.as_ref()) {
            if let Some(element) = q.as_mut().get_mut(coordinate) {
                *element = value;
            }
        }
        q
    }

    /// The independent components of a vector with one element for each velocity.
    pub fn independent_of<S: Real, V: Vector<S>, I: Vector<S>>(&self, velocities: &V) -> I {
        I::from_fn(self.independent.len(), |i| match self.independent.get(i) {
            Some(&velocity) => entry(velocities, velocity),
            None => S::from_f64(f64::NAN),
        })
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
