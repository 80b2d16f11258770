//! Every typed error, provoked with every method, with bounded work.

use std::ops::ControlFlow::{Break, Continue};

use redysim_runtime::IntegrationError::{self, *};
use redysim_runtime::integrate::algorithm::Algorithm;
use redysim_runtime::integrate::step_control::EstimatesErrors;
use redysim_runtime::integrate::{Accepted, Adaptive, FixedStep};
use redysim_runtime::{Event, Gauss4, Integrator, Ode, Ode45, Solution};

/// A method that evaluates the derivative this often counts as one that does not end.
const ENDLESS: u32 = 100_000;

type Function<'f> = dyn FnMut(f64, &[f64; 2]) -> [f64; 2] + 'f;

/// ẏ = f(t, y), of which the first component is a coordinate, as `SemiImplicitEuler` requires. One type for all tests, so
/// that each method is compiled once.
struct Equation<'f> {
    f: Box<Function<'f>>,
    calls: u32,
}

impl Ode<f64, [f64; 2]> for Equation<'_> {
    fn derivative(&mut self, t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        self.calls += 1;
        assert!(self.calls < ENDLESS, "no end of evaluations at t = {t}");
        *dydt = (self.f)(t, y);
    }

    fn coordinate_rates(&mut self, t: f64, y: &[f64; 2], rates: &mut [f64; 2]) -> usize {
        rates[0] = (self.f)(t, y)[0];
        1
    }
}

fn equation<'f>(f: impl FnMut(f64, &[f64; 2]) -> [f64; 2] + 'f) -> Equation<'f> {
    Equation { f: Box::new(f), calls: 0 }
}

type Outcome = Result<Solution<f64, [f64; 2]>, IntegrationError<f64>>;

/// Integrates from [1, 1] at 0; the outcome, and how often the right-hand side was called.
fn run(method: &impl Integrator<f64>, to: f64, f: impl FnMut(f64, &[f64; 2]) -> [f64; 2]) -> (Outcome, u32) {
    let mut equation = equation(f);
    (method.integrate(&mut equation, (0.0, to), [1.0, 1.0]), equation.calls)
}

fn adaptive<A: EstimatesErrors>() -> Adaptive<'static, f64, A> {
    Adaptive::new()
}

fn fixed<A: Algorithm>(step: f64) -> FixedStep<f64, A> {
    FixedStep::new(step)
}

fn still(_t: f64, _y: &[f64; 2]) -> [f64; 2] {
    [0.0, 0.0]
}

/// Methods check their arguments before they evaluate the derivative.
fn never(t: f64, _y: &[f64; 2]) -> [f64; 2] {
    panic!("evaluated at {t}");
}

#[test]
fn an_interval_needs_two_finite_different_ends() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        let (nan, infinity) = (f64::NAN, f64::INFINITY);
        let bad = [(1.0, 1.0), (0.0, nan), (nan, 0.0), (0.0, infinity), (-infinity, 0.0), (-f64::MAX, f64::MAX)];
        for interval in bad {
            for outcome in [
                method.integrate(&mut equation(never), interval, [0.0; 2]),
                method.solve(&mut equation(never), interval, [0.0; 2], [interval.0], |_, _| panic!("answered")),
            ] {
                assert!(matches!(outcome, Err(InvalidInterval { .. })), "{name} over {interval:?}: {outcome:?}");
            }
        }
    }
    every_method!(check, 0.1);
}

#[test]
fn a_relative_tolerance_is_at_least_100_roundoff_units() {
    fn check<A: EstimatesErrors>(name: &str) {
        let smallest = 100.0 * f64::EPSILON;
        for value in [0.0, -1e-3, f64::NAN, f64::INFINITY, 0.99 * smallest] {
            let (outcome, _) = run(&adaptive::<A>().rtol(value), 1.0, never);
            let refused = matches!(outcome, Err(InvalidRelativeTolerance { smallest: s, .. }) if s == smallest);
            assert!(refused, "{name}, {value}: {outcome:?}");
        }
        assert!(run(&adaptive::<A>().rtol(smallest), 1.0, still).0.is_ok(), "{name}");
    }
    every_adaptive!(check);
}

