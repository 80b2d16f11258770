//! The shortest times of calls at changing states.

use crate::robot::Robot;
use redysim::Scalar;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// States that calls go through.
const STATES: usize = 16;

type Values<S> = [S; Robot::NV];

#[inline(never)]
fn inverse_dynamics<S: Scalar>(q: &Values<S>, v: &Values<S>, a: &Values<S>) -> Values<S> {
    Robot::inverse_dynamics(q, v, a)
}

#[inline(never)]
fn forward_dynamics<S: Scalar>(q: &Values<S>, v: &Values<S>, tau: &Values<S>) -> Values<S> {
    Robot::forward_dynamics(q, v, tau)
}

/// Coordinates, velocities, and accelerations or forces: numbers that fill an interval evenly, multiples of the golden
/// ratio without whole parts.
pub fn states<S: Scalar>() -> Vec<[Values<S>; 3]> {
    let mut count = 0.0;
    let mut values = |bound: f64| {
        core::array::from_fn(|_| {
            count += 1.0;
            S::from_f64(bound * (2.0 * (count * 1.618_033_988_749_895_f64).fract() - 1.0))
        })
    };
    (0..STATES).map(|_| [3.0, 3.0, 10.0].map(&mut values)).collect()
}

/// Prints the shortest time of a call of inverse and of forward dynamics, ns, in as many batches as the first argument
/// says.
pub fn print<S: Scalar>() {
    let batches = std::env::args().nth(1).and_then(|batches| batches.parse().ok()).unwrap_or(1);
    let states = states::<S>();
    let [inverse, forward] = [inverse_dynamics, forward_dynamics].map(|call| shortest(batches, &states, call));
    println!("{inverse} {forward}");
}

/// In batches of about a millisecond.
fn shortest<S: Scalar>(
    batches: usize,
    states: &[[Values<S>; 3]],
    call: fn(&Values<S>, &Values<S>, &Values<S>) -> Values<S>,
) -> f64 {
    let (mut shortest, mut rounds) = (f64::MAX, 1);
    for _ in 0..batches {
        let begun = Instant::now();
        for _ in 0..rounds {
            for [q, v, x] in states {
                black_box(call(black_box(q), black_box(v), black_box(x)));
            }
        }
        let elapsed = begun.elapsed();
        shortest = shortest.min(elapsed.as_secs_f64() * 1e9 / (rounds * STATES) as f64);
        if elapsed < Duration::from_millis(1) {
            rounds *= 2;
        }
    }
    shortest
}
