//! Which steps are taken, what they cost, and what tolerances mean.

use std::ops::ControlFlow;

use redysim_runtime::integrate::tableau::{DORMAND_PRINCE, ErrorEstimate};
use redysim_runtime::{Dop853, Integrator, Ode5, Ode15s, Ode45, Radau5, Statistics, Step};

fn decay(_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]) {
    dydt[0] = -y[0];
}

/// A fast and a slow oscillator of different size.
fn oscillators(_t: f64, y: &[f64; 4], dydt: &mut [f64; 4]) {
    *dydt = [y[1], -400.0 * y[0], y[3], -y[2]];
}

fn step_ends(method: &impl Integrator<f64>, interval: (f64, f64)) -> Vec<f64> {
    let mut ends = vec![];
    method.each_step(&mut decay, interval, [1.0], |step| ends.push(step.end().0)).unwrap();
    ends
}

#[test]
fn fixed_steps_end_at_exact_multiples_and_the_last_one_at_the_end() {
    for (interval, h, count) in [
        ((0.0, 1.0), 0.1, 10),
        ((0.0, 1.1), 0.1, 11),
        ((0.0, 0.7), 0.1, 7),
        ((0.1, 0.4), 0.1, 3),
        ((100.3, 101.4), 0.1, 11),
        ((0.0, 1.0), 0.3, 4),
        ((1.0, 0.0), 0.3, 4),
        ((-0.5, 2.0), 7.0, 1),
    ] {
        let ends = step_ends(&Ode5::new(h), interval);
        assert_eq!(ends.len(), count, "{interval:?} by {h}");
        let direction = f64::signum(interval.1 - interval.0);
        for (k, &end) in (1..count).zip(&ends) {
            assert_eq!(end, interval.0 + direction * (k as f64 * h));
        }
        assert_eq!(ends[count - 1], interval.1);
    }
}

/// A trajectory or a table of forces may end where the interval does.
#[test]
fn no_evaluation_lies_beyond_the_interval() {
    let mut rounded_beyond = 0;
    for k in 1..1000 {
        let (from, to) = (-0.001 * f64::from(k), 0.7);
        rounded_beyond += u32::from(from + (to - from) > to);
        let mut bounded = |t: f64, _y: &[f64; 1], dydt: &mut [f64; 1]| {
            assert!(from <= t && t <= to, "{t} is not between {from} and {to}");
            dydt[0] = 0.0;
        };
        Ode5::new(10.0).integrate(&mut bounded, (from, to), [0.0]).unwrap();
    }
    assert!(rounded_beyond > 0, "the sum must go wrong somewhere for this to test anything");
}

#[test]
fn times_do_not_drift_over_a_hundred_thousand_steps() {
    let mut constant = |_t: f64, _y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = 1.0;
    let mut k = 0;
    let check = |step: &Step<'_, f64, [f64; 1]>| {
        k += 1;
        assert_eq!(step.end().0, f64::from(k) * 1e-5);
    };
    let end = Ode5::new(1e-5).each_step(&mut constant, (0.0, 1.0), [0.0], check).unwrap();
    assert_eq!((end.t, end.statistics.steps), (1.0, 100_000));
}

#[test]
fn every_step_costs_six_evaluations_and_the_start_one() {
    let mut calls = 0;
    let mut counted = |_t: f64, y: &[f64; 4], dydt: &mut [f64; 4]| {
        calls += 1;
        oscillators(0.0, y, dydt);
    };
    let start = [1.0, 0.0, 1.0, 0.0];
    let end = Ode45::new().initial_step(0.5).integrate(&mut counted, (0.0, 3.0), start).unwrap();
    let Statistics { steps, rejected, evaluations, .. } = end.statistics;
    println!("{:?}", end.statistics);
    assert!(rejected > 0, "a test without rejected steps tests too little");
    assert_eq!(evaluations, 6 * (steps + rejected) + 1);
    assert_eq!(evaluations, calls);

    let end = Ode5::new(0.01).integrate(&mut oscillators, (0.0, 3.0), start).unwrap();
    assert_eq!(end.statistics, Statistics { steps: 300, evaluations: 1801, ..Statistics::default() });
}

