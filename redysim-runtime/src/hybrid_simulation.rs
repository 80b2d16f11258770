//! Hybrid simulation: some joints follow a prescribed motion, the others move as forces make them.

use crate::control::check_motion;
use crate::integrate::{Accepted, Tolerances};
use crate::simulate::{
    check_state, constrain_coordinates, dot, extended_state, law_torque, split, state, write, write_coordinate_rates,
};
use crate::tangent;
use crate::vector::entry;
use crate::{
    ConfigurationSpace, HybridDynamics, HybridMotion, LengthMismatch, Motion, Ode, Real, SimulationState, TorqueLaw,
    Trajectory, Vector,
};

/// A mechanism whose joints with an actuator follow a motion while the others move under a torque law, as an [`Ode`] in
/// the state y = [q, q̇, E_act] of a [`ForwardSimulation`](crate::ForwardSimulation).
///
/// With the joints d that follow the motion and the others p, [hybrid dynamics](HybridDynamics) solves
///
/// M(q) q̈ + bias(q, q̇) = τ with q̈_d given by the motion and τ_p by the law
///
/// for q̈_p and τ_d: the inverse dynamics of a floating robot, whose base moves as the arm makes it. The joints d are
/// those with an [actuator](crate::Mechanism::is_actuated); the motion is one of all joints; its values for p are ignored,
/// as are the forces that the law returns for d. For other partitions, `actuated` of a link can be set in the model. All
/// velocities of a joint with a quaternion belong to d, or all of them to p.
///
/// The coordinates and velocities of the joints d in the state are a copy, whose rates are those of the motion. In their
/// place every evaluation takes the motion itself at its time, as [`split`](Self::split) does:
/// q ⊞ (q_motion ⊟ q) along d. Errors of the copy do not act on the result.
///
/// E_act, J, is the work of all joint forces, those that the motion takes and those of the law, less what damping and
/// friction have taken: the change of kinetic plus potential energy.
///
/// Source: Featherstone, *Rigid Body Dynamics Algorithms*, Springer 2008, sections 9.1 and 9.2.
#[derive(Clone, Copy, Debug)]
pub struct HybridSimulation<'m, M, T, L> {
    mechanism: &'m M,
    motion: T,
    law: L,
}

impl<'m, M, T, L> HybridSimulation<'m, M, T, L> {
    /// The simulation of `mechanism`, whose joints with an actuator follow `motion`, while `law` acts on the others.
    pub fn new(mechanism: &'m M, motion: T, law: L) -> Self {
        Self { mechanism, motion, law }
    }

    /// The mechanism that is simulated.
    pub fn mechanism(&self) -> &'m M {
        self.mechanism
    }

    /// The state [q, v, 0] to start from at `t`, with the motion in the place of the coordinates and velocities of the
    /// joints that follow it.
    pub fn state<S: Real>(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::State
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let Motion { q, v, .. } = self.prescribe(t, q, v);
        state(self.mechanism, &q, &v)
    }

    /// The state [q, v, 0, z] to start from at `t`, as [`state`](Self::state), with the law's states z, for a law that has
    /// some. An array must have `NQ + NV + 1` elements and one for each of them.
    pub fn extended_state<S: Real, Y: Vector<S>>(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> Y
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
        L: TorqueLaw<S, M>,
    {
        let Motion { q, v, .. } = self.prescribe(t, q, v);
        extended_state(self.mechanism, &self.law, &q, &v)
    }

    /// The parts of a state at `t`, with the motion in the place of the coordinates and velocities of the joints that
    /// follow it. What a `Vec` lacks is NaN.
    pub fn split<S: Real, Y: Vector<S>>(&self, t: S, state: &Y) -> SimulationState<S, M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        let SimulationState { q, v, actuator_energy } = split(self.mechanism, state);
        let Motion { q, v, .. } = self.prescribe(t, &q, &v);
        SimulationState { q, v, actuator_energy }
    }

    /// Accelerations and joint forces in a state at `t`: of each joint the one that is given and the one that is found.
    pub fn forced_motion<S: Real, Y: Vector<S>>(&mut self, t: S, state: &Y) -> HybridMotion<M::Velocities>
    where
        M: HybridDynamics<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
        L: TorqueLaw<S, M>,
    {
        let SimulationState { q, v, .. } = split(self.mechanism, state);
        let at = self.prescribe(t, &q, &v);
        self.solve(t, &at, (state, &mut state.clone()))
    }

    /// The motion at `t` along the joints with an actuator, `q` and `v` along the others. Accelerations of these are
    /// zero.
    fn prescribe<S: Real>(&self, t: S, q: &M::Coordinates, v: &M::Velocities) -> Motion<M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
        T: Trajectory<S, M::Coordinates, M::Velocities>,
    {
        prescribed(self.mechanism, &self.motion.at(t), |i| self.mechanism.is_actuated(i), (q, v))
    }

    /// Accelerations and joint forces of the motion `at`; the rates of the law's states are written to their place.
    fn solve<S: Real, Y: Vector<S>>(
        &mut self,
        t: S,
        at: &Motion<M::Coordinates, M::Velocities>,
        states: (&Y, &mut Y),
    ) -> HybridMotion<M::Velocities>
    where
        M: HybridDynamics<S>,
        L: TorqueLaw<S, M>,
    {
        let (mechanism, Motion { q, v, a }) = (self.mechanism, at);
        let tau = law_torque(&mut self.law, mechanism, t, (q, v), states);
        let given = |i: usize| if mechanism.is_actuated(i) { entry(a, i) } else { entry(&tau, i) };
        mechanism.hybrid_dynamics(q, v, &M::Velocities::from_fn(mechanism.nv(), given))
    }
}

