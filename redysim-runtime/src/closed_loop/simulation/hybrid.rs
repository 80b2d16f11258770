//! Hybrid simulation of closed loops: some joints follow a prescribed motion, the others move as forces make them.

use super::{Stabilisation, write_rates};
use crate::closed_loop::constraints::{Constraints, Metric};
use crate::closed_loop::position::ProjectedPoint;
use crate::closed_loop::{ClosedLoop, ConstrainedHybridMotion, LoopError};
use crate::control::check_motion;
use crate::hybrid_simulation::prescribed;
use crate::integrate::{Accepted, Tolerances};
use crate::linear_algebra::product;
use crate::simulate::{
    check_state, constrain_coordinates, dot, extended_state, law_torque, split, state, write_coordinate_rates,
};
use crate::tangent;
use crate::vector::entry;
use crate::{
    ConfigurationSpace, HybridMotion, InverseDynamics, LengthMismatch, LoopClosure, MassMatrix, Motion, Ode, Real,
    SimulationState, TorqueLaw, Trajectory, Vector,
};

/// A mechanism with closed loops whose `driven` velocities follow a motion while the others move under a torque law, as an
/// [`Ode`] in the state y = [q, q̇, E_act] of a [`ForwardSimulation`](crate::ForwardSimulation). It runs with every
/// integrator.
///
/// Accelerations and the forces of the motion are those of [`ClosedLoop::hybrid_dynamics`]. The motion is one of all
/// joints; its values for those that are not driven are ignored, as are the forces that the law returns for those that
/// are. All velocities of a joint with a quaternion are driven, or none. The loops must leave the driven velocities free
/// of each other: a four-bar linkage has one, whichever joint it is of.
///
/// As in a [`HybridSimulation`](crate::HybridSimulation), the coordinates and velocities that follow the motion are a copy
/// in the state, and every evaluation takes the motion itself at its time; the [`Stabilisation`] closes the loops by the
/// others. When an integration ends with an error, [`last_error`](Self::last_error) has the loops' own reason, if it was
/// theirs, as where the motion goes beyond the reach of the links.
///
/// E_act, J, is the work of all joint forces, those that the motion takes and those of the law, less what damping and
/// friction have taken: the change of kinetic plus potential energy.
#[derive(Debug)]
pub struct ClosedLoopHybridSimulation<'m, S, M, T, L, C = M> {
    loops: ClosedLoop<'m, M, C>,
    driven: &'m [usize],
    motion: T,
    law: L,
    stabilisation: Stabilisation<S>,
    last_error: Option<LoopError<S>>,
}

/// Where the derivative is evaluated, and the constraints there.
struct EvaluationPoint<S: Real, M: ConfigurationSpace<S>, C: LoopClosure<S, M>> {
    at: Motion<M::Coordinates, M::Velocities>,
    constraints: Constraints<S, M, C>,
}

impl<'m, S: Real, M, T, L, C> ClosedLoopHybridSimulation<'m, S, M, T, L, C> {
    /// The simulation of `loops`, whose velocities `driven` follow `motion`, while `law` acts on the others.
    pub fn new(loops: ClosedLoop<'m, M, C>, driven: &'m [usize], motion: T, law: L) -> Self {
        Self { loops, driven, motion, law, stabilisation: Stabilisation::default(), last_error: None }
    }

    /// Sets what keeps the loops closed.
    pub fn stabilisation(self, stabilisation: Stabilisation<S>) -> Self {
        Self { stabilisation, ..self }
    }

