//! Every typed error, provoked, with bounded work.

#[allow(dead_code)]
mod problems;

use std::ops::ControlFlow::{Break, Continue};

use problems::run;
use redysim_runtime::IntegrationError::{self, *};
use redysim_runtime::integrate::Accepted;
use redysim_runtime::{Event, Gauss4, Integrator, Ode, Ode5, Ode45};

fn still(_t: f64, _y: &[f64; 2], dydt: &mut [f64; 2]) {
    *dydt = [0.0, 0.0];
}

/// Neither method may evaluate where the error is in the question itself.
fn never(t: f64, _y: &[f64; 2], _dydt: &mut [f64; 2]) {
    panic!("evaluated at {t}");
}

#[test]
fn an_interval_needs_two_finite_different_ends() {
    for (from, to) in [
        (1.0, 1.0),
        (0.0, f64::NAN),
        (f64::NAN, 0.0),
        (0.0, f64::INFINITY),
        (f64::NEG_INFINITY, 0.0),
        (-f64::MAX, f64::MAX),
    ] {
        for outcome in [
            Ode45::new().integrate(&mut never, (from, to), [0.0; 2]),
            Ode5::new(0.1).integrate(&mut never, (from, to), [0.0; 2]),
            Ode45::new().solve(&mut never, (from, to), [0.0; 2], [from], |_, _| panic!("answered")),
        ] {
            assert!(matches!(outcome, Err(BadInterval { .. })), "{from} to {to}: {outcome:?}");
        }
    }
}

#[test]
fn a_relative_tolerance_is_at_least_100_roundoff_units() {
    let smallest = 100.0 * f64::EPSILON;
    for value in [0.0, -1e-3, f64::NAN, f64::INFINITY, 0.99 * smallest] {
        let outcome = Ode45::new().rtol(value).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
        assert!(matches!(outcome, Err(BadRelativeTolerance { smallest: s, .. }) if s == smallest), "{outcome:?}");
    }
    assert!(Ode45::new().rtol(smallest).integrate(&mut still, (0.0, 1.0), [0.0; 2]).is_ok());
}

#[test]
fn an_absolute_tolerance_is_positive_and_finite() {
    for value in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
        let outcome = Ode45::new().atol(value).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
        assert!(matches!(outcome, Err(BadAbsoluteTolerance { component: None, .. })), "{outcome:?}");
        let outcome = Ode45::new().atol_each(&[1e-6, value]).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
        assert!(matches!(outcome, Err(BadAbsoluteTolerance { component: Some(1), .. })), "{outcome:?}");
    }
}

#[test]
fn a_list_of_absolute_tolerances_has_one_for_each_component() {
    for given in [0, 1, 3] {
        let outcome = Ode45::new().atol_each(&[1e-6; 3][..given]).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
        assert_eq!(outcome, Err(WrongToleranceCount { given, needed: 2 }));
    }
}

#[test]
fn a_given_step_is_positive_and_finite() {
    for value in [0.0, -0.1, f64::NAN, f64::INFINITY] {
        for (name, outcome) in [
            ("step", Ode5::new(value).integrate(&mut never, (0.0, 1.0), [0.0; 2])),
            ("initial step", Ode45::new().initial_step(value).integrate(&mut never, (0.0, 1.0), [0.0; 2])),
            ("maximum step", Ode45::new().max_step(value).integrate(&mut never, (0.0, 1.0), [0.0; 2])),
        ] {
            assert!(matches!(outcome, Err(BadStep { option, .. }) if option == name), "{name} {value}: {outcome:?}");
        }
    }
}

#[test]
fn asked_times_lie_within_the_interval() {
    for (interval, t) in [((0.0, 1.0), -0.1), ((0.0, 1.0), 1.1), ((1.0, 0.0), 1.1), ((0.0, 1.0), f64::NAN)] {
        let outcome = Ode45::new().solve(&mut still, interval, [0.0; 2], [0.5, t], |_, _| {});
        assert!(matches!(outcome, Err(AskedTimeOutside { .. })), "{t}: {outcome:?}");
        let outcome = Ode45::new().solve(&mut never, interval, [0.0; 2], [t], |_, _| {});
        assert!(matches!(outcome, Err(AskedTimeOutside { .. })), "{t}: {outcome:?}");
    }
}

#[test]
fn asked_times_follow_the_direction_of_integration() {
    let outcome = Ode45::new().solve(&mut still, (0.0, 1.0), [0.0; 2], [0.1, 0.5, 0.4], |_, _| {});
    assert_eq!(outcome, Err(AskedTimesOutOfOrder { t: 0.4, previous: 0.5 }));
    let outcome = Ode5::new(0.1).solve(&mut still, (1.0, 0.0), [0.0; 2], [0.5, 0.6], |_, _| {});
    assert_eq!(outcome, Err(AskedTimesOutOfOrder { t: 0.6, previous: 0.5 }));
}