#[test]
fn an_absolute_tolerance_is_positive_and_finite() {
    fn check<A: EstimatesErrors>(name: &str) {
        for value in [0.0, -1e-3, f64::NAN, f64::INFINITY] {
            let (outcome, _) = run(&adaptive::<A>().atol(value), 1.0, never);
            assert!(matches!(outcome, Err(InvalidAbsoluteTolerance { component: None, .. })), "{name}: {outcome:?}");
            let each = [1e-6, value];
            let outcome =
                Adaptive::<f64, A>::new().atol_each(&each).integrate(&mut equation(never), (0.0, 1.0), [0.0; 2]);
            let refused = matches!(outcome, Err(InvalidAbsoluteTolerance { component: Some(1), .. }));
            assert!(refused, "{name}: {outcome:?}");
        }
    }
    every_adaptive!(check);
}

#[test]
fn a_list_of_absolute_tolerances_has_one_for_each_component() {
    fn check<A: EstimatesErrors>(name: &str) {
        for given in [0, 1, 3] {
            let (outcome, _) = run(&adaptive::<A>().atol_each(&[1e-6; 3][..given]), 1.0, never);
            assert_eq!(outcome, Err(WrongToleranceCount { given, needed: 2 }), "{name}");
        }
    }
    every_adaptive!(check);
}

#[test]
fn a_given_step_is_positive_and_finite() {
    fn check(name: &str, option: &str, method: &impl Integrator<f64>) {
        let (outcome, _) = run(method, 1.0, never);
        assert!(matches!(outcome, Err(InvalidStep { option: o, .. }) if o == option), "{name}: {outcome:?}");
    }
    const BAD: [f64; 4] = [0.0, -0.1, f64::NAN, f64::INFINITY];
    fn check_adaptive<A: EstimatesErrors>(name: &str) {
        for value in BAD {
            check(name, "initial step", &adaptive::<A>().initial_step(value));
            check(name, "maximum step", &adaptive::<A>().max_step(value));
        }
    }
    fn check_fixed<A: Algorithm>(name: &str) {
        for value in BAD {
            check(name, "step", &fixed::<A>(value));
        }
    }
    every_adaptive!(check_adaptive);
    every_fixed!(check_fixed);
}

#[test]
fn save_times_lie_within_the_interval_and_follow_its_direction() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        for (interval, t) in [((0.0, 1.0), -0.1), ((0.0, 1.0), 1.1), ((1.0, 0.0), 1.1), ((0.0, 1.0), f64::NAN)] {
            let outcome = method.solve(&mut equation(still), interval, [0.0; 2], [0.5, t], |_, _| {});
            assert!(matches!(outcome, Err(SaveTimeOutside { .. })), "{name}, {t}: {outcome:?}");
            let outcome = method.solve(&mut equation(never), interval, [0.0; 2], [t], |_, _| {});
            assert!(matches!(outcome, Err(SaveTimeOutside { .. })), "{name}, {t}: {outcome:?}");
        }
        let outcome = method.solve(&mut equation(still), (0.0, 1.0), [0.0; 2], [0.1, 0.5, 0.4], |_, _| {});
        assert_eq!(outcome, Err(SaveTimesOutOfOrder { t: 0.4, previous: 0.5 }), "{name}");
        let outcome = method.solve(&mut equation(still), (1.0, 0.0), [0.0; 2], [0.5, 0.6], |_, _| {});
        assert_eq!(outcome, Err(SaveTimesOutOfOrder { t: 0.6, previous: 0.5 }), "{name}");
    }
    every_method!(check, 0.1);
}

#[test]
fn a_start_or_a_first_derivative_that_is_not_finite_is_named() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        for bad in [f64::NAN, f64::INFINITY] {
            let outcome = method.integrate(&mut equation(never), (0.25, 1.0), [0.0, bad]);
            assert_eq!(outcome, Err(NonFiniteState { t: 0.25, component: 1 }), "{name}");
            let (outcome, calls) = run(method, 1.0, |_, _| [1.0, bad]);
            assert_eq!((outcome, calls), (Err(NonFiniteDerivative { t: 0.0, component: 1 }), 1), "{name}");
        }
    }
    every_method!(check, 0.1);
}