    /// The mechanism and its closure.
    pub fn loops(&self) -> ClosedLoop<'m, M, C> {
        self.loops
    }

    /// The velocities that follow the motion.
    pub fn driven(&self) -> &'m [usize] {
        self.driven
    }

    /// The torque law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// What went wrong in the loops when a derivative was evaluated or a step corrected last; `None` if nothing did.
    pub fn last_error(&self) -> Option<LoopError<S>> {
        self.last_error
    }

    /// The state [q, v, 0] to start from at `t`, with the motion in the place of what follows it and the loops closed by
    /// the others: [`ClosedLoop::assemble`] with the driven velocities held.
    ///
    /// # Errors
    /// As [`ClosedLoop::assemble`].
    pub fn start(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> Result<M::State, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let Motion { q, v, .. } = self.prescribe(t, q, v);
        let assembly = self.loops.assemble(&q, &v, self.driven)?;
        Ok(state(self.loops.mechanism, &assembly.q, &assembly.v))
    }

    /// The state [q, v, 0, z] with the motion in the place of what follows it and the law's states z, whether or not the
    /// loops are closed there. An array must have `NQ + NV + 1` elements and one for each of the law's states.
    pub fn extended_state<Y: Vector<S>>(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> Y
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
        L: TorqueLaw<S, M>,
    {
        let Motion { q, v, .. } = self.prescribe(t, q, v);
        extended_state(self.loops.mechanism, &self.law, &q, &v)
    }

    /// The parts of a state at `t`, with the motion in the place of what follows it, and, with the projection, the loops
    /// closed by the others. What a `Vec` lacks is NaN.
    ///
    /// # Errors
    /// As [`ClosedLoop::project`], and [`LoopError::InconsistentVelocity`] if the loops do not admit the motion.
    pub fn closed<Y: Vector<S>>(
        &self,
        t: S,
        state: &Y,
    ) -> Result<SimulationState<S, M::Coordinates, M::Velocities>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let SimulationState { q, v, actuator_energy } = self.split(t, state);
        if self.stabilisation != Stabilisation::Projection {
            return Ok(SimulationState { q, v, actuator_energy });
        }
        let ProjectedPoint { projection, .. } = self.loops.project_with_constraints(&q, &v, self.driven)?;
        Ok(SimulationState { q: projection.q, v: projection.v, actuator_energy })
    }

    /// The parts of a state at `t`, with the motion in the place of what follows it. What a `Vec` lacks is NaN.
    pub fn split<Y: Vector<S>>(&self, t: S, state: &Y) -> SimulationState<S, M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let SimulationState { q, v, actuator_energy } = split(self.loops.mechanism, state);
        let Motion { q, v, .. } = self.prescribe(t, &q, &v);
        SimulationState { q, v, actuator_energy }
    }

    /// Accelerations and joint forces in a state at `t`, of each joint the one that is given and the one that is found, and
    /// the constraint forces.
    ///
    /// # Errors
    /// As [`ClosedLoop::hybrid_dynamics`].
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn forced_motion<Y: Vector<S>>(
        &mut self,
        t: S,
        state: &Y,
    ) -> Result<ConstrainedHybridMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + InverseDynamics<S>,
        C: LoopClosure<S, M>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
        L: TorqueLaw<S, M>,
    {
        let SimulationState { q, v, .. } = split(self.loops.mechanism, state);
        let at = self.prescribe(t, &q, &v);
        let constraints = self.loops.constraints_in(Metric::Mass, &at.q, self.driven)?;
        self.solve(t, &EvaluationPoint { at, constraints }, (state, &mut state.clone()))
    }

    /// The motion at `t` along the driven velocities, `q` and `v` along the others. Accelerations of these are zero.
    fn prescribe(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> Motion<M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        prescribed(self.loops.mechanism, &self.motion.at(t), |i| self.driven.contains(&i), (q, v))
    }

    /// Where the derivative at a state is evaluated: at the state, or the nearest one that keeps the loops closed, as in a
    /// [`ClosedLoopSimulation`](crate::ClosedLoopSimulation).
    fn evaluation_point(&self, t: S, state: &impl Vector<S>) -> Result<EvaluationPoint<S, M, C>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let SimulationState { q, v, .. } = split(self.loops.mechanism, state);
        let at = self.prescribe(t, &q, &v);
        let constraints = self.loops.constraints_in(Metric::Mass, &at.q, self.driven)?;
        if self.stabilisation != Stabilisation::Projection || constraints.are_regular(self.loops.closure.nc()) {
            return Ok(EvaluationPoint { at, constraints });
        }
        let ProjectedPoint { projection, constraints } =
            self.loops.project_with_constraints(&at.q, &at.v, self.driven)?;
        Ok(EvaluationPoint { at: Motion { q: projection.q, v: projection.v, a: at.a }, constraints })
    }

    /// Accelerations, joint forces and multipliers at a point; the rates of the law's states are written to their place.
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    fn solve<Y: Vector<S>>(
        &mut self,
        t: S,
        EvaluationPoint { at: Motion { q, v, a }, constraints }: &EvaluationPoint<S, M, C>,
        states: (&Y, &mut Y),
    ) -> Result<ConstrainedHybridMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + InverseDynamics<S>,
        C: LoopClosure<S, M>,
        L: TorqueLaw<S, M>,
    {
        let mechanism = self.loops.mechanism;
        let tau = law_torque(&mut self.law, mechanism, t, (q, v), states);
        let given = |i: usize| if self.driven.contains(&i) { entry(a, i) } else { entry(&tau, i) };
        let u = M::Velocities::from_fn(mechanism.nv(), given);
        let Stabilisation::Baumgarte { alpha } = self.stabilisation else {
            return self.loops.hybrid_dynamics_with(constraints, (q, v, &u), self.driven, |_| S::zero());
        };
        let residual = self.loops.closure.loop_residual(q);
        let rates: C::Rows = product(constraints.jacobian.as_ref(), v.as_ref());
        self.loops.hybrid_dynamics_with(constraints, (q, v, &u), self.driven, |row| {
            alpha * (entry(&rates, row) + entry(&rates, row) + alpha * entry(&residual, row))
        })
    }
}

