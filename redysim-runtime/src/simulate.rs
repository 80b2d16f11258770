//! Forward simulation: a mechanism and a torque law as an ordinary differential equation.

use crate::integrate::{Accepted, Tolerances};
use crate::linear_algebra::largest;
use crate::tangent;
use crate::vector::entry;
use crate::{ConfigurationSpace, ForwardDynamics, LengthMismatch, Ode, Real, TorqueLaw, Vector};

/// A mechanism moved by a torque law, as an [`Ode`] in the state y = [q, q̇, E_act].
///
/// The equation is
///
/// dq/dt = N(q) q̇, dq̇/dt = M(q)⁻¹ (τ − bias(q, q̇)), dE_act/dt = τ·q̇ − P(q, q̇).
///
/// After each step, coordinates that are constrained, as the length of a quaternion is, are taken nearer to their
/// constraint.
///
/// E_act, J, is the work that the actuators have done, less what damping and friction have taken with the
/// [power](ConfigurationSpace::dissipated_power) P. It is the change of kinetic plus potential energy, a check of the
/// whole simulation.
///
/// A law that has states z of its own, such as [`Pid`](crate::Pid), extends the state to y = [q, q̇, E_act, z]: a vector
/// of NQ + NV + 1 + [`state_count`](TorqueLaw::state_count) elements, with which
/// [`extended_state`](Self::extended_state) starts.
///
/// ```
/// # #[allow(dead_code)]
/// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
/// # use mechanisms::Pendulum;
/// use redysim_runtime::{ForwardSimulation, ZeroTorque, Integrator, Ode45};
///
/// let pendulum = Pendulum { mass: 2.0, length: 0.5 };
/// let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
/// let start = simulation.state(&[0.3], &[0.0]);
/// let times = [0.0, 0.5, 1.0];
/// Ode45::new().rtol(1e-10).atol(1e-12).solve(&mut simulation, (0.0, 1.0), start, times, |t, y| {
///     println!("{t} s: {} rad, {} rad/s", y[0], y[1]);
/// })?;
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ForwardSimulation<'m, M, L> {
    mechanism: &'m M,
    law: L,
}

/// The parts of a simulation's state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SimulationState<S, Q, V> {
    /// Joint coordinates, rad or m.
    pub q: Q,
    /// Joint velocities, rad/s or m/s.
    pub v: V,
    /// Work done by the actuators since the start, less what damping and friction have taken, J.
    pub actuator_energy: S,
}

impl<'m, M, L> ForwardSimulation<'m, M, L> {
    /// The simulation of `mechanism` under `law`.
    pub fn new(mechanism: &'m M, law: L) -> Self {
        Self { mechanism, law }
    }

    /// The mechanism that is simulated.
    pub fn mechanism(&self) -> &'m M {
        self.mechanism
    }

    /// The state [q, v, 0] to start from: the actuators have done no work yet. A `Vec` that is too short or too long
    /// makes it so, which an integration reports before it begins.
    pub fn state<S: Real>(&self, q: &M::Coordinates, v: &M::Velocities) -> M::State
    where
        M: ConfigurationSpace<S>,
    {
        state(self.mechanism, q, v)
    }

    /// The state [q, v, 0, z] to start from with the law's states z, for a law that has some. An array must have
    /// `NQ + NV + 1` elements and one for each of them.
    pub fn extended_state<S: Real, Y: Vector<S>>(&self, q: &M::Coordinates, v: &M::Velocities) -> Y
    where
        M: ConfigurationSpace<S>,
        L: TorqueLaw<S, M>,
    {
        extended_state(self.mechanism, &self.law, q, v)
    }

    /// The parts of a state. What a `Vec` lacks is NaN.
    pub fn split<S: Real, Y: Vector<S>>(&self, state: &Y) -> SimulationState<S, M::Coordinates, M::Velocities>
    where
        M: ConfigurationSpace<S>,
    {
        split(self.mechanism, state)
    }

    /// The joint forces in a state.
    pub fn torque<S: Real, Y: Vector<S>>(&mut self, t: S, state: &Y) -> M::Velocities
    where
        M: ConfigurationSpace<S>,
        L: TorqueLaw<S, M>,
    {
        let SimulationState { q, v, .. } = self.split(state);
        law_torque(&mut self.law, self.mechanism, t, (&q, &v), (state, &mut state.clone()))
    }
}