#[test]
fn a_derivative_that_ceases_to_be_finite_is_named_with_its_time() {
    fn f(t: f64, _y: &[f64; 2]) -> [f64; 2] {
        [if t > 0.55 { f64::NAN } else { 1.0 }, 0.0]
    }
    fn check_adaptive<A: EstimatesErrors>(name: &str) {
        let (outcome, calls) = run(&adaptive::<A>(), 1.0, f);
        println!("{name}: {calls} evaluations until the step was smallest");
        let named = matches!(outcome, Err(NonFiniteDerivative { t, component: 0 }) if (t - 0.55).abs() < 1e-14);
        let most = if name == "Dop853" { 2000 } else { 1000 };
        assert!(named && calls < most, "{name}: {outcome:?} after {calls}");
    }
    fn check_fixed<A: Algorithm>(name: &str) {
        let (outcome, calls) = run(&fixed::<A>(0.1), 1.0, f);
        let named = matches!(outcome, Err(NonFiniteDerivative { t, component: 0 }) if t > 0.55 && t <= 0.6 + 1e-15);
        let most = if name == "Dop8" { 75 } else { 38 };
        assert!(named && calls < most, "{name}: {outcome:?} after {calls}");
    }
    every_adaptive!(check_adaptive);
    every_fixed!(check_fixed);
}

/// ẏ = −2√y has the solution (1 − t)², and is not defined further than 10⁻³ from it: a first step over the whole
/// interval leaves that domain.
#[test]
fn a_trial_beyond_the_domain_only_makes_the_step_smaller() {
    fn check<A: EstimatesErrors>(name: &str) {
        let mut left_domain = false;
        let method = adaptive::<A>().initial_step(0.95).max_step(0.95).rtol(1e-7).atol(1e-10);
        let (outcome, _) = run(&method, 0.95, |t, y| {
            let outside = (y[0] - (1.0 - t).powi(2)).abs() > 1e-3;
            left_domain |= outside;
            [if outside { f64::NAN } else { -2.0 * y[0].sqrt() }, 0.0]
        });
        let solution = outcome.unwrap();
        assert!(left_domain && solution.statistics.rejected > 0, "{name}: {:?}", solution.statistics);
        assert!((solution.y[0] - 0.0025).abs() < 1e-6, "{name}: {:?}", solution.y);
    }
    every_adaptive!(check);
}

/// ẏ = y² has a pole at t = 1.
#[test]
fn a_singularity_stops_the_steps_with_bounded_work() {
    fn check<A: EstimatesErrors>(name: &str) {
        let (outcome, calls) = run(&adaptive::<A>().rtol(1e-8), 2.0, |_, y| [y[0] * y[0], 0.0]);
        println!("{name}: {outcome:?} after {calls} evaluations");
        let Err(StepTooSmall { t, step } | NotConverged { t, step }) = outcome else { panic!("{name}: {outcome:?}") };
        // Where the error grows without bound, the pole is where the errors of all steps have moved it.
        let moved = if ["Ode15s", "Bdf"].contains(&name) { 1e-4 } else { 1e-6 };
        assert!((t - 1.0).abs() < moved && step < 1e-14, "{name}: {outcome:?}");
        let most = if name == "Radau5" { 10_000 } else { 5000 };
        assert!(calls < most, "{name}: {calls}");
    }
    every_adaptive!(check);
}

#[test]
fn a_jump_is_crossed_or_reported_but_never_waited_at() {
    fn jump(height: f64) -> impl FnMut(f64, &[f64; 2]) -> [f64; 2] {
        move |t, _| [if t < 0.3 { 0.0 } else { height }, 0.0]
    }
    fn check<A: EstimatesErrors>(name: &str) {
        let (outcome, calls) = run(&adaptive::<A>(), 1.0, jump(1.0));
        // No estimate holds across a jump.
        let y = outcome.unwrap().y;
        assert!((y[0] - 1.7).abs() < 2e-2 && calls < 500, "{name}: {y:?} after {calls}");
        let (outcome, calls) = run(&adaptive::<A>().rtol(1e-13).atol(1e-13), 1.0, jump(1e9));
        let reported = matches!(outcome, Err(StepTooSmall { t, .. }) if (t - 0.3).abs() < 1e-14);
        assert!(reported && calls < 1000, "{name}: {outcome:?} after {calls}");
    }
    every_adaptive!(check);
}

