//! Where numbers are extreme: starts at which everything is zero, angles and speeds of 10⁶, and input that is no
//! number.
#![cfg(feature = "generic")]

use super::free_fall_reference::Kr5;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::methods::{WithMethod, every_adaptive, every_fixed};
use crate::common::models::generic;
use crate::common::random::Random;
use redysim::Real;
use redysim::{
    Dop853, ForwardDynamics, ForwardSimulation, IntegrationError, Integrator, InverseDynamics, Ode45, ZeroTorque,
    redysim,
};

const DOF: usize = Kr5::NV;

redysim! { struct SimplePendulum("models/simple_pendulum.toml"); }

/// KR5's free fall from zero for half a second.
struct FromZero {
    exact: f64,
    allowed: f64,
}

impl WithMethod for FromZero {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let mut simulation = ForwardSimulation::new(&Kr5, ZeroTorque);
        let start = simulation.state(&[0.0; DOF], &[0.0; DOF]);
        let mut first = None;
        let on_step = |step: &redysim::Step<'_, f64, _>| {
            first.get_or_insert(step.end().0);
        };
        let end = method.each_step(&mut simulation, (0.0, 0.5), start, on_step).expect("it falls");
        let (first, error) = (first.expect("a step"), (end.y[1] - self.exact).abs());
        println!("{name}: first step {first:.1e} s, error {error:.1e} rad");
        assert!(first > 0.0 && first <= 0.05, "{name}: first step {first:e} s");
        assert!(error <= self.allowed, "{name}: error {error:e} rad");
    }
}

/// Let go at zero with no speed and no work done, an arm has no size by which a first step could be measured.
#[test]
fn from_a_start_of_nothing_but_zeros_the_first_step_is_finite_and_the_error_honest() {
    let mut simulation = ForwardSimulation::new(&Kr5, ZeroTorque);
    let start = simulation.state(&[0.0; DOF], &[0.0; DOF]);
    let judge = Dop853::new().rtol(1e-13).atol(1e-15).integrate(&mut simulation, (0.0, 0.5), start).expect("it falls");
    let exact = judge.y[1];
    every_adaptive(1e-6, 1e-9, &mut FromZero { exact, allowed: 1e-4 });
    every_adaptive(1e-9, 1e-15, &mut FromZero { exact, allowed: 1e-7 });
    every_fixed(1e-3, &mut FromZero { exact, allowed: 1e-2 });
}

/// Compiled dynamics at `q` and `v` against the generic path over double-double, relative to the largest component.
fn deviations(q: [f64; DOF], v: [f64; DOF]) -> [f64; 2] {
    let judge = generic("kr5");
    let a = [1.0, -2.0, 3.0, -4.0, 5.0, -6.0];
    let [wide_q, wide_v, wide_a] = [&q, &v, &a].map(|values| exact(values));
    let tau: Vec<DoubleDouble> = judge.inverse_dynamics(&wide_q, &wide_v, &wide_a);
    let given = [10.0, 9.0, -8.0, 0.7, 0.6, -0.5];
    let wide: Vec<DoubleDouble> = judge.forward_dynamics(&wide_q, &wide_v, &exact(&given));
    let pairs =
        [(Kr5::inverse_dynamics(&q, &v, &a), rounded(tau)), (Kr5::forward_dynamics(&q, &v, &given), rounded(wide))];
    pairs.map(|(found, expected)| {
        let size = expected.iter().fold(0.0_f64, |size, value| size.max(value.abs()));
        found.iter().zip(&expected).fold(0.0_f64, |worst, (found, value)| Real::maximum(worst, (found - value).abs()))
            / size
    })
}

/// Two parallel axes share one angle, whose rounding would be 6e-11 rad if whole turns were not taken off first.
#[test]
fn at_a_million_radians_and_radians_per_second_forces_are_exact_to_1e_14_and_accelerations_to_1e_12() {
    let mut random = Random::new(9);
    for (angle, speed) in [(3.0, 3.0), (1e3, 3.0), (1e6, 3.0), (3.0, 1e6), (1e6, 1e6)] {
        let worst = (0..50).fold([0.0_f64; 2], |worst, _| {
            let mut vector = |size| <[f64; DOF]>::try_from(random.vector(DOF, size)).expect("a number for each joint");
            let found = deviations(vector(angle), vector(speed));
            [worst[0].max(found[0]), worst[1].max(found[1])]
        });
        println!("{angle:e} rad, {speed:e} rad/s: inverse {:.1e}, forward {:.1e}", worst[0], worst[1]);
        // Accelerations are as sensitive as inertias that span five orders make them.
        assert!(worst[0] <= 1e-14 && worst[1] <= 1e-12, "{worst:?}");
    }
}

