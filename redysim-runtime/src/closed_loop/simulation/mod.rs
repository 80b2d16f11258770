//! Forward simulation of mechanisms with closed loops: the part of `closed_loop` that needs the integrators.

mod hybrid;
mod stabilisation;

use core::iter::once;

use super::constraints::{Constraints, length_scale};
use super::position::ProjectedPoint;
use super::{Assembly, ClosedLoop, ConstrainedMotion, LoopError};
use crate::integrate::{Accepted, Tolerances};
use crate::linear_algebra::{dot, largest, product};
use crate::simulate::{check_state, constrain_coordinates, extended_state, law_torque, write_coordinate_rates};
use crate::tangent;
use crate::vector::entry;
use crate::{
    BiasForces, ConfigurationSpace, ForwardSimulation, LengthMismatch, LoopClosure, MassMatrix, Ode, Real,
    SimulationState, TorqueLaw, Vector,
};

pub use hybrid::ClosedLoopHybridSimulation;
pub use stabilisation::Stabilisation;

/// A start may be open by this part of the mechanism's size, and its velocity violate the constraints by this part of
/// its speed.
const OPEN: f64 = 1e-8;

/// A mechanism with closed loops, moved by a torque law, as an [`Ode`] in the state y = [q, q̇, E_act] of a
/// [`ForwardSimulation`]. It runs with every integrator.
///
/// Accelerations are those of [`ClosedLoop::dynamics`]; [`Stabilisation`] says what keeps the loops closed, by default
/// the projection after each accepted step. When an integration ends with an error,
/// [`last_error`](Self::last_error) has the loops' own reason, if it was theirs.
#[derive(Debug)]
pub struct ClosedLoopSimulation<'m, S, M, L, C = M> {
    loops: ClosedLoop<'m, M, C>,
    law: L,
    stabilisation: Stabilisation<S>,
    last_error: Option<LoopError<S>>,
}

/// The motion in a state with the joint forces that act there.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ForcedMotion<V, R> {
    /// The joint forces of the torque law, N m or N.
    pub tau: V,
    /// Accelerations, multipliers and rank.
    pub motion: ConstrainedMotion<V, R>,
}

/// Where the derivative is evaluated, and the constraints there.
struct EvaluationPoint<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    q: M::Coordinates,
    v: M::Velocities,
    constraints: Constraints<S, M, C>,
}

impl<'m, S: Real, M, L, C> ClosedLoopSimulation<'m, S, M, L, C> {
    /// The simulation of `loops` under `law`.
    pub fn new(loops: ClosedLoop<'m, M, C>, law: L) -> Self {
        Self { loops, law, stabilisation: Stabilisation::default(), last_error: None }
    }

    /// Sets what keeps the loops closed.
    pub fn stabilisation(self, stabilisation: Stabilisation<S>) -> Self {
        Self { stabilisation, ..self }
    }