/// `motion` along the velocities that `follows` selects, `q` and `v` along the others. Accelerations of these are zero.
pub(crate) fn prescribed<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    motion: &Motion<M::Coordinates, M::Velocities>,
    follows: impl Fn(usize) -> bool,
    (q, v): (&M::Coordinates, &M::Velocities),
) -> Motion<M::Coordinates, M::Velocities> {
    let Motion { q: target, v: rates, a } = motion;
    let way = mechanism.difference(q, target);
    let pick = |given: &M::Velocities, other: &dyn Fn(usize) -> S| {
        M::Velocities::from_fn(mechanism.nv(), |i| if follows(i) { entry(given, i) } else { other(i) })
    };
    let way = pick(&way, &|_| S::zero());
    Motion { q: mechanism.integrate(q, &way), v: pick(rates, &|i| entry(v, i)), a: pick(a, &|_| S::zero()) }
}

impl<S, Y, M, T, L> Ode<S, Y> for HybridSimulation<'_, M, T, L>
where
    S: Real,
    Y: Vector<S>,
    M: HybridDynamics<S>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
    L: TorqueLaw<S, M>,
{
    fn derivative(&mut self, t: S, state: &Y, rate: &mut Y) {
        let SimulationState { q, v, .. } = split(self.mechanism, state);
        let at = self.prescribe(t, &q, &v);
        let HybridMotion { a, tau } = self.solve(t, &at, (state, rate));
        let rates = self.mechanism.coordinate_rates(&at.q, &at.v);
        let power = dot(&tau, &at.v) - self.mechanism.dissipated_power(&at.q, &at.v);
        write(self.mechanism, (&rates, &a, power), rate);
    }

    fn check_lengths(&self, t: S, state: &Y) -> Result<(), LengthMismatch> {
        check_state(self.mechanism, &self.law, state)?;
        check_motion(self.mechanism, &self.motion.at(t))?;
        self.law.check_lengths(t, self.mechanism)
    }

    fn accepted(&mut self, _t: S, _step: S, state: &mut Y) -> Accepted {
        constrain_coordinates(self.mechanism, state)
    }

    fn interpolated(&mut self, _t: S, state: &mut Y) {
        constrain_coordinates(self.mechanism, state);
    }

    fn project_onto_tangent(&self, state: &Y, direction: &mut Y) {
        tangent::project(self.mechanism, state, direction);
    }

    fn error_norm(&self, tolerances: &Tolerances<'_, S>, error: &Y, y: &Y, z: &Y) -> S {
        tangent::error_norm(self.mechanism, tolerances, error, (y, z))
    }

    fn coordinate_rates(&mut self, t: S, state: &Y, rates: &mut Y) -> usize {
        let SimulationState { q, v, .. } = self.split(t, state);
        write_coordinate_rates(self.mechanism, (&q, &v), rates)
    }
}
