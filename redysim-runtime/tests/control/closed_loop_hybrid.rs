//! Simulation of closed loops in which some joints follow a motion, against inverse dynamics of that motion.

use crate::slider_crank::{ByAngle, ByCosine, by_cosine};
use redysim_runtime::{
    ClosedLoop, ClosedLoopHybridSimulation, ClosedLoopInverse, Integrator, LoopError, Motion, Ode45, Stabilisation,
    ZeroTorque,
};

/// The slider back and forth; at an amplitude of 0.5 m farther than crank and rod reach, 1.3 m.
fn sliding(amplitude: f64, t: f64) -> Motion<[f64; 1], [f64; 1]> {
    let (s, c) = (2.0 * t).sin_cos();
    Motion { q: [0.9 - amplitude * c], v: [2.0 * amplitude * s], a: [4.0 * amplitude * c] }
}

/// The same motion with nonsense for the joints that do not follow it.
fn by_angle(amplitude: f64, t: f64) -> Motion<[f64; 3], [f64; 3]> {
    let Motion { q: [q], v: [v], a: [a] } = sliding(amplitude, t);
    Motion { q: [9.0, -9.0, q], v: [7.0, 7.0, v], a: [5.0, 5.0, a] }
}

const GUESS: [f64; 3] = [1.7, -2.2, 0.6];

#[track_caller]
fn close(name: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{name}");
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() <= tolerance, "{name}[{i}] is {found}, not {expected}");
    }
}

/// The tolerance is a thousand times that of the steps, which forces multiply by accelerations.
#[test]
fn what_a_prescribed_slider_takes_is_what_inverse_dynamics_finds() {
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&ByAngle), &[2], GUESS).actuated(&[2]);
    let mut expected = |t: f64| inverse.at(t, &|t| sliding(0.2, t)).expect("within reach");
    let method = Ode45::new().rtol(1e-10).atol(1e-12);
    for stabilisation in [Stabilisation::Projection, Stabilisation::Baumgarte { alpha: 20.0 }, Stabilisation::None] {
        let mut simulation =
            ClosedLoopHybridSimulation::new(ClosedLoop::new(&ByAngle), &[2], |t| by_angle(0.2, t), ZeroTorque)
                .stabilisation(stabilisation);
        let mut state = simulation.start(0.0, &GUESS, &[0.0; 3]).expect("it closes");
        for k in 1..=4 {
            let t = 0.3 * f64::from(k);
            state = method.integrate(&mut simulation, (t - 0.3, t), state).expect("within reach").y;
            let expected = expected(t);
            let at = simulation.closed(t, &state).expect("closed");
            close("q", &at.q, &expected.motion.q, 1e-8);
            close("v", &at.v, &expected.motion.v, 1e-7);
            let found = simulation.forced_motion(t, &state).expect("regular");
            close("a", &found.motion.a, &expected.motion.a, 1e-7);
            close("forces", &found.motion.tau, &expected.forces, 1e-6);
            close("multipliers", &found.multipliers, &expected.multipliers, 1e-6);
            assert_eq!([found.motion.tau[0], found.motion.tau[1]], [0.0; 2], "nothing drives the others");
            assert_eq!(at.q[2], sliding(0.2, t).q[0], "the slider is where the motion has it");
        }
    }
}

#[test]
fn prescribed_motion_does_not_depend_on_the_coordinates() {
    let motion = |t: f64| {
        let Motion { q, v, a } = by_angle(0.2, t);
        Motion { q: by_cosine(&q), v, a }
    };
    let method = Ode45::new().rtol(1e-10).atol(1e-12);
    let angle = ClosedLoop::new(&ByAngle);
    let mut angle = ClosedLoopHybridSimulation::new(angle, &[2], |t| by_angle(0.2, t), ZeroTorque);
    let mut cosine = ClosedLoopHybridSimulation::new(ClosedLoop::new(&ByCosine), &[2], motion, ZeroTorque);
    let start = angle.start(0.0, &GUESS, &[0.0; 3]).expect("it closes");
    let expected = method.integrate(&mut angle, (0.0, 1.0), start).expect("within reach").y;
    let start = cosine.start(0.0, &by_cosine(&GUESS), &[0.0; 3]).expect("it closes");
    let found = method.integrate(&mut cosine, (0.0, 1.0), start).expect("within reach").y;
    let (expected, found) = (angle.split(1.0, &expected), cosine.split(1.0, &found));
    close("q", &found.q, &by_cosine(&expected.q), 1e-8);
    close("v", &found.v, &expected.v, 1e-7);
    close("work", &[found.actuator_energy], &[expected.actuator_energy], 1e-7);
}

#[test]
fn a_motion_beyond_the_reach_of_the_links_ends_the_simulation_with_the_reason() {
    let loops = ClosedLoop::new(&ByAngle);
    let mut simulation = ClosedLoopHybridSimulation::new(loops, &[2], |t| by_angle(0.5, t), ZeroTorque);
    let start = simulation.start(0.5, &GUESS, &[0.0; 3]).expect("it closes");
    let ended = Ode45::new().integrate(&mut simulation, (0.5, 2.0), start);
    assert!(ended.is_err(), "{ended:?}");
    let reason = simulation.last_error();
    assert!(
        matches!(reason, Some(LoopError::NoConvergence { .. } | LoopError::InconsistentVelocity { .. })),
        "{reason:?}"
    );
    assert!(matches!(simulation.start(1.5, &GUESS, &[0.0; 3]), Err(LoopError::CannotClose { .. })));
}