    /// The mechanism and its closure.
    pub fn loops(&self) -> ClosedLoop<'m, M, C> {
        self.loops
    }

    /// The torque law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// What went wrong in the loops when a derivative was evaluated or a step corrected last; `None` if nothing did.
    pub fn last_error(&self) -> Option<LoopError<S>> {
        self.last_error
    }

    /// The state [q, v, 0] to start from.
    ///
    /// # Errors
    /// A start that leaves loops open is refused with [`LoopError::NotClosed`], one whose velocities violate the
    /// constraints with [`LoopError::InconsistentVelocity`]: [`ClosedLoop::assemble`] finds one that fits.
    /// [`state`](Self::state) takes any.
    pub fn start(&self, q: &M::Coordinates, v: &M::Velocities) -> Result<M::State, LoopError<S>>
    where
        M: ConfigurationSpace<S>,
        C: LoopClosure<S, M>,
    {
        let closure = self.loops.closure;
        let jacobian = closure.loop_jacobian(q);
        let scale = length_scale(jacobian.as_ref());
        let (position_residual, row) = largest(closure.loop_residual(q).as_ref().iter().copied());
        let small = S::from_f64(OPEN).maximum(S::from_f64(100.0) * S::EPSILON);
        if position_residual > small * scale {
            return Err(LoopError::NotClosed { position_residual, row });
        }
        let rates: C::Rows = product(jacobian.as_ref(), v.as_ref());
        let (residual, row) = largest(rates.as_ref().iter().copied());
        let (fastest, _) = largest(v.as_ref().iter().copied());
        if residual > small * scale * fastest {
            return Err(LoopError::InconsistentVelocity { residual, row });
        }
        if !(position_residual.is_finite() && residual.is_finite() && fastest.is_finite()) {
            return Err(LoopError::NotFinite);
        }
        Ok(self.state(q, v))
    }

    /// The state [q, v, 0] to start from an [`Assembly`].
    pub fn assembled(&self, assembly: &Assembly<S, M::Coordinates, M::Velocities>) -> M::State
    where
        M: ConfigurationSpace<S>,
    {
        self.state(&assembly.q, &assembly.v)
    }

    /// The state [q, v, 0], whether or not the loops are closed there.
    pub fn state(&self, q: &M::Coordinates, v: &M::Velocities) -> M::State
    where
        M: ConfigurationSpace<S>,
    {
        ForwardSimulation::new(self.loops.mechanism, ()).state(q, v)
    }

    /// The state [q, v, 0, z] with the law's states z, as that of
    /// [`ForwardSimulation::extended_state`](crate::ForwardSimulation::extended_state), whether or not the loops are
    /// closed there.
    pub fn extended_state<Y: Vector<S>>(&self, q: &M::Coordinates, v: &M::Velocities) -> Y
    where
        M: ConfigurationSpace<S>,
        L: TorqueLaw<S, M>,
    {
        extended_state(self.loops.mechanism, &self.law, q, v)
    }

    /// The parts of a state. What a `Vec` lacks is NaN.
    pub fn split<Y: Vector<S>>(&self, state: &Y) -> SimulationState<S, M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
    {
        ForwardSimulation::new(self.loops.mechanism, ()).split(state)
    }

    /// Accelerations, multipliers and rank in a state, as the simulation sees them.
    ///
    /// # Errors
    /// As [`ClosedLoop::dynamics`].
    pub fn motion<Y: Vector<S>>(
        &mut self,
        t: S,
        state: &Y,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
        L: TorqueLaw<S, M>,
    {
        self.forced_motion(t, state).map(|forced| forced.motion)
    }

    /// As [`motion`](Self::motion), with the joint forces of the law.
    ///
    /// # Errors
    /// As [`ClosedLoop::dynamics`].
    pub fn forced_motion<Y: Vector<S>>(
        &mut self,
        t: S,
        state: &Y,
    ) -> Result<ForcedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
        L: TorqueLaw<S, M>,
    {
        let SimulationState { q, v, .. } = self.split(state);
        let tau = law_torque(&mut self.law, self.loops.mechanism, t, (&q, &v), (state, &mut state.clone()));
        let motion = self.constrained(&self.loops.constraints_at(&q)?, &q, &v, &tau)?;
        Ok(ForcedMotion { tau, motion })
    }

    /// Where the derivative at a state is evaluated: the state itself, or, with the projection near a singular position
    /// or with redundant rows, the nearest one that keeps the loops closed. In a state that is slightly open, rows
    /// contradict each other, and the rank may be another.
    fn evaluation_point(&self, state: &impl Vector<S>) -> Result<EvaluationPoint<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let SimulationState { q, v, .. } = self.split(state);
        let constraints = self.loops.constraints_at(&q)?;
        if self.stabilisation == Stabilisation::Projection
            && !constraints.are_regular(self.loops.closure.nc())
            && let Ok(ProjectedPoint { projection, constraints }) = self.loops.project_with_constraints(&q, &v, &[])
        {
            return Ok(EvaluationPoint { q: projection.q, v: projection.v, constraints });
        }
        Ok(EvaluationPoint { q, v, constraints })
    }

    fn constrained(
        &self,
        constraints: &Constraints<S, M, C>,
        q: &M::Coordinates,
        v: &M::Velocities,
        tau: &M::Velocities,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
    {
        let Stabilisation::Baumgarte { alpha } = self.stabilisation else {
            return self.loops.dynamics_with(constraints, q, v, tau, |_| S::zero());
        };
        let residual = self.loops.closure.loop_residual(q);
        let rates: C::Rows = product(constraints.jacobian.as_ref(), v.as_ref());
        self.loops.dynamics_with(constraints, q, v, tau, |row| {
            let rate = entry(&rates, row);
            alpha * (rate + rate + alpha * entry(&residual, row))
        })
    }
}