#[test]
fn a_step_below_the_spacing_of_times_is_refused() {
    fn check<A: Algorithm>(name: &str) {
        let method = fixed::<A>(1e-3).max_steps(u64::MAX);
        let outcome = method.integrate(&mut equation(still), (1e15, 1e15 + 10.0), [0.0; 2]);
        assert_eq!(outcome, Err(StepTooSmall { t: 1e15, step: 1e-3 }), "{name}");
    }
    every_fixed!(check);
}

#[test]
fn a_state_that_overflows_is_reported() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        let (outcome, calls) = run(method, 10.0, |_, y| [y[0], 1e308]);
        // The complex matrices of Radau IIA mix components that overflow with the others.
        let is_named = |component| component == 1 || name.starts_with("Radau");
        let reported = matches!(outcome, Err(NonFiniteState { component, .. }) if is_named(component));
        assert!(reported && calls < 1000, "{name}: {outcome:?} after {calls}");
    }
    every_method!(check, 0.5);
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

/// ẏ = 1, with a function that corrects the ends of steps.
struct Corrected(fn(f64, &mut [f64; 2]) -> Accepted);

impl Ode<f64, [f64; 2]> for Corrected {
    fn derivative(&mut self, _t: f64, _y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [1.0, 1.0];
    }

    fn accepted(&mut self, t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
        (self.0)(t, y)
    }

    fn coordinate_rates(&mut self, _t: f64, _y: &[f64; 2], rates: &mut [f64; 2]) -> usize {
        rates[0] = 1.0;
        1
    }
}

#[test]
fn an_end_that_is_refused_or_corrected_to_no_number_is_reported() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        let mut refused =
            Corrected(|t: f64, _: &mut [f64; 2]| if t < 1.0 { Accepted::Unchanged } else { Accepted::Refused });
        let outcome = method.integrate(&mut refused, (0.0, 2.0), [0.0; 2]);
        assert!(matches!(outcome, Err(Refused { t }) if (1.0..=2.0).contains(&t)), "{name}: {outcome:?}");
        // Only where an event ends the integration within a step.
        let mut lost = Corrected(|t: f64, y: &mut [f64; 2]| {
            if (t - 0.55).abs() < 1e-9 {
                y[1] = f64::NAN;
            }
            Accepted::Corrected
        });
        let events = &mut [Event::rising(&|_, y: &[f64; 2]| y[0] - 0.55)];
        let outcome =
            method.solve_with_events(&mut lost, (0.0, 1.0), [0.0; 2], events, |_| Continue(()), |_| Break(()));
        let reported = matches!(outcome, Err(NonFiniteState { t, component: 1 }) if (t - 0.55).abs() < 1e-9);
        assert!(reported, "{name}: {outcome:?}");
    }
    every_method!(check, 0.1);
}

#[test]
fn an_observer_ends_the_integration_after_the_step_that_it_was_shown() {
    fn check(name: &str, method: &impl Integrator<f64>) {
        let mut shown = Vec::new();
        let mut growth = equation(|_, y| [y[1], y[0]]);
        let solution = method.each_step_until(&mut growth, (0.0, 1.0), [1.0, 1.0], |step| {
            shown.push((step.end().0, *step.end().1));
            if shown.len() == 3 { Break(()) } else { Continue(()) }
        });
        let Solution { t, y, statistics } = solution.unwrap();
        assert_eq!((shown.len(), shown[2]), (3, (t, y)), "{name}");
        assert!(t < 1.0 && statistics.steps == 3, "{name}: {statistics:?} at {t}");
    }
    every_method!(check, 0.1);
}

