//! Inverse dynamics of closed loops: joint forces for a trajectory of the independent coordinates.

use super::closing::Ending;
use super::linear::{add_scaled, difference, dot, largest, product, zeros};
use super::linearised::{Metric, without};
use super::row_space::RowSpace;
use super::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{InverseDynamics, LoopClosure, MassMatrix, Motion, Real, Trajectory, Vector};

/// An independent coordinate moves by no more than this from one closed position to the next, rad or m, so that the
/// branch is kept between instants far apart. Where that takes more than `MOST_MOVES`, the moves are longer.
const LARGEST_MOVE: f64 = 0.1;
const MOST_MOVES: usize = 10_000;
const ITERATIONS: usize = 100;
/// What a force may miss, as a part of the largest, before it counts as unsupported; likewise speeds.
const SMALL: f64 = 1e-9;

/// Finds the joint forces that make a mechanism with closed loops follow a trajectory of its independent coordinates,
/// instant by instant: positions by Newton's method from the previous instant, velocities and accelerations from the
/// loops, then the forces of the actuators together with the multipliers.
#[derive(Debug)]
pub struct ClosedLoopInverse<'m, M, Q, C = M> {
    loops: ClosedLoop<'m, M, C>,
    independent: &'m [usize],
    actuated: &'m [usize],
    q: Q,
}

/// The motion and the forces at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopForces<Q, V, R> {
    /// Coordinates, velocities and accelerations of all joints.
    pub motion: Motion<Q, V>,
    /// Joint forces, N m or N; zero where no actuator is.
    pub forces: V,
    /// λ, one for each row; sign and order as in [`ConstrainedMotion`](super::ConstrainedMotion).
    pub multipliers: R,
    /// How many rows are independent at this position.
    pub rank: usize,
    /// How many actuators there are more than the motion needs. If any, |τ|² + |λ|² is the least.
    pub redundancy: usize,
}

impl<'m, M, Q, C> ClosedLoopInverse<'m, M, Q, C> {
    /// The inverse dynamics of `loops` with the coordinates `independent` prescribed (and actuated), beginning on the
    /// branch of the guess `q`.
    pub fn new(loops: ClosedLoop<'m, M, C>, independent: &'m [usize], q: Q) -> Self {
        Self { loops, independent, actuated: independent, q }
    }

    /// Sets which joints have actuators, if not just the independent ones.
    pub fn actuated(self, actuated: &'m [usize]) -> Self {
        Self { actuated, ..self }
    }

