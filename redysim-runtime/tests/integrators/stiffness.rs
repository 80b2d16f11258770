//! Explicit methods say where an equation is stiff, and only there.

use crate::mechanisms::Arm;
use redysim_runtime::IntegrationError::{self, Stiff};
use redysim_runtime::integrate::stability::StabilityFunction;
use redysim_runtime::integrate::tableau::{DORMAND_PRINCE, DORMAND_PRINCE_853, RUNGE_KUTTA_4};
use redysim_runtime::{Dop853, ForwardSimulation, Integrator, Ode45, Pd, Solution, ZeroTorque};

/// ẏ = λ (y − cos t) − sin t from the smooth solution cos t.
fn relaxation(rate: f64) -> impl FnMut(f64, &[f64; 1], &mut [f64; 1]) {
    move |t, y, dydt| dydt[0] = -rate * (y[0] - t.cos()) - t.sin()
}

#[test]
fn real_intervals_of_stability_are_those_of_the_stability_functions() {
    let reach = |function: f64, table: f64| assert!((function - table).abs() < 1e-3, "{function} is not {table}");
    reach(StabilityFunction::new(&RUNGE_KUTTA_4).reach((-1.0, 0.0)), RUNGE_KUTTA_4.stable_to);
    reach(StabilityFunction::new(&DORMAND_PRINCE).reach((-1.0, 0.0)), DORMAND_PRINCE.stable_to);
    reach(StabilityFunction::new(&DORMAND_PRINCE_853).reach((-1.0, 0.0)), DORMAND_PRINCE_853.stable_to);
}

#[test]
fn a_stiff_equation_is_recognised_early_with_its_step_and_what_is_left() {
    for rtol in [1e-3, 1e-6, 1e-9] {
        let (mut calls, mut f) = (0, relaxation(1e5));
        let mut counted = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| {
            calls += 1;
            f(t, y, dydt);
        };
        let outcome = Ode45::new().rtol(rtol).integrate(&mut counted, (0.0, 10.0), [1.0]);
        let Err(Stiff { t, step, remaining }) = outcome else { panic!("{outcome:?}") };
        println!("{outcome:?} after {calls} evaluations");
        assert!((step * 1e5 / 3.3 - 1.0).abs() < 0.25, "{step}");
        assert!((remaining as f64 * step / (10.0 - t) - 1.0).abs() < 1e-3);
        assert!(calls < 10_000 && t < 0.1);
        let (mut calls, mut f) = (0, relaxation(1e5));
        let mut counted = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| {
            calls += 1;
            f(t, y, dydt);
        };
        let outcome = Dop853::new().rtol(rtol).integrate(&mut counted, (0.0, 10.0), [1.0]);
        let Err(Stiff { step, .. }) = outcome else { panic!("{outcome:?}") };
        println!("{outcome:?} after {calls} evaluations");
        assert!((step * 1e5 / 6.3 - 1.0).abs() < 0.25, "{step}");
        assert!(calls < 20_000);
    }
}

#[test]
fn steps_that_are_not_too_many_are_taken() {
    let end = Ode45::new().integrate(&mut relaxation(1e3), (0.0, 10.0), [1.0]).unwrap();
    println!("{:?}", end.statistics);
    assert!(end.statistics.steps > 2000);
    assert_eq!(end.statistics.jacobians, 0);
    let less = Ode45::new().stiffness_limit(Some(1000)).integrate(&mut relaxation(1e3), (0.0, 10.0), [1.0]);
    assert!(matches!(less, Err(Stiff { remaining, .. }) if remaining > 1000), "{less:?}");
}

#[test]
fn the_test_can_be_switched_off() {
    let method = Ode45::new().stiffness_limit(None).max_steps(5000);
    let outcome = method.integrate(&mut relaxation(1e5), (0.0, 10.0), [1.0]);
    assert!(matches!(outcome, Err(IntegrationError::TooManySteps { .. })), "{outcome:?}");
}

fn held(kp: f64, kd: f64, to: f64, rtol: f64) -> Result<Solution<f64, [f64; 5]>, IntegrationError<f64>> {
    let law = Pd { target: [0.5, 1.0], kp: [kp; 2], kd: [kd; 2] };
    let mut simulation = ForwardSimulation::new(&Arm, law);
    let start = simulation.state(&[0.0, 0.0], &[0.0, 0.0]);
    Ode45::new().rtol(rtol).atol(1e-3 * rtol).integrate(&mut simulation, (0.0, to), start)
}

#[test]
fn an_arm_with_heavy_damping_is_stiff() {
    let outcome = held(1e3, 2e3, 100.0, 1e-6);
    println!("{outcome:?}");
    assert!(matches!(outcome, Err(Stiff { .. })), "{outcome:?}");
}

/// With every test of the rest of the interval passed, so that only the eigenvalues decide.
#[test]
fn fast_swings_long_runs_and_tight_tolerances_are_not_stiff() {
    let mut fast = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -1e4 * y[0]];
    let tolerances = [1e-2, 1e-3, 1e-6, 1e-12];
    for rtol in tolerances.into_iter().take(if cfg!(debug_assertions) { 3 } else { tolerances.len() }) {
        let end =
            Ode45::new().rtol(rtol).stiffness_limit(Some(0)).integrate(&mut fast, (0.0, 20.0), [1.0, 0.0]).unwrap();
        println!("{:?}", end.statistics);
        let end =
            Dop853::new().rtol(rtol).stiffness_limit(Some(0)).integrate(&mut fast, (0.0, 20.0), [1.0, 0.0]).unwrap();
        println!("{:?}", end.statistics);
    }
    // Velocities that do not count make a swing look stiff whenever it turns back, again and again: what saves it is
    // that the eigenvalues are asked.
    let mut jacobians = 0;
    for rtol in [1e-2, 3e-3, 1e-3] {
        let tolerances = [1e-9, 1e9];
        let method = Ode45::new().rtol(rtol).atol_each(&tolerances).stiffness_limit(Some(0));
        jacobians += method.integrate(&mut fast, (0.0, 20.0), [1.0, 0.0]).unwrap().statistics.jacobians;
    }
    println!("{jacobians} Jacobians");
    assert!(jacobians > 0);
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = simulation.state(&[2.0, 1.0], &[0.0, 0.0]);
    let steps = [(1e-3, 1.0), (1e-13, 1.0), (1e-3, 1e-3), (1e-6, 1e-4)];
    for (rtol, largest) in steps.into_iter().take(if cfg!(debug_assertions) { 3 } else { steps.len() }) {
        let method = Ode45::new().rtol(rtol).atol(rtol).max_step(largest).stiffness_limit(Some(0));
        method.integrate(&mut simulation, (0.0, 5.0), start).unwrap();
    }
}

#[test]
fn arms_with_ordinary_gains_are_not_refused() {
    for (kp, kd) in [(50.0, 1.0), (100.0, 20.0), (1000.0, 50.0)] {
        for rtol in [1e-3, 1e-6, 1e-10] {
            let end = held(kp, kd, 20.0, rtol).unwrap();
            println!("{kp} {kd} {rtol:e}: {:?}", end.statistics);
        }
    }
}

#[test]
fn the_message_of_a_stiff_equation_names_its_time_and_the_remedies() {
    let message = Stiff { t: 0.5, step: 1e-5, remaining: 1_000_000 }.to_string();
    for word in ["stiff", "t = 0.5", "1e-5", "1000000", "Ode15s", "Radau5", "stiffness_limit"] {
        assert!(message.contains(word), "{message:?} lacks {word:?}");
    }
}
