//! Events: every crossing once, in order, and when it happens.

use redysim_runtime::Real;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::ControlFlow::{self, Break, Continue};

use crate::mechanisms::{GRAVITY, Pendulum};
use redysim_runtime::integrate::Direction;
use redysim_runtime::{
    Dop8, Dop853, Event, ForwardSimulation, Gauss4, Gauss6, IntegrationError, Integrator, Occurrence, Ode, Ode4, Ode5,
    Ode45, Radau5, SemiImplicitEuler, Solution, Step, ZeroTorque,
};

/// When, and whether upward.
type Passages = Vec<(f64, bool)>;
type Value<'e, const N: usize> = &'e dyn Fn(f64, &[f64; N]) -> f64;

const PENDULUM: Pendulum = Pendulum { mass: 2.0, length: 0.5 };
const AMPLITUDE: f64 = 1.2;
const LEVEL: f64 = 0.4;

/// ∫ dφ / √(1 − k² sin² φ) from φ to π/2 by the trapezoidal rule of Romberg.
fn elliptic(k: f64, from: f64) -> f64 {
    let f = |phi: f64| 1.0 / (1.0 - (k * phi.sin()).powi(2)).sqrt();
    let length = FRAC_PI_2 - from;
    let mut row = vec![0.5 * length * (f(from) + f(FRAC_PI_2))];
    for level in 1..=12 {
        let parts = 1 << level;
        let h = length / f64::from(parts);
        let odd: f64 = (1..parts).step_by(2).map(|i| f(from + h * f64::from(i))).sum();
        let mut next = vec![0.5 * row[0] + h * odd];
        for (j, coarse) in (1..).zip(&row) {
            let fine = next[next.len() - 1];
            next.push(fine + (fine - coarse) / (4.0_f64.powi(j) - 1.0));
        }
        row = next;
    }
    row[row.len() - 1]
}

/// When a pendulum released from `AMPLITUDE` at rest passes `LEVEL`, until `end`: down and up in turn.
fn passages(end: f64) -> Passages {
    let k = (AMPLITUDE / 2.0).sin();
    let omega = (GRAVITY / PENDULUM.length).sqrt();
    let first = elliptic(k, ((LEVEL / 2.0).sin() / k).asin()) / omega;
    let period = PENDULUM.period(AMPLITUDE);
    let mut passages = vec![];
    for turn in 0.. {
        let base = f64::from(turn) * period;
        if base > end {
            return passages.into_iter().filter(|&(t, _)| t < end).collect();
        }
        passages.extend([(base + first, false), (base + period - first, true)]);
    }
    unreachable!()
}

fn swing(method: &impl Integrator<f64>, to: f64) -> (Passages, Solution<f64, [f64; 3]>) {
    let mut simulation = ForwardSimulation::new(&PENDULUM, ZeroTorque);
    let start = simulation.state(&[AMPLITUDE], &[0.0]);
    let mut found = vec![];
    let note = |o: Occurrence<'_, f64, [f64; 3]>| {
        let passed = if o.direction == Direction::Rising { o.y[0] - LEVEL } else { LEVEL - o.y[0] };
        assert!((0.0..1e-13).contains(&passed), "{o:?} {passed:e}");
        found.push((o.t, o.direction == Direction::Rising));
        Continue(())
    };
    let events = &mut [Event::any(&|_, y: &[f64; 3]| y[0] - LEVEL)];
    let end = method.solve_with_events(&mut simulation, (0.0, to), start, events, |_| Continue(()), note).unwrap();
    (found, end)
}

/// The largest error of the times, if all passages are found.
fn worst(method: &impl Integrator<f64>) -> f64 {
    let (found, _) = swing(method, 10.0);
    let expected = passages(10.0);
    assert_eq!(found.len(), expected.len(), "{found:?} instead of {expected:?}");
    assert!(found.iter().zip(&expected).all(|(f, e)| f.1 == e.1));
    found.iter().zip(&expected).map(|(f, e)| (f.0 - e.0).abs()).fold(0.0, Real::maximum)
}

#[test]
fn all_passages_of_a_pendulum_are_found_at_every_tolerance_as_exact_as_the_steps() {
    assert_eq!(passages(10.0).len(), 13);
    for k in 3..=12 {
        let tolerance = 10.0_f64.powi(-k);
        let five = worst(&Ode45::new().rtol(tolerance).atol(tolerance * 1e-2));
        let eight = worst(&Dop853::new().rtol(tolerance).atol(tolerance * 1e-2));
        println!("{tolerance:e}: Ode45 {five:e}, Dop853 {eight:e}");
        if k >= 10 {
            assert!(five < 1e-9 && eight < 1e-9);
        }
    }
    for h in [0.1, 0.05, 0.01, 0.002] {
        println!(
            "{h}: Ode5 {:e}, Ode4 {:e}, Dop8 {:e}",
            worst(&Ode5::new(h)),
            worst(&Ode4::new(h)),
            worst(&Dop8::new(h))
        );
    }
    assert!(worst(&Ode5::new(0.002)) < 1e-9);
    worst(&SemiImplicitEuler::new(0.001));
}