    /// The motion and the forces at time `t`. Component i of the trajectory belongs to coordinate `independent[i]`. The
    /// position found is the guess for the next instant.
    ///
    /// # Errors
    /// [`LoopError::Unreachable`], [`LoopError::LostRank`] if the independent coordinates do not determine the others,
    /// [`LoopError::PullsApart`] if they contradict each other, [`LoopError::Unsupported`] if there are too few
    /// actuators, [`LoopError::WrongTrajectory`], [`LoopError::RepeatedCoordinate`], [`LoopError::BadCoordinate`],
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
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
        let ClosedLoop { mechanism, closure } = self.loops;
        let count = mechanism.nv();
        if let Some(&coordinate) = self.independent.iter().chain(self.actuated).find(|&&index| index >= count) {
            return Err(LoopError::BadCoordinate { coordinate, count });
        }
        if let Some(&coordinate) = repeated(self.independent) {
            return Err(LoopError::RepeatedCoordinate { coordinate });
        }
        let wanted = trajectory.at(t);
        for given in [&wanted.q, &wanted.v, &wanted.a].map(|part| part.as_ref().len()) {
            if given != self.independent.len() {
                return Err(LoopError::WrongTrajectory { given, wanted: self.independent.len() });
            }
        }
        let q = self.follow(t, &wanted.q)?;
        let jacobian = closure.loop_jacobian(&q);
        let dependent = self.without_columns(&jacobian, self.independent)?;
        let needed = count - self.independent.len();
        if dependent.rank() < needed {
            return Err(LoopError::LostRank { rank: dependent.rank(), needed, rows: dependent.dependent_rows() });
        }
        // J_d x_d = b − J_i x_i.
        let complete = |given: &I, bias: &C::Rows| {
            let mut x: M::Velocities = zeros(count);
            self.prescribe(&mut x, given);
            for _ in 0..2 {
                let rates: C::Rows = product(jacobian.as_ref(), x.as_ref());
                let missing = C::Rows::from_fn(closure.nc(), |row| entry(&rates, row) + entry(bias, row));
                x = difference(&x, &dependent.combination(&dependent.solve(&missing)));
            }
            x
        };
        let v = complete(&wanted.v, &zeros(closure.nc()));
        let rates: C::Rows = product(jacobian.as_ref(), v.as_ref());
        let (rate, row) = largest(rates.as_ref().iter().copied());
        let small = S::from_f64(SMALL).maximum(S::from_f64(1000.0) * S::EPSILON);
        if rate > small * (S::one() + largest(v.as_ref().iter().copied()).0) {
            return Err(LoopError::PullsApart { rate, row });
        }
        let bias = closure.loop_bias(&q, &v);
        let a = complete(&wanted.a, &bias);
        let rates: C::Rows = product(jacobian.as_ref(), a.as_ref());
        let misses = (0..closure.nc()).map(|row| entry(&rates, row) + entry(&bias, row));
        let (rate, row) = largest(misses);
        if rate > small * (S::one() + largest(a.as_ref().iter().chain(bias.as_ref()).copied()).0) {
            return Err(LoopError::PullsApart { rate, row });
        }
        let of_tree = mechanism.inverse_dynamics(&q, &v, &a);
        if !largest(of_tree.as_ref().iter().copied()).0.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let rank = self.without_columns(&jacobian, &[])?.rank();
        let unactuated = self.without_columns(&jacobian, self.actuated)?;
        let multipliers = self.multipliers(&jacobian, &unactuated, &of_tree);
        let mut forces = of_tree.clone();
        for (row, &multiplier) in jacobian.as_ref().iter().zip(multipliers.as_ref()) {
            add_scaled(forces.as_mut(), -multiplier, row.as_ref());
        }
        let (most, _) = largest(of_tree.as_ref().iter().copied());
        for (coordinate, force) in forces.as_mut().iter_mut().enumerate() {
            if !self.actuated.contains(&coordinate) {
                if force.abs() > small * most {
                    return Err(LoopError::Unsupported { coordinate, force: *force });
                }
                *force = S::zero();
            }
        }
        self.q = q.clone();
        let redundancy = rank - unactuated.rank().min(rank);
        Ok(LoopForces { motion: Motion { q, v, a }, forces, multipliers, rank, redundancy })
    }

    /// The closed position with the independent coordinates at `wanted`, on the branch of the previous one.
    fn follow<S: Real, I: Vector<S>>(&self, t: S, wanted: &I) -> Result<Q, LoopError<S>>
    where
        M: MassMatrix<S, Coordinates = Q>,
        C: LoopClosure<S, M>,
        Q: Vector<S>,
    {
        let mut q = self.q.clone();
        let ways = self.independent.iter().enumerate().map(|(i, &index)| entry(wanted, i) - entry(&q, index));
        let (farthest, at) = largest(ways);
        if !farthest.is_finite() {
            return Err(LoopError::NotFinite);
        }
        let moves = (farthest.to_f64() / LARGEST_MOVE) as usize + 1;
        let moves = moves.min(MOST_MOVES);
        for left in (0..moves).rev() {
            let part = S::one() / S::from_f64((left + 1) as f64);
            for (i, &index) in self.independent.iter().enumerate() {
                let target = entry(wanted, i);
                if let Some(element) = q.as_mut().get_mut(index) {
                    *element = if left == 0 { target } else { *element + part * (target - *element) };
                }
            }
            let closing = self.loops.close(Metric::Mass, q, self.independent, ITERATIONS)?;
            if closing.ending != Ending::Closed {
                let coordinate = self.independent.get(at).copied().unwrap_or(0);
                return Err(LoopError::Unreachable { t, coordinate, gap: closing.gap });
            }
            q = closing.q;
        }
        Ok(q)
    }

    /// The shortest [τ; λ]: λ = λ₀ + y, where λ₀ balances the joints without actuators and y is none of their business,
    /// (1 + P J_a J_aᵀ P) y = P J_a (τ_a − J_aᵀ λ₀), with P onto what they do not feel.
    fn multipliers<S: Real>(
        &self,
        jacobian: &C::Jacobian,
        unactuated: &RowSpace<S, M, C>,
        of_tree: &M::Velocities,
    ) -> C::Rows
    where
        M: InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        let nc = self.loops.closure.nc();
        let mut of_unactuated = of_tree.clone();
        without(&mut of_unactuated, self.actuated);
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

    /// The rows of J without the columns of the coordinates `known`.
    fn without_columns<S: Real>(
        &self,
        jacobian: &C::Jacobian,
        known: &[usize],
    ) -> Result<RowSpace<S, M, C>, LoopError<S>>
    where
        M: InverseDynamics<S>,
        C: LoopClosure<S, M>,
    {
        let mut rows = jacobian.clone();
        for row in rows.as_mut() {
            without(row, known);
        }
        RowSpace::new(rows, self.loops.mechanism.nv())
    }

    fn prescribe<S: Real, V: Vector<S>, I: Vector<S>>(&self, x: &mut V, given: &I) {
        for (i, &index) in self.independent.iter().enumerate() {
            if let Some(element) = x.as_mut().get_mut(index) {
                *element = entry(given, i);
            }
        }
    }
}

/// The first number that stands there before.
fn repeated(indices: &[usize]) -> Option<&usize> {
    indices.iter().enumerate().find(|(i, a)| indices.iter().take(*i).any(|b| b == *a)).map(|(_, a)| a)
}