impl<S, Y, M, L> Ode<S, Y> for ForwardSimulation<'_, M, L>
where
    S: Real,
    Y: Vector<S>,
    M: ForwardDynamics<S>,
    L: TorqueLaw<S, M>,
{
    fn derivative(&mut self, t: S, state: &Y, rate: &mut Y) {
        let SimulationState { q, v, .. } = self.split(state);
        let tau = law_torque(&mut self.law, self.mechanism, t, (&q, &v), (state, rate));
        let rates = self.mechanism.coordinate_rates(&q, &v);
        let accelerations = self.mechanism.forward_dynamics(&q, &v, &tau);
        let power = dot(&tau, &v) - self.mechanism.dissipated_power(&q, &v);
        write(self.mechanism, (&rates, &accelerations, power), rate);
    }

    fn check_lengths(&self, t: S, state: &Y) -> Result<(), LengthMismatch> {
        check_state(self.mechanism, &self.law, state)?;
        self.law.check_lengths(t, self.mechanism)
    }

    fn tangent(&mut self, t: S, state: &Y, direction: &Y, slope: &mut Y) -> bool {
        if self.law.state_count(self.mechanism) != 0 {
            return false;
        }
        let SimulationState { q, v, .. } = self.split(state);
        let SimulationState { q: dq, v: dv, .. } = self.split(direction);
        let tau = self.law.torque(self.mechanism, t, &q, &v);
        let dtau = torque_tangent(&mut self.law, self.mechanism, t, (&q, &v), (&dq, &dv));
        let Some(da) = self.mechanism.forward_dynamics_tangent((&q, &v, &tau), (&dq, &dv, &dtau)) else {
            return false;
        };
        // The derivative of N(q) v is N(q) dv + (∂N/∂q dq) v.
        let mut drates = self.mechanism.coordinate_rates(&q, &dv);
        let by_position = coordinate_rates_tangent(self.mechanism, &q, &v, &dq);
        for (drate, &by_position) in drates.as_mut().iter_mut().zip(by_position.as_ref()) {
            *drate += by_position;
        }
        let dissipated = dissipated_power_tangent(self.mechanism, (&q, &v), (&dq, &dv));
        write(self.mechanism, (&drates, &da, dot(&dtau, &v) + dot(&tau, &dv) - dissipated), slope);
        true
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

    fn coordinate_rates(&mut self, _t: S, state: &Y, rates: &mut Y) -> usize {
        let SimulationState { q, v, .. } = self.split(state);
        write_coordinate_rates(self.mechanism, (&q, &v), rates)
    }
}

/// The parts of a state of a simulation of `mechanism`. What a `Vec` lacks is NaN.
pub(crate) fn split<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    state: &Y,
) -> SimulationState<S, M::Coordinates, M::Velocities> {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    SimulationState {
        q: M::Coordinates::from_fn(nq, |i| entry(state, i)),
        v: M::Velocities::from_fn(nv, |i| entry(state, nq + i)),
        actuator_energy: entry(state, nq + nv),
    }
}

/// Writes [q, v, energy], or their rates, to a state of a simulation of `mechanism`. What a `Vec` lacks is NaN.
pub(crate) fn write<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    parts: (&M::Coordinates, &M::Velocities, S),
    state: &mut impl Vector<S>,
) {
    let sizes = (mechanism.nq(), mechanism.nv());
    for (i, element) in state.as_mut().iter_mut().enumerate().take(sizes.0 + sizes.1 + 1) {
        *element = component(i, sizes, parts);
    }
}

/// Writes the rates of the coordinates to the first elements of `rates`; returns how many they are.
pub(crate) fn write_coordinate_rates<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    (q, v): (&M::Coordinates, &M::Velocities),
    rates: &mut Y,
) -> usize {
    let coordinate_rates = mechanism.coordinate_rates(q, v);
    let nq = mechanism.nq();
    for (i, rate) in rates.as_mut().iter_mut().enumerate().take(nq) {
        *rate = entry(&coordinate_rates, i);
    }
    nq
}

/// The drift of constrained coordinates from their constraint that is left as it is, in roundoff units: no method knows
/// them better than its iteration solves, and a correction costs an evaluation.
const DRIFT: f64 = 4096.0;

/// Takes the coordinates of a state nearer to their constraint, if they have one, as the length of a quaternion is.
///
/// Most methods drift from the constraint by their local error. The drift does not change an orientation, but it adds up.
pub(crate) fn constrain_coordinates<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    state: &mut Y,
) -> Accepted {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    if nq == nv {
        return Accepted::Unchanged;
    }
    let q = M::Coordinates::from_fn(nq, |i| entry(state, i));
    let constrained = mechanism.integrate(&q, &M::Velocities::from_fn(nv, |_| S::zero()));
    let far = |(before, after): (&S, &S)| (*after - *before).abs() > S::from_f64(DRIFT) * S::EPSILON;
    if !q.as_ref().iter().zip(constrained.as_ref()).any(far) {
        return Accepted::Unchanged;
    }
    for (component, &value) in state.as_mut().iter_mut().zip(constrained.as_ref()) {
        *component = value;
    }
    Accepted::Corrected
}

/// The state [q, v, 0].
pub(crate) fn state<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    q: &M::Coordinates,
    v: &M::Velocities,
) -> M::State {
    let sizes = (mechanism.nq(), mechanism.nv());
    M::State::from_fn(q.as_ref().len() + v.as_ref().len() + 1, |i| component(i, sizes, (q, v, S::zero())))
}

/// The state [q, v, 0, z] with the states z of `law`.
pub(crate) fn extended_state<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    law: &impl TorqueLaw<S, M>,
    q: &M::Coordinates,
    v: &M::Velocities,
) -> Y {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    let own = nq + nv + 1;
    Y::from_fn(own + law.state_count(mechanism), |i| match i.checked_sub(own) {
        Some(index) => law.initial_state(index),
        None => component(i, (nq, nv), (q, v, S::zero())),
    })
}