#[test]
fn save_times_cost_no_evaluations_and_change_no_step() {
    let start = [1.0, 0.0, 1.0, 0.0];
    let plain = Ode45::new().integrate(&mut oscillators, (0.0, 3.0), start).unwrap();
    let times = (0..=1000).map(|k| 3.0 * f64::from(k) / 1000.0);
    let asked = Ode45::new().solve(&mut oscillators, (0.0, 3.0), start, times, |_, _| {}).unwrap();
    assert_eq!(plain, asked);
}

/// ẏ = 2t is integrated without error, and ẏ(0) = 0 gives no reason for a small first step: ten steps of the largest
/// size, as MATLAB's ode45 takes.
#[test]
fn without_reason_for_smaller_ones_steps_are_a_tenth_of_the_interval() {
    let mut parabola = |t: f64, _y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = 2.0 * t;
    let end = Ode45::new().integrate(&mut parabola, (0.0, 5.0), [0.0]).unwrap();
    assert_eq!(end.statistics, Statistics { steps: 10, evaluations: 61, ..Statistics::default() });
    assert!((end.y[0] - 25.0).abs() < 1e-14);
    let end = Ode45::new().max_step(0.1).integrate(&mut parabola, (0.0, 5.0), [0.0]).unwrap();
    assert_eq!(end.statistics.steps, 50);
}

