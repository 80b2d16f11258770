//! Computed torque of closed loops leaves each independent coordinate the error of a damped spring, in closed form.
#![cfg(feature = "generic")]

use crate::linkages::{Fourbar, ThreeRrr};
use crate::redundant::FourbarSpatial;
use redysim::{
    ClosedLoop, ClosedLoopComputedTorque, ClosedLoopSimulation, Cycloid, Dop853, IntegrationError, Integrator,
    LoopError, Motion, Trajectory,
};
use redysim_figures::peak;

const KP: f64 = 100.0;
const KD: f64 = 20.0;

/// ë + 2ω ė + ω² e = 0 with ω² = Kp and 2ω = Kd.
fn error_of_a_damped_spring(t: f64, e: f64, rate: f64) -> f64 {
    (e + (rate + KP.sqrt() * e) * t) * (-KP.sqrt() * t).exp()
}

/// The largest deviation of the independent coordinates from the closed form, at the end of 0.5 s.
macro_rules! deviation {
    ($mechanism:expr, $independent:expr, $guess:expr, $trajectory:expr) => {{
        let (loops, independent, trajectory) = (ClosedLoop::new(&$mechanism), &$independent, $trajectory);
        let start = loops.assemble(&$guess, &[0.0; _], independent).expect("it closes");
        let law = ClosedLoopComputedTorque::new(loops, independent, trajectory, [[KP; _], [KD; _]]);
        let mut controlled = ClosedLoopSimulation::new(loops, law);
        let state = controlled.assembled(&start);
        let end =
            Dop853::new().rtol(1e-10).atol(1e-10).integrate(&mut controlled, (0.0, 0.5), state).expect("it goes on");
        let (before, desired) = (trajectory.at(0.0), trajectory.at(0.5));
        let deviation = |(i, &joint): (usize, &usize)| {
            let left = error_of_a_damped_spring(0.5, before.q[i] - start.q[joint], before.v[i] - start.v[joint]);
            (desired.q[i] - end.y[joint] - left).abs()
        };
        peak(independent.iter().enumerate().map(deviation))
    }};
}

#[test]
fn errors_of_the_crank_die_away_as_those_of_a_damped_spring() {
    let turn = |t: f64| Motion { q: [0.1 + 4.0 * t], v: [4.0], a: [0.0] };
    let planar = deviation!(Fourbar, [0], [0.0, 0.9844, 4.3144], turn);
    let redundant = deviation!(FourbarSpatial, [0], [0.0, 0.9844, 4.3144], turn);
    println!("{planar:e} {redundant:e}");
    assert!(planar < 1e-8 && redundant < 1e-8, "{planar:e}, with a redundant row {redundant:e}");
}

#[test]
fn errors_of_three_cranks_that_carry_one_platform_die_away_alike() {
    let guess = include_str!("../reference/golden_octave_ID_3-RRR_Parallel_robot.csv");
    let first: Vec<f64> = guess
        .lines()
        .find(|line| !line.starts_with('#'))
        .expect("a row")
        .split(',')
        .map(|x| x.parse().expect("a number"))
        .collect();
    let guess: [f64; 7] = core::array::from_fn(|i| first[1 + i]);
    let cranks = [guess[0] + 0.05, guess[3] - 0.05, guess[5] + 0.02];
    let lift = Cycloid::new(cranks, cranks.map(|angle| angle + 0.1), 0.5).expect("a trajectory");
    let deviation = deviation!(ThreeRrr, [0, 3, 5], guess, lift);
    println!("{deviation:e}");
    assert!(deviation < 1e-8, "{deviation:e}");
}

#[test]
fn the_law_reports_why_it_has_no_forces() {
    let loops = ClosedLoop::new(&Fourbar);
    let rest = |_: f64| Motion { q: [0.0; 1], v: [0.0; 1], a: [0.0; 1] };
    let start = loops.assemble(&[0.0, 0.9844, 4.3144], &[0.0; 3], &[0]).expect("it closes");
    let law = ClosedLoopComputedTorque::new(loops, &[0], rest, [[KP], [KD]]).actuated(&[]);
    let mut controlled = ClosedLoopSimulation::new(loops, law);
    let state = controlled.assembled(&start);
    let error = Dop853::new().integrate(&mut controlled, (0.0, 0.5), state).unwrap_err();
    assert!(matches!(error, IntegrationError::NonFiniteDerivative { .. }), "{error}");
    let reason = controlled.law().last_error().expect("a reason");
    assert!(matches!(reason, LoopError::Unactuated { velocity: 0, .. }), "{reason}");
}