#[test]
fn the_start_is_finite() {
    for value in [f64::NAN, f64::INFINITY] {
        let expected = Err(NonFiniteState { t: 0.25, component: 1 });
        assert_eq!(Ode45::new().integrate(&mut never, (0.25, 1.0), [0.0, value]), expected);
        assert_eq!(Ode5::new(0.1).integrate(&mut never, (0.25, 1.0), [0.0, value]), expected);
    }
}

#[test]
fn a_derivative_that_is_not_finite_at_the_start_is_named() {
    for bad in [f64::NAN, f64::INFINITY] {
        for (outcome, calls) in
            [run(&Ode45::new(), 1.0, |_, _| [1.0, bad]), run(&Ode5::new(0.1), 1.0, |_, _| [1.0, bad])]
        {
            assert_eq!(outcome, Err(NonFiniteDerivative { t: 0.0, component: 1 }));
            assert_eq!(calls, 1);
        }
    }
}

#[test]
fn a_derivative_that_ceases_to_be_finite_is_named_with_its_time() {
    let f = |t: f64, _: &[f64; 2]| [if t > 0.55 { f64::NAN } else { 1.0 }, 0.0];
    let (outcome, calls) = run(&Ode5::new(0.1), 1.0, f);
    assert!(matches!(outcome, Err(NonFiniteDerivative { t, component: 0 }) if t > 0.55 && t <= 0.6), "{outcome:?}");
    assert!(calls <= 37);

    let (outcome, calls) = run(&Ode45::new(), 1.0, f);
    assert!(matches!(outcome, Err(NonFiniteDerivative { t, component: 0 }) if (t - 0.55).abs() < 1e-14), "{outcome:?}");
    println!("{calls} evaluations until the step was smallest");
    assert!(calls < 2000);
}

/// ẏ = −2√y has the solution (1 − t)². A first step over the whole interval asks for roots of negative numbers.
#[test]
fn a_trial_beyond_the_domain_only_makes_the_step_smaller() {
    let mut left_domain = false;
    let method = Ode45::new().initial_step(0.95).max_step(0.95).rtol(1e-6).atol(1e-9);
    let (outcome, _) = run(&method, 0.95, |_, y| {
        left_domain |= y[0] < 0.0;
        [-2.0 * y[0].sqrt(), 0.0]
    });
    let solution = outcome.unwrap();
    assert!(left_domain && solution.statistics.rejected > 0);
    assert!((solution.y[0] - 0.0025).abs() < 1e-6, "{:?}", solution.y);
}

/// ẏ = y² has a pole at t = 1.
#[test]
fn a_singularity_stops_the_steps_with_bounded_work() {
    let (outcome, calls) = run(&Ode45::new().rtol(1e-8), 2.0, |_, y| [y[0] * y[0], 0.0]);
    println!("{outcome:?} after {calls} evaluations");
    assert!(matches!(outcome, Err(StepTooSmall { t, step }) if (t - 1.0).abs() < 1e-6 && step < 1e-14), "{outcome:?}");
    assert!(calls < 5000);
}

#[test]
fn a_jump_is_crossed_or_reported_but_never_waited_at() {
    let jump = |height: f64| move |t: f64, _: &[f64; 2]| [if t < 0.3 { 0.0 } else { height }, 0.0];
    let (outcome, calls) = run(&Ode45::new(), 1.0, jump(1.0));
    // No estimate holds across a jump.
    let y = outcome.unwrap().y;
    assert!((y[0] - 1.7).abs() < 2e-2, "{y:?}");
    assert!(calls < 500);
    let (outcome, calls) = run(&Ode45::new().rtol(1e-13).atol(1e-13), 1.0, jump(1e9));
    assert!(matches!(outcome, Err(StepTooSmall { t, .. }) if (t - 0.3).abs() < 1e-14), "{outcome:?}");
    assert!(calls < 1000);
}

#[test]
fn a_step_below_the_spacing_of_times_is_refused() {
    let outcome = Ode5::new(1e-3).max_steps(u64::MAX).integrate(&mut still, (1e15, 1e15 + 10.0), [0.0; 2]);
    assert_eq!(outcome, Err(StepTooSmall { t: 1e15, step: 1e-3 }));
}

#[test]
fn a_state_that_overflows_is_reported() {
    let (outcome, _) = run(&Ode5::new(0.5), 10.0, |_, y| [y[0], 1e308]);
    assert!(matches!(outcome, Err(NonFiniteState { component: 1, .. })), "{outcome:?}");
    let (outcome, _) = run(&Ode45::new(), 10.0, |_, y| [y[0], 1e308]);
    assert!(matches!(outcome, Err(NonFiniteState { component: 1, .. })), "{outcome:?}");
}