#[test]
fn steps_are_counted_before_they_become_too_many() {
    fn check_adaptive<A: EstimatesErrors>(name: &str) {
        let (outcome, calls) = run(&adaptive::<A>().max_steps(50), 1e3, |t, y| [y[1], -y[0] + t.sin()]);
        let reported = matches!(outcome, Err(TooManySteps { limit: 50, t }) if t > 0.0 && t < 1e3);
        let most = if name == "Dop853" { 1000 } else { 400 };
        assert!(reported && calls < most, "{name}: {outcome:?} after {calls}");
    }
    fn check_fixed<A: Algorithm>(name: &str) {
        let (outcome, _) = run(&fixed::<A>(1e-300), 1.0, never);
        assert_eq!(outcome, Err(TooManySteps { t: 0.0, limit: 1_000_000_000 }), "{name}");
        assert!(run(&fixed::<A>(0.1).max_steps(10), 1.0, still).0.is_ok(), "{name}");
        let (outcome, _) = run(&fixed::<A>(0.1).max_steps(9), 1.0, never);
        assert_eq!(outcome, Err(TooManySteps { t: 0.0, limit: 9 }), "{name}");
    }
    every_adaptive!(check_adaptive);
    every_fixed!(check_fixed);
    let (outcome, calls) = run(&Ode45::new().max_steps(50), 1e3, |_, y| [-1e3 * y[0], 0.0]);
    assert!(matches!(outcome, Err(TooManySteps { limit: 50, t }) if t > 0.0 && t < 1e3), "{outcome:?}");
    assert_eq!(calls, 301, "six for each step and one at the start");
}

#[test]
fn messages_name_the_rule_the_value_and_the_way_out() {
    let cases: [(IntegrationError<f64>, &[&str]); 19] = [
        (InvalidInterval { from: 1.0, to: 1.5 }, &["interval", "1.0", "1.5", "length"]),
        (InvalidRelativeTolerance { value: 1e-17, smallest: 2e-14 }, &["relative", "1e-17", "2e-14", "larger"]),
        (InvalidAbsoluteTolerance { component: None, value: -1.0 }, &["absolute", "-1.0", "positive"]),
        (InvalidAbsoluteTolerance { component: Some(3), value: 0.0 }, &["absolute", "component 3", "0.0"]),
        (WrongToleranceCount { given: 3, needed: 13 }, &["13 components", "3 absolute tolerances"]),
        (InvalidStep { option: "maximum step", value: -0.1 }, &["maximum step", "-0.1", "positive"]),
        (SaveTimeOutside { t: 2.0, from: 0.0, to: 1.0 }, &["t = 2.0", "0.0 to 1.0", "interval"]),
        (SaveTimesOutOfOrder { t: 2.0, previous: 3.0 }, &["t = 2.0", "3.0", "sort"]),
        (NonFiniteState { t: 0.5, component: 4 }, &["component 4", "state", "t = 0.5", "start"]),
        (NonFiniteDerivative { t: 0.5, component: 4 }, &["component 4", "derivative", "t = 0.5"]),
        (NoCoordinates, &["0 coordinates", "coordinate_rates", "Ode4"]),
        (NoEigenvalues { t: 0.5 }, &["eigenvalues", "t = 0.5", "another state"]),
        (NonFiniteEvent { t: 0.5, event: 2 }, &["event 2", "t = 0.5", "finite"]),
        (Refused { t: 0.5 }, &["refused", "t = 0.5", "last_error"]),
        (NotConverged { t: 0.5, step: 1e-3 }, &["t = 0.5", "0.001", "iteration", "tangent", "smaller"]),
        (StepTooSmall { t: 0.5, step: 1e-16 }, &["t = 0.5", "1e-16", "singularity"]),
        (Stiff { t: 0.5, step: 1e-3, remaining: 12345 }, &["stiff", "t = 0.5", "0.001", "12345", "Radau5"]),
        (Chattering { t: 0.5, events: 101 }, &["t = 0.5", "101 times", "smaller steps", "tolerances"]),
        (TooManySteps { t: 0.5, limit: 7 }, &["t = 0.5", "7 steps", "max_steps", "jumps"]),
    ];
    for (error, words) in cases {
        let message = (&error as &dyn std::error::Error).to_string();
        for word in words {
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
    }
}