/// With which power of the step the error of an event's time shrinks, and the most evaluations that one took: from the
/// true state at the start of one coarse step.
fn power_of_times<M: Integrator<f64>>(method: impl Fn(f64) -> M) -> (f64, u64) {
    let mut evaluations = 0;
    let [coarse, fine] = [0.8, 0.4].map(|h: f64| {
        let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
        let level = (0.6 * h).sin();
        let value = move |_: f64, y: &[f64; 2]| y[0] - level;
        let events = &mut [Event::rising(&value)];
        let method = method(h);
        let end = method
            .solve_with_events(&mut oscillator, (0.0, h), [0.0, 1.0], events, |_| Continue(()), |_| Break(()))
            .unwrap();
        evaluations = evaluations.max(end.statistics.evaluations);
        (end.t - 0.6 * h).abs()
    });
    println!("errors of the time {coarse:.1e}, {fine:.1e}, {evaluations} evaluations");
    ((coarse / fine).log2(), evaluations)
}

/// Steps of order p err with the power p + 1; the extension of `Ode5` is of order 4.
#[test]
fn times_converge_as_the_steps_do_and_not_as_the_extension_does() {
    let (power, evaluations) = power_of_times(Ode5::new);
    assert!(power > 5.7, "{power}");
    assert!(evaluations <= 6 * 6 + 7);
    let (power, _) = power_of_times(Gauss4::new);
    assert!(power > 4.7, "{power}");
    let (power, _) = power_of_times(Gauss6::new);
    assert!(power > 6.5, "{power}");
    let (power, _) = power_of_times(|h| Radau5::new().rtol(1e-9).atol(1e-2).initial_step(h).max_step(h));
    assert!(power > 5.6, "{power}");
}

/// Newton's rule knows nothing of a function that jumps: its time stays that of the extension.
#[test]
fn a_jump_of_the_function_is_found_as_exactly_as_the_extension_is() {
    let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
    let mut times = vec![];
    let note = |o: Occurrence<'_, f64, [f64; 2]>| -> ControlFlow<()> {
        times.push(o.t);
        Continue(())
    };
    let events = &mut [Event::falling(&|_, y: &[f64; 2]| if y[0] > 0.3 { 1.0 } else { -1.0 })];
    let method = Ode45::new().rtol(1e-10).atol(1e-10);
    method.solve_with_events(&mut oscillator, (0.0, 20.0), [1.0, 0.0], events, |_| Continue(()), note).unwrap();
    assert_eq!(times.len(), 3);
    for (turn, t) in (0..).zip(times) {
        let exact = 0.3_f64.acos() + TAU * f64::from(turn);
        assert!((t - exact).abs() < 1e-8, "{:e}", t - exact);
    }
}

#[test]
fn events_cost_a_few_steps_each_and_change_no_step() {
    for tolerance in [1e-3, 1e-6, 1e-9, 1e-12] {
        let method = Ode45::new().rtol(tolerance).atol(tolerance);
        let mut simulation = ForwardSimulation::new(&PENDULUM, ZeroTorque);
        let start = simulation.state(&[AMPLITUDE], &[0.0]);
        let plain = method.integrate(&mut simulation, (0.0, 10.0), start).unwrap();
        let (found, watched) = swing(&method, 10.0);
        assert_eq!((plain.y, plain.statistics.steps), (watched.y, watched.statistics.steps));
        let extra = watched.statistics.evaluations - plain.statistics.evaluations;
        println!("{tolerance:e}: {:.1} steps for each event", extra as f64 / 6.0 / found.len() as f64);
        assert!(extra <= 6 * 4 * found.len() as u64);
    }
}

fn clock(_t: f64, _y: &[f64; 1], dydt: &mut [f64; 1]) {
    dydt[0] = 1.0;
}