/// The stages of the step are finite, its end is not.
#[test]
fn an_end_that_overflows_is_not_a_solution() {
    let (outcome, _) = run(&Gauss4::new(1.5), 1.5, |_, _| [1e308, 0.0]);
    assert!(outcome.is_ok(), "{outcome:?}");
    let mut steep = |_t: f64, _y: &[f64; 1], dydt: &mut [f64; 1]| *dydt = [1e308];
    let outcome = Gauss4::new(1.5).integrate(&mut steep, (0.0, 1.5), [0.5e308]);
    assert_eq!(outcome, Err(NonFiniteState { t: 1.5, component: 0 }));
}

/// Moves the state to where there is none, but only within a step, where an event ends the integration.
struct Lost;

impl Ode<f64, [f64; 2]> for Lost {
    fn derivative(&mut self, _t: f64, _y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [1.0, 1.0];
    }

    fn accepted(&mut self, t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
        if t < 1.0 {
            y[1] = f64::NAN;
        }
        Accepted::Corrected
    }
}

#[test]
fn a_stop_that_is_corrected_to_no_number_is_reported() {
    let events = &mut [Event::rising(&|_, y: &[f64; 2]| y[0] - 0.5)];
    let outcome = Ode5::new(1.0).watch(&mut Lost, (0.0, 1.0), [0.0; 2], events, |_| Continue(()), |_| Break(()));
    assert!(matches!(outcome, Err(NonFiniteState { t, component: 1 }) if (t - 0.5).abs() < 1e-9), "{outcome:?}");
}

#[test]
fn steps_are_counted_before_they_become_too_many() {
    let outcome = Ode5::new(1e-300).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
    assert_eq!(outcome, Err(TooManySteps { t: 0.0, limit: 1_000_000_000 }));
    assert!(Ode5::new(0.1).max_steps(10).integrate(&mut still, (0.0, 1.0), [0.0; 2]).is_ok());
    let outcome = Ode5::new(0.1).max_steps(9).integrate(&mut never, (0.0, 1.0), [0.0; 2]);
    assert_eq!(outcome, Err(TooManySteps { t: 0.0, limit: 9 }));

    let (outcome, calls) = run(&Ode45::new().max_steps(50), 1e3, |_, y| [-1e3 * y[0], 0.0]);
    assert!(matches!(outcome, Err(TooManySteps { limit: 50, t }) if t > 0.0 && t < 1e3), "{outcome:?}");
    assert_eq!(calls, 301);
}

#[test]
fn messages_name_the_rule_the_value_and_the_way_out() {
    let cases: [(IntegrationError<f64>, &[&str]); 18] = [
        (BadInterval { from: 1.0, to: 1.5 }, &["interval", "1.0", "1.5", "length"]),
        (BadRelativeTolerance { value: 1e-17, smallest: 2e-14 }, &["relative", "1e-17", "2e-14", "larger"]),
        (BadAbsoluteTolerance { component: None, value: -1.0 }, &["absolute", "-1.0", "positive"]),
        (BadAbsoluteTolerance { component: Some(3), value: 0.0 }, &["absolute", "component 3", "0.0"]),
        (WrongToleranceCount { given: 3, needed: 13 }, &["13 components", "3 absolute tolerances"]),
        (BadStep { option: "maximum step", value: -0.1 }, &["maximum step", "-0.1", "positive"]),
        (AskedTimeOutside { t: 2.0, from: 0.0, to: 1.0 }, &["t = 2.0", "0.0 to 1.0", "interval"]),
        (AskedTimesOutOfOrder { t: 2.0, previous: 3.0 }, &["t = 2.0", "3.0", "sort"]),
        (NonFiniteState { t: 0.5, component: 4 }, &["component 4", "state", "t = 0.5", "start"]),
        (NonFiniteDerivative { t: 0.5, component: 4 }, &["component 4", "derivative", "t = 0.5"]),
        (NoCoordinates, &["0 coordinates", "coordinate_rates", "Ode4"]),
        (NoEigenvalues { t: 0.5 }, &["eigenvalues", "t = 0.5", "another state"]),
        (NonFiniteEvent { t: 0.5, event: 2 }, &["event 2", "t = 0.5", "finite"]),
        (Refused { t: 0.5 }, &["refused", "t = 0.5", "last_error"]),
        (NotConverged { t: 0.5, step: 1e-3 }, &["t = 0.5", "0.001", "iteration", "tangent", "smaller"]),
        (StepTooSmall { t: 0.5, step: 1e-16 }, &["t = 0.5", "1e-16", "singularity"]),
        (Stiff { t: 0.5, step: 1e-3, remaining: 12345 }, &["stiff", "t = 0.5", "0.001", "12345", "Radau5"]),
        (TooManySteps { t: 0.5, limit: 7 }, &["t = 0.5", "7 steps", "max_steps", "jumps"]),
    ];
    for (error, words) in cases {
        let message = (&error as &dyn std::error::Error).to_string();
        for word in words {
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