/// Writes the rates of coordinates, velocities and energy to the first elements of `rate`, or not a number to all where
/// the loops could not be solved: then the reason is returned.
fn write_rates<S: Real, Q: Vector<S>, V: Vector<S>>(
    found: Result<(Q, V, S), LoopError<S>>,
    rate: &mut impl Vector<S>,
) -> Option<LoopError<S>> {
    match found {
        Err(error) => {
            rate.as_mut().fill(S::from_f64(f64::NAN));
            Some(error)
        }
        Ok((rates, accelerations, power)) => {
            let values = rates.as_ref().iter().chain(accelerations.as_ref()).chain(once(&power));
            for (rate, &value) in rate.as_mut().iter_mut().zip(values) {
                *rate = value;
            }
            None
        }
    }
}

impl<S, Y, M, L, C> Ode<S, Y> for ClosedLoopSimulation<'_, S, M, L, C>
where
    S: Real,
    Y: Vector<S>,
    M: MassMatrix<S> + BiasForces<S>,
    L: TorqueLaw<S, M>,
    C: LoopClosure<S, M>,
{
    fn check_lengths(&self, t: S, state: &Y) -> Result<(), LengthMismatch> {
        check_state(self.loops.mechanism, &self.law, state)?;
        self.law.check_lengths(t, self.loops.mechanism)
    }

    /// Not a number where the loops cannot be solved; [`last_error`](Self::last_error) then says why.
    fn derivative(&mut self, t: S, state: &Y, rate: &mut Y) {
        let taken = self.evaluation_point(state).and_then(|EvaluationPoint { q, v, constraints }| {
            let tau = law_torque(&mut self.law, self.loops.mechanism, t, (&q, &v), (state, rate));
            let motion = self.constrained(&constraints, &q, &v, &tau)?;
            let mechanism = self.loops.mechanism;
            let power = dot(tau.as_ref(), v.as_ref()) - mechanism.dissipated_power(&q, &v);
            Ok((mechanism.coordinate_rates(&q, &v), motion.accelerations, power))
        });
        self.last_error = write_rates(taken, rate);
    }

    fn interpolated(&mut self, _t: S, state: &mut Y) {
        constrain_coordinates(self.loops.mechanism, state);
    }

    fn project_onto_tangent(&self, state: &Y, direction: &mut Y) {
        tangent::project(self.loops.mechanism, state, direction);
    }

    fn error_norm(&self, tolerances: &Tolerances<'_, S>, error: &Y, y: &Y, z: &Y) -> S {
        tangent::error_norm(self.loops.mechanism, tolerances, error, (y, z))
    }

    fn coordinate_rates(&mut self, _t: S, state: &Y, rates: &mut Y) -> usize {
        let SimulationState { q, v, .. } = self.split(state);
        write_coordinate_rates(self.loops.mechanism, (&q, &v), rates)
    }

    fn accepted(&mut self, _t: S, step: S, state: &mut Y) -> Accepted {
        let constrained = constrain_coordinates(self.loops.mechanism, state);
        let corrected = self.stabilisation.check(step).and_then(|()| match self.stabilisation {
            Stabilisation::Projection => {
                let SimulationState { q, v, .. } = self.split(state);
                self.loops.project(&q, &v).map(Some)
            }
            Stabilisation::Baumgarte { .. } | Stabilisation::None => Ok(None),
        });
        match corrected {
            Err(error) => {
                self.last_error = Some(error);
                Accepted::Refused
            }
            Ok(None) => constrained,
            Ok(Some(projection)) => {
                let values = projection.q.as_ref().iter().chain(projection.v.as_ref());
                for (state, &value) in state.as_mut().iter_mut().zip(values) {
                    *state = value;
                }
                Accepted::Corrected
            }
        }
    }
}
