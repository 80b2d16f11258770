//! Calls at changing states, timed.

use crate::numbers::Numbers;
use crate::random::Random;
use criterion::{Criterion, Throughput};
use redysim::{ForwardDynamics, InverseDynamics, JointTrig, MassMatrix, TreeDynamics, Vector};
use std::f64::consts::PI;
use std::hint::black_box;

/// States that calls go through: too many for branches to be learnt by heart, few enough for the innermost cache.
const STATES: usize = 64;

/// Coordinates, velocities, and accelerations or forces.
struct State<Q, V> {
    q: Q,
    v: V,
    input: V,
}

/// The same states in every run.
fn states<S: Numbers, Q: Vector<S>, V: Vector<S>>(nq: usize, nv: usize) -> Vec<State<Q, V>> {
    let mut random = Random::new(1);
    let mut within = |bound: f64| S::filled(|| random.within(bound));
    let mut state = || State {
        q: Q::from_fn(nq, |_| within(PI)),
        v: V::from_fn(nv, |_| within(3.0)),
        input: V::from_fn(nv, |_| within(10.0)),
    };
    (0..STATES).map(|_| state()).collect()
}

/// Times one function under the name `robot/function/path`.
fn timed<S: Numbers, A, R>(
    criterion: &mut Criterion,
    [robot, function, path]: [&str; 3],
    arguments: &[A],
    call: impl Fn(&A) -> R,
) {
    let mut group = criterion.benchmark_group(format!("{robot}/{function}"));
    group.throughput(Throughput::Elements(S::LANES as u64));
    let mut next = 0;
    group.bench_function(path, |bencher| {
        bencher.iter(|| {
            next = (next + 1) % STATES;
            call(black_box(&arguments[next]))
        });
    });
    group.finish();
}

/// Inverse dynamics, forward dynamics and the mass matrix. `path` is the scalar, or what else tells the way of
/// computing.
pub fn main_functions<S: Numbers, M>(criterion: &mut Criterion, robot: &str, path: &str, mechanism: &M)
where
    M: InverseDynamics<S> + ForwardDynamics<S> + MassMatrix<S>,
{
    let states = states::<S, M::Coordinates, M::Velocities>(mechanism.nq(), mechanism.nv());
    timed::<S, _, _>(criterion, [robot, "inverse_dynamics", path], &states, |state| {
        mechanism.inverse_dynamics(&state.q, &state.v, &state.input)
    });
    timed::<S, _, _>(criterion, [robot, "forward_dynamics", path], &states, |state| {
        mechanism.forward_dynamics(&state.q, &state.v, &state.input)
    });
    timed::<S, _, _>(criterion, [robot, "mass_matrix", path], &states, |state| mechanism.mass_matrix(&state.q));
}

/// The other functions of a tree.
pub fn other_functions<S: Numbers, M: TreeDynamics<S>>(
    criterion: &mut Criterion,
    robot: &str,
    path: &str,
    mechanism: &M,
) {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    let states = states::<S, M::Coordinates, M::Velocities>(nq, nv);
    timed::<S, _, _>(criterion, [robot, "bias_forces", path], &states, |state| {
        mechanism.bias_forces(&state.q, &state.v)
    });
    timed::<S, _, _>(criterion, [robot, "gravity_forces", path], &states, |state| mechanism.gravity_forces(&state.q));
    timed::<S, _, _>(criterion, [robot, "energy", path], &states, |state| mechanism.energy(&state.q, &state.v));
    timed::<S, _, _>(criterion, [robot, "center_of_mass", path], &states, |state| {
        mechanism.center_of_mass(&state.q, &state.v)
    });
    timed::<S, _, _>(criterion, [robot, "link_kinematics", path], &states, |state| {
        mechanism.link_kinematics(&state.q, &state.v)
    });
}

/// The sines and cosines, and inverse dynamics, forward dynamics and the mass matrix where they are there already.
pub fn with_joint_trig<S: Numbers, const N: usize, const A: usize>(
    criterion: &mut Criterion,
    robot: &str,
    joint_trig: impl Fn(&[S; N]) -> JointTrig<S, N, A>,
    (inverse, forward, matrix): (
        impl Fn(&JointTrig<S, N, A>, &[S; N], &[S; N]) -> [S; N],
        impl Fn(&JointTrig<S, N, A>, &[S; N], &[S; N]) -> [S; N],
        impl Fn(&JointTrig<S, N, A>) -> [[S; N]; N],
    ),
) {
    let states = states::<S, [S; N], [S; N]>(N, N);
    timed::<S, _, _>(criterion, [robot, "joint_trig", S::NAME], &states, |state| joint_trig(&state.q));
    let states: Vec<_> = states.into_iter().map(|state| (joint_trig(&state.q), state.v, state.input)).collect();
    timed::<S, _, _>(criterion, [robot, "inverse_dynamics_with_trig", S::NAME], &states, |(at, v, a)| {
        inverse(at, v, a)
    });
    timed::<S, _, _>(criterion, [robot, "forward_dynamics_with_trig", S::NAME], &states, |(at, v, tau)| {
        forward(at, v, tau)
    });
    timed::<S, _, _>(criterion, [robot, "mass_matrix_with_trig", S::NAME], &states, |(at, _, _)| matrix(at));
}
