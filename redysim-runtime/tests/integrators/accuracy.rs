//! Measured orders and accuracy, on problems with known solutions.

use crate::problems::{error_at, exact, nonlinear, order};
use redysim_runtime::Real;
use redysim_runtime::{Integrator, Ode4, Ode5, Ode45, Step};

fn end_error_of_ode5(h: f64) -> f64 {
    let end = Ode5::new(h).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    error_at(end.t, &end.y)
}

/// The largest error between the ends of steps.
fn dense_error_of_ode5(h: f64) -> f64 {
    let mut largest: f64 = 0.0;
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        for theta in [0.2, 0.4, 0.6, 0.8] {
            let t = step.start().0 + theta * h;
            largest = Real::maximum(largest, error_at(t, &step.at(t)));
        }
    };
    Ode5::new(h).each_step(&mut nonlinear, (0.0, 3.0), exact(0.0), look).unwrap();
    largest
}

#[test]
fn ode5_converges_with_order_five() {
    let p = order((0.05, end_error_of_ode5(0.05)), (0.025, end_error_of_ode5(0.025)));
    println!("measured order {p:.3}");
    assert!((p - 5.0).abs() < 0.2, "{p}");
}

#[test]
fn ode4_converges_with_order_four_at_the_ends_of_its_steps_and_within() {
    let errors = |h: f64| {
        let mut within: f64 = 0.0;
        let look = |step: &Step<'_, f64, [f64; 2]>| {
            let t = step.start().0 + 0.4 * h;
            within = within.max(error_at(t, &step.at(t)));
        };
        let end = Ode4::new(h).each_step(&mut nonlinear, (0.0, 3.0), exact(0.0), look).unwrap();
        (error_at(end.t, &end.y), within)
    };
    let (coarse, fine) = (errors(0.02), errors(0.01));
    let [ends, within] = [order((0.02, coarse.0), (0.01, fine.0)), order((0.02, coarse.1), (0.01, fine.1))];
    println!("measured orders {ends:.3}, {within:.3}");
    // Over one step a cubic extension errs with h⁴, as the steps before it do.
    assert!((ends - 4.0).abs() < 0.2 && (within - 4.0).abs() < 0.2, "{ends}, {within}");
}

/// The extension is of order 4: its error over one step shrinks with h⁵. Errors of the steps before do so too, so the
/// measure is 5.
#[test]
fn the_error_of_ode5_within_its_steps_shrinks_with_the_fifth_power_of_the_step() {
    let p = order((0.05, dense_error_of_ode5(0.05)), (0.025, dense_error_of_ode5(0.025)));
    println!("measured power {p:.3}");
    assert!((p - 5.0).abs() < 0.2, "{p}");
}

/// With error proportional to tolerance and to h⁵, the number of steps grows with the tolerance to the power −1/5.
#[test]
fn ode45_ends_within_ten_tolerances_with_work_of_order_five() {
    let measure = |tolerance: f64| {
        let method = Ode45::new().rtol(tolerance).atol(tolerance).max_step(3.0);
        let end = method.integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
        (end.statistics.evaluations as f64, error_at(end.t, &end.y))
    };
    for tolerance in [1e-5, 1e-7, 1e-9, 1e-11] {
        let (evaluations, error) = measure(tolerance);
        println!("tolerance {tolerance:e}: error {error:e}, {evaluations} evaluations");
        assert!(error < 10.0 * tolerance, "error {error:e} for tolerance {tolerance:e}");
    }
    let p = (measure(1e-12).0 / measure(1e-8).0).ln() / -(1e-12_f64 / 1e-8).ln();
    println!("work grows with the power −1/{:.3}", 1.0 / p);
    assert!((1.0 / p - 5.0).abs() < 0.2, "{}", 1.0 / p);
}

#[test]
fn the_error_per_step_of_ode45_is_within_the_tolerance() {
    let mut worst: f64 = 0.0;
    let (rtol, atol) = (1e-6, 1e-8);
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        // From the step's own start: what this step alone has done wrong.
        let ((t0, y0), (t1, y1)) = (step.start(), step.end());
        let true_end = Ode5::new(1e-3).integrate(&mut nonlinear, (t0, t1), *y0).unwrap().y;
        for i in 0..2 {
            worst = Real::maximum(worst, (y1[i] - true_end[i]).abs() / f64::max(rtol * y1[i].abs(), atol));
        }
    };
    Ode45::new().rtol(rtol).atol(atol).each_step(&mut nonlinear, (0.0, 3.0), exact(0.0), look).unwrap();
    println!("worst local error in units of the tolerance: {worst}");
    assert!(worst < 1.0);
}

#[test]
fn integration_backward_in_time_returns_to_the_start() {
    let forward = Ode45::new().rtol(1e-11).atol(1e-11).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    let back = Ode45::new().rtol(1e-11).atol(1e-11).integrate(&mut nonlinear, (3.0, 0.0), forward.y).unwrap();
    assert_eq!(back.t, 0.0);
    assert!(error_at(0.0, &back.y) < 1e-9, "{:?}", back.y);

    let forward = Ode5::new(0.01).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    let back = Ode5::new(0.01).integrate(&mut nonlinear, (3.0, 0.0), forward.y).unwrap();
    assert_eq!(back.t, 0.0);
    assert!(error_at(0.0, &back.y) < 1e-9, "{:?}", back.y);
}

/// An error that is made on the way grows by at most 1 + tan² 1 = 3.4. The start is rounded by one roundoff unit, and
/// derivatives by about two; the state moves up and down by 3 in all: 3.4 (1 + 2 · 3) = 24 units. Steps from tolerances
/// add the error that they have without roundings, in `f64`.
#[test]
fn single_precision_ends_within_25_roundoff_units_of_the_error_in_double_precision() {
    let from = exact(0.0).map(|y| y as f32);
    let fixed = Ode5::new(0.02_f32).integrate(&mut nonlinear, (0.0, 3.0), from).unwrap();
    assert!(error_at(fixed.t, &fixed.y) < 25.0 * f64::from(f32::EPSILON), "{:?}", fixed.y);
    let adaptive = Ode45::new().rtol(2e-5_f32).atol(1e-6).integrate(&mut nonlinear, (0.0, 3.0), from).unwrap();
    let double = Ode45::new().rtol(2e-5).atol(1e-6).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    let [single, double] = [error_at(adaptive.t, &adaptive.y), error_at(double.t, &double.y)];
    println!("{single:e} in single precision, {double:e} in double");
    assert!(single < double + 25.0 * f64::from(f32::EPSILON), "{:?}", adaptive.y);
}

/// Without compensated summation the first error here is 5e-15, 24 roundoff units.
#[test]
fn rounding_errors_do_not_grow_with_the_number_of_steps() {
    let mut growth = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = y[0];
    let end = Ode5::new(1e-5).integrate(&mut growth, (0.0, 1.0), [1.0]).unwrap();
    let error = (end.y[0] - std::f64::consts::E).abs() / std::f64::consts::E;
    println!("relative error after 10⁵ steps: {error:e}");
    assert!(error < 4.0 * f64::EPSILON, "{error:e}");

    let mut growth = |_t: f32, y: &[f32; 1], dydt: &mut [f32; 1]| dydt[0] = y[0];
    let end = Ode5::new(1e-4_f32).integrate(&mut growth, (0.0, 1.0), [1.0]).unwrap();
    let error = (end.y[0] - std::f32::consts::E).abs() / std::f32::consts::E;
    println!("the same for f32, 10⁴ steps: {error:e}");
    assert!(error < 4.0 * f32::EPSILON, "{error:e}");
}