/// A pendulum that turns 160,000 times a second, for a tenth of one, from an angle of a million.
#[test]
fn a_motion_at_a_million_radians_per_second_keeps_its_energy() {
    let energy = |y: &[f64; 3]| SimplePendulum::energy(&[y[0]], &[y[1]]).total();
    let mut simulation = ForwardSimulation::new(&SimplePendulum, ZeroTorque);
    let start = simulation.state(&[1e6], &[1e6]);
    let method = Ode45::new().rtol(1e-12).atol(1e-12).max_step(1e-6);
    let end = method.integrate(&mut simulation, (0.0, 0.01), start).expect("it turns");
    assert!((energy(&end.y) / energy(&start) - 1.0).abs() < 1e-14);
    assert!((end.y[0] - 1e6 - 1e4).abs() < 1e-6, "{}", end.y[0]);
}

type Law<'l> = Box<dyn FnMut(f64, &[f64; 1], &[f64; 1]) -> [f64; 1] + 'l>;

/// The pendulum under a law. One type for all laws, so that each method is compiled once.
fn pendulum<'l>(
    law: impl FnMut(f64, &[f64; 1], &[f64; 1]) -> [f64; 1] + 'l,
) -> ForwardSimulation<'static, SimplePendulum, Law<'l>> {
    ForwardSimulation::new(&SimplePendulum, Box::new(law))
}

/// Starts, intervals and forces that are infinite or NaN.
struct BadInput;

impl WithMethod for BadInput {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let free = || pendulum(|_, _, _| [0.0]);
        let state = |q: f64, v: f64| free().state(&[q], &[v]);
        let run = |interval, start| method.integrate(&mut free(), interval, start);
        for (start, component) in [(state(f64::NAN, 0.0), 0), (state(0.1, f64::INFINITY), 1)] {
            let outcome = run((0.0, 1.0), start);
            let expected = Err(IntegrationError::NonFiniteState { t: 0.0, component });
            assert_eq!(outcome, expected, "{name}");
        }
        for interval in [(0.0, 0.0), (0.0, f64::NAN), (f64::NEG_INFINITY, 0.0)] {
            let outcome = run(interval, state(0.1, 0.0));
            assert!(matches!(outcome, Err(IntegrationError::InvalidInterval { .. })), "{name}: {outcome:?}");
        }
        // Backward in time is no mistake.
        assert!(run((1.0, 0.0), state(0.1, 0.0)).is_ok(), "{name}");

        let mut calls = 0;
        let law = |t: f64, _q: &[f64; 1], _v: &[f64; 1]| {
            calls += 1;
            assert!(calls < 1_000_000, "{name} does not end");
            [if t > 0.5 { f64::NAN } else { 0.0 }]
        };
        let outcome = method.integrate(&mut pendulum(law), (0.0, 1.0), state(0.1, 0.0));
        let Err(IntegrationError::NonFiniteDerivative { t, .. } | IntegrationError::NonFiniteState { t, .. }) = outcome
        else {
            panic!("{name}: {outcome:?}")
        };
        assert!((0.5..0.52).contains(&t), "{name}: noticed at {t} s");
    }
}

#[test]
fn infinite_and_nan_are_typed_errors_with_bounded_work_in_every_method() {
    every_fixed(1e-2, &mut BadInput);
    every_adaptive(1e-6, 1e-9, &mut BadInput);
}

/// Steps and tolerances that cannot be.
struct Refused;

impl WithMethod for Refused {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let mut calls = 0;
        let law = |_t: f64, _q: &[f64; 1], _v: &[f64; 1]| {
            calls += 1;
            [0.0]
        };
        let mut simulation = pendulum(law);
        let start = simulation.state(&[0.1], &[0.0]);
        let outcome = method.integrate(&mut simulation, (0.0, 1.0), start);
        drop(simulation);
        assert!(
            matches!(
                outcome,
                Err(IntegrationError::InvalidStep { .. }
                    | IntegrationError::InvalidRelativeTolerance { .. }
                    | IntegrationError::InvalidAbsoluteTolerance { .. })
            ),
            "{name}: {outcome:?}"
        );
        assert_eq!(calls, 0, "{name} evaluates before it refuses");
    }
}

#[test]
fn steps_and_tolerances_that_cannot_be_are_refused_before_any_work() {
    for step in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        every_fixed(step, &mut Refused);
    }
    for (rtol, atol) in [(0.0, 1e-9), (-1e-6, 1e-9), (f64::NAN, 1e-9), (1e-6, 0.0), (1e-6, -1.0), (1e-6, f64::NAN)] {
        every_adaptive(rtol, atol, &mut Refused);
    }
}

#[test]
#[should_panic(expected = "`tau` must have 6 elements, but it has 5: `kr5` has 6 coordinates and 6 velocities")]
fn the_run_time_path_names_a_vector_of_wrong_length() {
    let _: Vec<f64> = generic("kr5").forward_dynamics(&vec![0.0; 6], &vec![0.0; 6], &vec![0.0; 5]);
}
