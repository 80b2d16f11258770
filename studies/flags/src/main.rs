//! How long a call takes, in ns, for one state and in a batch: what `run` compiles for several targets and compares.
//!
//! Prints a line for each: robot, function, number, way, ns. A time is the median of many rounds over the same states.

use redysim::batch::{self, Batched};
use redysim::{
    Dispatch, Dispatched, ForwardDynamics, InverseDynamics, LinkKinematics, MassMatrix, MechanicalEnergy, Real, Scalar,
    TreeDynamics, redysim,
};
use std::hint::black_box;
use std::time::Instant;

redysim! {
    /// Six joints in a row.
    #[allow(deprecated)]
    struct Kr5("../../../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    struct Gripper("../../../models/peers/gripper.toml");
}

/// As many states as stay on one thread.
const STATES: usize = 512;
const ROUNDS: usize = 101;

/// The median time of `round`, for each of `count` calls in it, ns.
fn time(count: usize, mut round: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            round();
            start.elapsed().as_secs_f64() * 1e9 / count as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[ROUNDS / 2]
}

/// The time of one of `STATES` calls, each of which gets its own state.
fn calls<I, O>(states: &[I], mut call: impl FnMut(&I) -> O) -> f64 {
    time(states.len(), || {
        for state in states {
            // By reference: by value the result would be copied, in another way for each target.
            black_box(&call(black_box(state)));
        }
    })
}

fn states<T: Real, const N: usize>(bound: f64) -> Vec<[T; N]> {
    // Numbers that fill an interval evenly: multiples of the golden ratio, without whole parts.
    let number = |index: usize| bound * (2.0 * (index as f64 * 1.618_033_988_749_895).fract() - 1.0);
    (0..STATES).map(|state| core::array::from_fn(|entry| T::from_f64(number(N * state + entry)))).collect()
}

/// Coordinates, velocities, and accelerations or forces.
type States<T, const N: usize> = [Vec<[T; N]>; 3];

/// Every function of `mechanism` for one state.
fn single<T: Real, M, const N: usize>(name: &str, way: &str, mechanism: &M, [q, v, u]: &States<T, N>)
where
    M: InverseDynamics<T, Coordinates = [T; N], Velocities = [T; N]>
        + ForwardDynamics<T>
        + MassMatrix<T>
        + MechanicalEnergy<T>
        + LinkKinematics<T>
        + TreeDynamics<T>,
{
    let indices: Vec<usize> = (0..STATES).collect();
    let show = |function: &str, ns: f64| println!("{name} {function} {way} {ns:.2}");
    show("inverse_dynamics", calls(&indices, |&i| mechanism.inverse_dynamics(&q[i], &v[i], &u[i])));
    show("forward_dynamics", calls(&indices, |&i| mechanism.forward_dynamics(&q[i], &v[i], &u[i])));
    show("mass_matrix", calls(q, |q| mechanism.mass_matrix(q)));
    show("bias_forces", calls(&indices, |&i| mechanism.bias_forces(&q[i], &v[i])));
    show("gravity_forces", calls(q, |q| mechanism.gravity_forces(q)));
    show("energy", calls(&indices, |&i| mechanism.energy(&q[i], &v[i])));
    show("link_kinematics", calls(&indices, |&i| mechanism.link_kinematics(&q[i], &v[i])));
}

/// The three functions that `run` compares in batches.
macro_rules! batches {
    ($name:expr, $mechanism:expr, $states:expr, $float:ident, $size:literal) => {{
        let [q, v, u] = $states;
        let (mut found, mut matrices) = (q.clone(), vec![[[0.0 as $float; $size]; $size]; STATES]);
        let show = |function: &str, ns: f64| println!("{} {function} batch {ns:.2}", $name);
        let ns = time(STATES, || batch::inverse_dynamics(&$mechanism, black_box(q), v, u, &mut found).expect("lengths"));
        show("inverse_dynamics", ns);
        let ns = time(STATES, || batch::forward_dynamics(&$mechanism, black_box(q), v, u, &mut found).expect("lengths"));
        show("forward_dynamics", ns);
        let ns = time(STATES, || batch::mass_matrix(&$mechanism, black_box(q), &mut matrices).expect("lengths"));
        show("mass_matrix", ns);
    }};
}

macro_rules! robots {
    ($($robot:ident: $name:literal, $size:literal;)*) => {$(
        robots!(@number $robot: $name, $size, f64);
        robots!(@number $robot: $name, $size, f32);
    )*};
    (@number $robot:ident: $name:literal, $size:literal, $float:ident) => {{
        let name = concat!($name, " ", stringify!($float));
        let states: States<$float, $size> = [std::f64::consts::PI, 3.0, 10.0].map(states);
        single(name, "plain", &$robot, &states);
        let ns = calls(&states[0], |q| $robot::joint_trig(q));
        println!("{name} joint_trig plain {ns:.2}");
        let dispatched: Dispatched<$robot> = $robot.dispatched();
        single(name, "dispatched", &dispatched, &states);
        batches!(name, $robot, &states, $float, $size);
    }};
}

/// Sines and cosines of a list, as a function of its own.
#[inline(never)]
fn list<T: Scalar, const N: usize>(angles: &[T; N]) -> ([T; N], [T; N]) {
    T::sin_cos_all(*angles)
}

fn lists<T: Batched, const N: usize>(number: &str) {
    let ns = calls(&states::<T, N>(std::f64::consts::PI), list::<T, N>);
    println!("angles {number} {N} plain {ns:.2}");
}

fn main() {
    robots! {
        Kr5: "kr5", 6;
        Gripper: "gripper", 4;
    }
    macro_rules! all_lists {
        ($($size:literal),*) => {$(
            lists::<f64, $size>("f64");
            lists::<f32, $size>("f32");
        )*};
    }
    all_lists!(1, 2, 3, 4, 5, 6, 7, 8);
}