/// What is found between two times of a clock that shows y = t.
fn found(
    method: &impl Integrator<f64>,
    interval: (f64, f64),
    events: &[(Direction, Value<'_, 1>)],
) -> Vec<(usize, f64)> {
    let mut found = vec![];
    let mut watched: Vec<_> = events.iter().map(|&(direction, value)| Event::new(direction, value)).collect();
    let note = |o: Occurrence<'_, f64, [f64; 1]>| {
        found.push((o.event, o.t));
        Continue(())
    };
    method.solve_with_events(&mut clock, interval, [interval.0], &mut watched, |_| Continue(()), note).unwrap();
    found
}

fn assert_found(found: &[(usize, f64)], expected: &[(usize, f64)]) {
    assert_eq!(found.len(), expected.len(), "{found:?} instead of {expected:?}");
    for (f, e) in found.iter().zip(expected) {
        assert!(f.0 == e.0 && (f.1 - e.1).abs() < 1e-13, "{found:?} instead of {expected:?}");
    }
}

#[test]
fn each_direction_is_that_of_the_integration() {
    let method = Ode45::new();
    for (interval, sign) in [((0.0, 10.0), 1.0), ((-0.0, -10.0), -1.0)] {
        let sine: Value<'_, 1> = &|_, y| (y[0].abs() + 0.5).sin();
        let zeros: Vec<f64> = (1..=3).map(|k| sign * (f64::from(k) * PI - 0.5)).collect();
        assert_found(&found(&method, interval, &[(Direction::Falling, sine)]), &[(0, zeros[0]), (0, zeros[2])]);
        assert_found(&found(&method, interval, &[(Direction::Rising, sine)]), &[(0, zeros[1])]);
        let all: Vec<_> = zeros.iter().map(|&t| (0, t)).collect();
        assert_found(&found(&method, interval, &[(Direction::Any, sine)]), &all);
    }
}

#[test]
fn crossings_of_several_events_in_one_step_come_in_order() {
    let at = [0.31, 0.17, 0.93, 0.32, 0.1701];
    let values = at.map(|at| move |_: f64, y: &[f64; 1]| y[0] - at);
    let events: Vec<(Direction, Value<'_, 1>)> = values.iter().map(|v| (Direction::Any, v as Value<'_, 1>)).collect();
    let expected = [(1, 0.17), (4, 0.1701), (0, 0.31), (3, 0.32), (2, 0.93)];
    assert_found(&found(&Ode5::new(1.0), (0.0, 1.0), &events), &expected);
    let values = at.map(|at| move |_: f64, y: &[f64; 1]| y[0] + at);
    let events: Vec<(Direction, Value<'_, 1>)> = values.iter().map(|v| (Direction::Any, v as Value<'_, 1>)).collect();
    let expected = expected.map(|(event, t)| (event, -t));
    assert_found(&found(&Ode5::new(1.0), (0.0, -1.0), &events), &expected);
}

#[test]
fn two_roots_in_one_step_are_found_wherever_they_are() {
    for k in 0..100 {
        for width in [0.3, 0.1, 0.01, 1e-3, 1e-4] {
            let middle = 0.001 + 0.01 * f64::from(k);
            let (a, b) = (middle - width, middle + width);
            let value = move |_: f64, y: &[f64; 1]| (y[0] - a) * (y[0] - b);
            let expected: Vec<_> = [(0, a), (0, b)].into_iter().filter(|&(_, t)| t > 0.0 && t < 1.0).collect();
            for sign in [1.0, -1.0] {
                let signed = move |t: f64, y: &[f64; 1]| sign * value(t, y);
                assert_found(&found(&Ode5::new(1.0), (0.0, 1.0), &[(Direction::Any, &signed)]), &expected);
            }
        }
    }
}

#[test]
fn a_zero_at_the_start_is_not_a_crossing_and_a_later_one_is() {
    let line: Value<'_, 1> = &|_, y| y[0];
    let bump: Value<'_, 1> = &|_, y| y[0] * (0.05 - y[0]);
    assert_found(&found(&Ode5::new(1.0), (0.0, 2.0), &[(Direction::Any, line)]), &[]);
    assert_found(&found(&Ode5::new(1.0), (0.0, 2.0), &[(Direction::Any, bump)]), &[(0, 0.05)]);
}

/// The clock strikes exactly at the ends of its steps.
#[test]
fn a_zero_at_the_end_of_a_step_is_reported_once() {
    let line: Value<'_, 1> = &|t, _| t - 1.0;
    for direction in [Direction::Any, Direction::Rising] {
        assert_eq!(found(&Ode5::new(0.25), (0.0, 2.0), &[(direction, line)]), [(0, 1.0)]);
        assert_eq!(found(&Ode5::new(0.25), (0.0, 1.0), &[(direction, line)]), [(0, 1.0)]);
    }
    assert_eq!(found(&Ode5::new(0.25), (0.0, 2.0), &[(Direction::Falling, line)]), []);
}

#[test]
fn what_only_comes_near_zero_is_not_reported() {
    for above in [1e-1, 1e-3, 1e-9] {
        let value = move |_: f64, y: &[f64; 1]| (y[0] - 0.37).powi(2) + above;
        assert_found(&found(&Ode5::new(1.0), (0.0, 1.0), &[(Direction::Any, &value)]), &[]);
    }
}