/// Checks that a state has the parts q, v, energy and the states of `law`.
pub(crate) fn check_state<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    law: &impl TorqueLaw<S, M>,
    state: &Y,
) -> Result<(), LengthMismatch> {
    let expected = mechanism.nq() + mechanism.nv() + 1 + law.state_count(mechanism);
    LengthMismatch::check("state", state.as_ref(), expected)
}

/// The joint forces of a law in a state of a simulation of `mechanism`; the rates of the law's states are written to
/// their place among the rates of that state.
pub(crate) fn law_torque<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    law: &mut impl TorqueLaw<S, M>,
    mechanism: &M,
    t: S,
    at: (&M::Coordinates, &M::Velocities),
    (state, rates): (&Y, &mut Y),
) -> M::Velocities {
    let own = mechanism.nq() + mechanism.nv() + 1;
    let of_law = state.as_ref().get(own..).unwrap_or_default();
    law.torque_with_state(mechanism, t, at, of_law, rates.as_mut().get_mut(own..).unwrap_or_default())
}

/// Component `i` of [q, v, energy] with `nq` and `nv` coordinates and velocities.
fn component<S: Real, Q: Vector<S>, V: Vector<S>>(
    i: usize,
    (nq, nv): (usize, usize),
    (q, v, energy): (&Q, &V, S),
) -> S {
    match i.checked_sub(nq) {
        None => entry(q, i),
        Some(i) if i < nv => entry(v, i),
        Some(_) => energy,
    }
}

/// The power of the joint forces `tau`.
pub(crate) fn dot<S: Real, V: Vector<S>>(tau: &V, v: &V) -> S {
    v.as_ref().iter().enumerate().fold(S::zero(), |sum, (i, &v)| sum + entry(tau, i) * v)
}

/// The derivative of a law's joint forces along `(dq, dv)`: what the law says, or else central differences.
fn torque_tangent<S: Real, M: ConfigurationSpace<S>>(
    law: &mut impl TorqueLaw<S, M>,
    mechanism: &M,
    t: S,
    (q, v): (&M::Coordinates, &M::Velocities),
    (dq, dv): (&M::Coordinates, &M::Velocities),
) -> M::Velocities {
    if let Some(dtau) = law.torque_tangent(mechanism, t, (q, v), (dq, dv)) {
        return dtau;
    }
    let [state, slope] = [(q, v), (dq, dv)].map(|(q, v)| largest(q.as_ref().iter().chain(v.as_ref()).copied()).0);
    central_difference(v.as_ref().len(), state, slope, |step| {
        law.torque(mechanism, t, &moved(q, dq, step), &moved(v, dv, step))
    })
}

/// (∂N/∂q dq) v: what the mechanism computes, or else central differences, which for constant N are zero exactly.
fn coordinate_rates_tangent<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    q: &M::Coordinates,
    v: &M::Velocities,
    dq: &M::Coordinates,
) -> M::Coordinates {
    mechanism.coordinate_rates_tangent(q, v, dq).unwrap_or_else(|| {
        let [position, slope] = [q, dq].map(|values| largest(values.as_ref().iter().copied()).0);
        central_difference(q.as_ref().len(), position, slope, |step| mechanism.coordinate_rates(&moved(q, dq, step), v))
    })
}

/// The derivative of the dissipated power along `(dq, dv)`, by central differences.
fn dissipated_power_tangent<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    (q, v): (&M::Coordinates, &M::Velocities),
    (dq, dv): (&M::Coordinates, &M::Velocities),
) -> S {
    let [state, slope] = [(q, v), (dq, dv)].map(|(q, v)| largest(q.as_ref().iter().chain(v.as_ref()).copied()).0);
    let power = |step: S| [mechanism.dissipated_power(&moved(q, dq, step), &moved(v, dv, step))];
    let [slope] = central_difference(1, state, slope, power);
    slope
}

/// The derivative of `function`, of `len` components, at 0 of a step along a direction: `size` and `slope` are the
/// largest components of the point and of the direction.
fn central_difference<S: Real, V: Vector<S>>(len: usize, size: S, slope: S, mut function: impl FnMut(S) -> V) -> V {
    if slope == S::zero() {
        return V::from_fn(len, |_| S::zero());
    }
    // The step at which truncation and rounding of central differences are alike.
    let step = S::EPSILON.powf(S::from_f64(1.0 / 3.0)) * size.maximum(S::one()) / slope;
    let (ahead, behind) = (function(step), function(-step));
    V::from_fn(len, |i| (entry(&ahead, i) - entry(&behind, i)) / (step + step))
}

/// `from` + `step` · `direction`.
fn moved<S: Real, V: Vector<S>>(from: &V, direction: &V, step: S) -> V {
    V::from_fn(from.as_ref().len(), |i| entry(from, i) + step * entry(direction, i))
}
