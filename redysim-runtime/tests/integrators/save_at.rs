//! The solution at the times of `save_at` and within steps.

use redysim_runtime::{Integrator, Ode5, Ode45, Step};

fn oscillator(_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
    *dydt = [y[1], -y[0]];
}

fn solve(method: impl Integrator<f64>, interval: (f64, f64), times: &[f64]) -> Vec<(f64, [f64; 2])> {
    let mut answers = vec![];
    method
        .solve(&mut oscillator, interval, [interval.0.sin(), interval.0.cos()], times.iter().copied(), |t, y| {
            answers.push((t, *y));
        })
        .unwrap();
    answers
}

#[test]
fn every_save_time_is_answered_at_exactly_that_time() {
    let times = [0.0, 0.0, 1e-300, 0.1, 0.25, 0.25, 1.0, 1.9999, 2.0, 2.0];
    for answers in [solve(Ode5::new(0.1), (0.0, 2.0), &times), solve(Ode45::new().rtol(1e-8), (0.0, 2.0), &times)] {
        assert_eq!(answers.iter().map(|&(t, _)| t).collect::<Vec<_>>(), times);
        for (t, y) in answers {
            assert!((y[0] - t.sin()).abs() < 1e-6 && (y[1] - t.cos()).abs() < 1e-6, "{t}: {y:?}");
        }
    }
}

#[test]
fn both_ends_are_answered_with_exactly_the_start_and_the_final_state() {
    for interval in [(0.0, 2.0), (2.0, -1.0)] {
        let start = [f64::sin(interval.0), f64::cos(interval.0)];
        let answers = solve(Ode45::new(), interval, &[interval.0, interval.1]);
        let end = Ode45::new().integrate(&mut oscillator, interval, start).unwrap();
        assert_eq!(answers, [(interval.0, start), (end.t, end.y)]);
        assert_eq!(end.t, interval.1);
    }
}

#[test]
fn times_at_ends_of_steps_are_answered_with_the_states_there() {
    let mut ends = vec![];
    let record = |step: &Step<'_, f64, [f64; 2]>| ends.push((step.end().0, *step.end().1));
    Ode45::new().each_step(&mut oscillator, (0.0, 2.0), [0.0, 1.0], record).unwrap();
    let times: Vec<f64> = ends.iter().map(|&(t, _)| t).collect();
    assert_eq!(solve(Ode45::new(), (0.0, 2.0), &times), ends);
}

#[test]
fn save_times_run_backward_when_integration_does() {
    let times = [3.0, 2.5, 0.1, -1.0];
    let answers = solve(Ode45::new().rtol(1e-8).atol(1e-10), (3.0, -1.0), &times);
    assert_eq!(answers.len(), times.len());
    for (t, y) in answers {
        assert!((y[0] - t.sin()).abs() < 1e-6 && (y[1] - t.cos()).abs() < 1e-6, "{t}: {y:?}");
    }
}

#[test]
fn without_save_times_there_is_no_output() {
    assert!(solve(Ode45::new(), (0.0, 2.0), &[]).is_empty());
}

/// One-sided differences of the extension on both sides of the end of a step, against f there.
#[test]
fn the_solution_has_no_kinks_between_steps() {
    let d = 1e-4;
    let mut left: Option<[f64; 2]> = None;
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        let ((t0, y0), (t1, y1)) = (step.start(), step.end());
        // Second-order differences: their own error is about d².
        let slope = |y: &[f64; 2], one: [f64; 2], two: [f64; 2], d: f64, i: usize| {
            (4.0 * one[i] - two[i] - 3.0 * y[i]) / (2.0 * d)
        };
        for i in 0..2 {
            let right = slope(y0, step.at(t0 + d), step.at(t0 + 2.0 * d), d, i);
            if let Some(left) = left {
                assert!((left[i] - right).abs() < 1e-6, "at {t0}: {} and {right}", left[i]);
            }
        }
        left = Some(std::array::from_fn(|i| slope(y1, step.at(t1 - d), step.at(t1 - 2.0 * d), -d, i)));
    };
    Ode5::new(0.5).each_step(&mut oscillator, (0.0, 5.0), [0.0, 1.0], look).unwrap();
}

#[test]
fn a_step_writes_what_it_returns() {
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        let (t0, t1) = (step.start().0, step.end().0);
        let mut y = [f64::NAN; 2];
        for t in [t0, 0.5 * (t0 + t1), t1] {
            step.write_at(t, &mut y);
            assert_eq!(y, step.at(t));
        }
    };
    Ode45::new().each_step(&mut oscillator, (0.0, 5.0), [0.0, 1.0], look).unwrap();
}