/// A ball that bounces: each flight starts where the last one ended, with a zero at the start.
#[test]
fn a_stop_ends_the_solution_at_the_event_and_a_new_start_goes_on_from_there() {
    let mut fall = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -9.81];
    let (mut t, mut y) = (0.0, [1.0, 0.0]);
    let mut expected = (2.0_f64 / 9.81).sqrt();
    for bounce in 0..8 {
        let mut last = (f64::NAN, [f64::NAN; 2]);
        let look = |step: &Step<'_, f64, [f64; 2]>| {
            last = (step.end().0, *step.end().1);
            assert_eq!(step.at(step.end().0), *step.end().1);
            let middle = 0.5 * (step.start().0 + step.end().0);
            assert!(step.at(middle)[0] > 0.0);
            Continue(())
        };
        let events = &mut [Event::falling(&|_, y: &[f64; 2]| y[0])];
        let end = Ode45::new().solve_with_events(&mut fall, (t, t + 5.0), y, events, look, |_| Break(())).unwrap();
        assert!((end.t - expected).abs() < 1e-12, "bounce {bounce}: {} instead of {expected}", end.t);
        assert_eq!(last, (end.t, end.y));
        assert!(end.y[0] <= 0.0 && end.y[0] > -1e-14, "{:?}", end.y);
        (t, y) = (end.t, [end.y[0], -0.7 * end.y[1]]);
        expected += 2.0 * y[1] / 9.81;
    }
}

#[test]
fn break_on_a_step_ends_after_that_step_and_events_before_it_are_reported() {
    let line: Value<'_, 1> = &|_, y| y[0] - 0.3;
    let mut told = 0;
    let note = |_: Occurrence<'_, f64, [f64; 1]>| {
        told += 1;
        Continue(())
    };
    let events = &mut [Event::any(line)];
    let end = Ode5::new(0.5).solve_with_events(&mut clock, (0.0, 5.0), [0.0], events, |_| Break(()), note).unwrap();
    assert_eq!((end.t, told), (0.5, 1));
}

#[test]
fn an_event_that_is_not_a_number_is_named() {
    let (fine, root): (Value<'_, 1>, Value<'_, 1>) = (&|_, _| 1.0, &|_, y| (0.7 - y[0]).sqrt());
    let events = &mut [Event::any(fine), Event::any(root)];
    let outcome =
        Ode5::new(0.5).solve_with_events(&mut clock, (0.0, 5.0), [0.0], events, |_| Continue(()), |_| Continue(()));
    assert!(
        matches!(outcome, Err(IntegrationError::NonFiniteEvent { t, event: 1 }) if t > 0.7 && t < 0.8),
        "{outcome:?}"
    );
    let message = outcome.unwrap_err().to_string();
    assert!(message.contains("event 1") && message.contains("t = 0.7"), "{message}");
}

/// An equation that keeps its radius 1 by correcting its steps.
struct Circle(u32);

impl Ode<f64, [f64; 2]> for Circle {
    fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [y[1], -y[0]];
    }

    fn accepted(&mut self, _t: f64, _step: f64, y: &mut [f64; 2]) -> redysim_runtime::integrate::Accepted {
        self.0 += 1;
        let radius = y[0].hypot(y[1]);
        *y = y.map(|y| y / radius);
        redysim_runtime::integrate::Accepted::Corrected
    }
}

#[test]
fn the_state_at_a_stop_is_corrected_like_the_end_of_a_step() {
    let events = &mut [Event::rising(&|_, y: &[f64; 2]| y[0] - 0.5)];
    let go_on = |_: &Step<'_, f64, [f64; 2]>| Continue::<()>(());
    let mut circle = Circle(0);
    let end =
        Ode45::new().solve_with_events(&mut circle, (0.0, 5.0), [0.0, 1.0], events, go_on, |_| Break(())).unwrap();
    assert!((end.y[0].hypot(end.y[1]) - 1.0).abs() < 1e-15);
    assert!((end.t - TAU / 12.0).abs() < 1e-3);
    assert_eq!(u64::from(circle.0), end.statistics.steps + 1);
}

/// Events need no array and no allocation of their own: also with a state whose length is known at run time.
#[cfg(feature = "alloc")]
#[test]
fn a_state_of_any_length_can_be_watched() {
    let mut turn = |_t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>| {
        dydt[0] = y[1];
        dydt[1] = -y[0];
    };
    let mut times = vec![];
    let note = |o: Occurrence<'_, f64, Vec<f64>>| -> ControlFlow<()> {
        times.push(o.t);
        Continue(())
    };
    let events = &mut [Event::any(&|_, y: &Vec<f64>| y[0])];
    let method = Dop853::new().rtol(1e-11).atol(1e-13);
    method.solve_with_events(&mut turn, (0.0, 10.0), vec![1.0, 0.0], events, |_| Continue(()), note).unwrap();
    assert_eq!(times.len(), 3);
    for (k, t) in times.iter().enumerate() {
        assert!((t - (k as f64 + 0.5) * PI).abs() < 1e-10, "{times:?}");
    }
}