/// A step z of ẏ = y from 1, from the coefficients alone: the new state and the estimated error.
fn linear_step(z: f64) -> (f64, f64) {
    let mut states = vec![];
    for row in DORMAND_PRINCE.rows {
        states.push(1.0 + z * dot(row, &states));
    }
    let ErrorEstimate::Embedded(error) = DORMAND_PRINCE.error else { panic!("one embedded formula") };
    (states[6], z * dot(&error, &states))
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What MATLAB's rules make of ẏ = −y from `y` at t = 0: the ends of the steps and the number of rejected ones.
fn steps_by_the_rules(rtol: f64, atol: f64, mut y: f64, largest: f64, initial: Option<f64>) -> (Vec<f64>, u64) {
    let threshold = atol / rtol;
    let rate = y / y.max(threshold) / (0.8 * rtol.powf(0.2));
    let (mut t, mut rejected, mut ends) = (0.0, 0, vec![]);
    let mut size = initial.unwrap_or(if largest * rate > 1.0 { 1.0 / rate } else { largest });
    while t < END {
        size = size.min(largest);
        let mut failures = 0;
        loop {
            if 1.1 * size >= END - t {
                size = END - t;
            }
            let (growth, estimate) = linear_step(-size);
            let error = (estimate * y).abs() / y.max((growth * y).abs()).max(threshold);
            if error <= rtol {
                t = if size == END - t { END } else { t + size };
                y *= growth;
                ends.push(t);
                let slowdown = 1.25 * (error / rtol).powf(0.2);
                if failures == 0 {
                    size = if slowdown > 0.2 { size / slowdown } else { 5.0 * size };
                }
                break;
            }
            size *= if failures == 0 { f64::max(0.1, 0.8 * (rtol / error).powf(0.2)) } else { 0.5 };
            failures += 1;
            rejected += 1;
        }
    }
    (ends, rejected)
}

const END: f64 = 40.0;

#[test]
fn ode45_takes_the_steps_of_matlab() {
    let mut most_rejected = 0;
    for (rtol, atol, start, initial) in [
        (1e-3, 1e-6, 1.0, None),
        (1e-7, 1e-6, 1.0, None),
        (1e-4, 1e-2, 0.5, None),
        (1e-5, 1e-9, 1.0, Some(3.0)),
        (1e-9, 1e-9, 1.0, Some(39.0)),
        (1e-3, 1e-6, 1.0, Some(1e-7)),
    ] {
        let mut method = Ode45::new().rtol(rtol).atol(atol).max_step(END);
        if let Some(size) = initial {
            method = method.initial_step(size);
        }
        let mut ends = vec![];
        let end = method.each_step(&mut decay, (0.0, END), [start], |step| ends.push(step.end().0)).unwrap();
        let (expected, rejected) = steps_by_the_rules(rtol, atol, start, END, initial);
        println!("{} steps, {rejected} rejected", expected.len());
        assert_eq!((ends.len(), end.statistics.rejected), (expected.len(), rejected));
        for (end, expected) in ends.iter().zip(&expected) {
            assert!((end / expected - 1.0).abs() < 1e-6, "{end} instead of {expected}");
        }
        most_rejected = rejected.max(most_rejected);
    }
    assert!(most_rejected > 2);
}

#[test]
fn no_step_exceeds_the_largest_by_more_than_the_last_stretch() {
    let ends = step_ends(&Ode45::new().max_step(0.3).initial_step(0.3), (0.0, 2.0));
    let sizes: Vec<f64> = std::iter::once(&0.0).chain(&ends).zip(&ends).map(|(start, end)| end - start).collect();
    let (last, others) = sizes.split_last().unwrap();
    assert!(others.iter().all(|&size| size <= 0.3 + 1e-15), "{sizes:?}");
    assert!(*last <= 0.33, "{sizes:?}");
    // 1.05 is 10.5 largest steps: the last is stretched by a twentieth.
    assert_eq!(step_ends(&Ode45::new().max_step(0.1), (0.0, 1.005)).len(), 10);
}

#[test]
fn the_defaults_are_those_of_matlab() {
    let start = [1.0, 0.0, 1.0, 0.0];
    let default = Ode45::default().integrate(&mut oscillators, (0.0, 3.0), start).unwrap();
    let explicit = Ode45::new().rtol(1e-3).atol(1e-6).max_step(0.1 * 3.0);
    assert_eq!(default, explicit.integrate(&mut oscillators, (0.0, 3.0), start).unwrap());
}

#[test]
fn a_callback_can_break_after_any_step() {
    let end = Ode45::new()
        .each_step_until(&mut decay, (0.0, 5.0), [1.0], |step| {
            if step.end().1[0] < 0.5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .unwrap();
    assert!(end.y[0] < 0.5 && end.t < 1.5);
    let end = Ode5::new(0.1).each_step_until(&mut decay, (0.0, 5.0), [1.0], |_| ControlFlow::Break(())).unwrap();
    assert_eq!((end.t, end.statistics.steps), (0.1, 1));
}

/// The fast oscillator alone needs the small steps. An absolute tolerance that it does not exceed frees the slow one.
#[test]
fn each_component_has_its_own_absolute_tolerance() {
    let start = [1e-4, 0.0, 1.0, 0.0];
    let steps =
        |method: Ode45<'_, f64>| method.integrate(&mut oscillators, (0.0, 6.0), start).unwrap().statistics.steps;
    let method = Ode45::new().rtol(1e-6);
    let strict = steps(method.atol(1e-9));
    let loose_for_fast = steps(method.atol_each(&[1.0, 1.0, 1e-9, 1e-9]));
    let loose_for_slow = steps(method.atol_each(&[1e-9, 1e-9, 1.0, 1.0]));
    println!("{strict} steps; {loose_for_fast} if the fast one may err, {loose_for_slow} if the slow one may");
    assert_eq!(steps(method.atol_each(&[1e-9; 4])), strict);
    assert!(3 * loose_for_fast < strict, "{loose_for_fast} against {strict}");
    assert!(loose_for_fast > steps(method.atol(1.0)), "the slow one still counts");
    assert!(loose_for_slow > strict / 2, "{loose_for_slow} against {strict}");
}

/// Of rtol |y| and atol the larger one counts, not their sum: far above the threshold atol changes nothing, far below
/// rtol changes nothing but the threshold.
#[test]
fn the_larger_of_both_tolerances_counts() {
    let mut growth = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = y[0];
    let mut at = |rtol: f64, atol: f64, scale: f64| {
        let end = Ode45::new().rtol(rtol).atol(atol).integrate(&mut growth, (0.0, 2.0), [scale]).unwrap();
        (end.statistics.steps, end.y[0] / scale)
    };
    assert_eq!(at(1e-8, 1e-9, 1.0), at(1e-8, 1e-30, 1.0));
    // Scaling a state and its absolute tolerance together changes nothing.
    assert_eq!(at(1e-6, 1e-3, 1.0), at(1e-6, 1e-3 * 1024.0, 1024.0));
    assert!(at(1e-8, 1e-4, 1.0).0 < at(1e-8, 1e-9, 1.0).0);
}

#[test]
fn half_the_tolerance_takes_more_steps_by_the_fifth_root_of_two() {
    let steps = |rtol: f64| {
        let method = Ode45::new().rtol(rtol).atol(1e-30).max_step(10.0);
        let mut turn = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[0] * y[1].cos(), 1.0];
        method.integrate(&mut turn, (0.0, 100.0), [1.0, 0.0]).unwrap().statistics.steps as f64
    };
    let ratio = steps(0.5e-9) / steps(1e-9);
    println!("ratio {ratio}");
    assert!((ratio - 2.0_f64.powf(0.2)).abs() < 0.02, "{ratio}");
}

#[test]
fn a_short_interval_far_from_zero_is_crossed() {
    let from = 1e6;
    let to = from + 40.0 * f64::EPSILON * from;
    let end = Ode45::new().integrate(&mut decay, (from, to), [1.0]).unwrap();
    assert_eq!(end.t, to);
    assert!(end.statistics.steps <= 4);
}

#[test]
fn a_step_ends_at_each_stop_within_the_interval_in_either_direction() {
    fn with_stops(method: impl Integrator<f64>, plain: impl Integrator<f64>, stops: &[f64]) {
        for (interval, reversed) in [((0.0, 3.0), false), ((3.0, 0.0), true)] {
            let (ends, without) = (step_ends(&method, interval), step_ends(&plain, interval));
            let within = |stop: &f64| 0.0 < *stop && *stop < 3.0;
            for stop in stops.iter().filter(|stop| within(stop)) {
                assert!(ends.contains(stop), "{stop}, reversed: {reversed}: {ends:?}");
                assert!(!without.contains(stop), "without stops, no step ends at {stop}");
            }
            assert!(ends.windows(2).all(|pair| (pair[0] < pair[1]) != reversed), "{ends:?}");
            assert_eq!(*ends.last().unwrap(), interval.1);
        }
    }
    let stops = [-1.0, 0.0, 0.123, 0.125, 1.7, 3.0, 5.0];
    with_stops(Ode45::new().stops(&stops), Ode45::new(), &stops);
    with_stops(Dop853::new().stops(&stops), Dop853::new(), &stops);
    with_stops(Ode15s::new().stops(&stops), Ode15s::new(), &stops);
    with_stops(Radau5::new().stops(&stops), Radau5::new(), &stops);
}

/// A force that rises and falls within 2 ms, of 7 N s on 1 kg, in the middle of 10 s of rest.
#[test]
fn a_short_push_between_stops_gives_its_whole_impulse() {
    let mut pushed = |t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| {
        *dydt = [y[1], 7.0e3 * (1.0 - (t - 5.0).abs() / 1e-3).max(0.0)];
    };
    let stops = [4.999, 5.0, 5.001];
    let mut end = |method: Ode45<'_, f64>| method.integrate(&mut pushed, (0.0, 10.0), [0.0; 2]).unwrap().y;
    assert_eq!(end(Ode45::new()), [0.0, 0.0], "without stops, no step evaluates the push");
    let [x, v] = end(Ode45::new().stops(&stops));
    assert!((v - 7.0).abs() < 1e-3 * 7.0 && (x - 35.0).abs() < 1e-3 * 35.0, "{x} m, {v} m/s");
}