impl<S, Y, M, T, L, C> Ode<S, Y> for ClosedLoopHybridSimulation<'_, S, M, T, L, C>
where
    S: Real,
    Y: Vector<S>,
    M: MassMatrix<S> + InverseDynamics<S>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
    L: TorqueLaw<S, M>,
    C: LoopClosure<S, M>,
{
    fn check_lengths(&self, t: S, state: &Y) -> Result<(), LengthMismatch> {
        check_state(self.loops.mechanism, &self.law, state)?;
        check_motion(self.loops.mechanism, &self.motion.at(t))?;
        self.law.check_lengths(t, self.loops.mechanism)
    }

    /// Not a number where the loops cannot be solved; [`last_error`](Self::last_error) then says why.
    fn derivative(&mut self, t: S, state: &Y, rate: &mut Y) {
        let found = self.evaluation_point(t, state).and_then(|point| {
            let HybridMotion { a, tau } = self.solve(t, &point, (state, rate))?.motion;
            let (mechanism, Motion { q, v, .. }) = (self.loops.mechanism, point.at);
            let power = dot(&tau, &v) - mechanism.dissipated_power(&q, &v);
            Ok((mechanism.coordinate_rates(&q, &v), a, power))
        });
        self.last_error = write_rates(found, rate);
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

    fn coordinate_rates(&mut self, t: S, state: &Y, rates: &mut Y) -> usize {
        let SimulationState { q, v, .. } = self.split(t, state);
        write_coordinate_rates(self.loops.mechanism, (&q, &v), rates)
    }

    fn accepted(&mut self, t: S, step: S, state: &mut Y) -> Accepted {
        let constrained = constrain_coordinates(self.loops.mechanism, state);
        match self.stabilisation.check(step).and_then(|()| self.closed(t, state)) {
            Err(error) => {
                self.last_error = Some(error);
                Accepted::Refused
            }
            Ok(_) if self.stabilisation != Stabilisation::Projection => constrained,
            Ok(closed) => {
                let values = closed.q.as_ref().iter().chain(closed.v.as_ref());
                for (state, &value) in state.as_mut().iter_mut().zip(values) {
                    *state = value;
                }
                Accepted::Corrected
            }
        }
    }
}
