//! The pair of order 8: measured orders, work, and one run against another implementation.

use crate::mechanisms::Arm;
use crate::problems::{error_at, exact, nonlinear};
use redysim_runtime::Real;
use redysim_runtime::{
    Dop8, Dop853, ForwardSimulation, Integrator, MechanicalEnergy, Ode45, Statistics, Step, ZeroTorque,
};

/// Largest errors at the ends of the steps from 0 to 3, and between them.
fn errors(h: f64) -> (f64, f64) {
    let (mut ends, mut between): (f64, f64) = (0.0, 0.0);
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        ends = ends.max(error_at(step.end().0, step.end().1));
        for theta in [0.2, 0.4, 0.6, 0.8] {
            let t = step.start().0 + theta * h;
            between = between.max(error_at(t, &step.at(t)));
        }
    };
    Dop8::new(h).each_step(&mut nonlinear, (0.0, 3.0), exact(0.0), look).unwrap();
    (ends, between)
}

#[test]
fn steps_of_order_eight_converge_with_order_eight() {
    let p = (errors(0.1).0 / errors(0.05).0).log2();
    println!("measured order {p:.3}");
    assert!((p - 8.0).abs() < 0.2, "{p}");
}

/// The extension is of order 7: what it does wrong within one step shrinks with h⁸. It is seen from the true solution
/// at the start of the step, so that errors of earlier steps do not hide it.
#[test]
fn the_extension_of_order_eight_is_of_order_seven() {
    let local = |h: f64| {
        (0..40).fold(0.0_f64, |worst, k| {
            let t0 = 0.05 * f64::from(k);
            let mut at = 0.0;
            let look = |step: &Step<'_, f64, [f64; 2]>| at = error_at(t0 + 0.3 * h, &step.at(t0 + 0.3 * h));
            Dop8::new(h).each_step(&mut nonlinear, (t0, t0 + h), exact(t0), look).unwrap();
            Real::maximum(worst, at)
        })
    };
    let p = (local(0.2) / local(0.1)).log2();
    println!("error of one step within shrinks with the power {p:.3}; {:?}", errors(0.1));
    assert!((p - 8.0).abs() < 0.3, "{p}");
}

#[test]
fn the_error_is_between_a_ten_thousandth_of_the_tolerance_and_ten_tolerances() {
    let measure = |tolerance: f64| {
        let method = Dop853::new().rtol(tolerance).atol(tolerance).max_step(3.0);
        let end = method.integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
        (end.statistics.evaluations, error_at(end.t, &end.y))
    };
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10, 1e-12] {
        let (evaluations, error) = measure(tolerance);
        println!("tolerance {tolerance:e}: error {error:e}, {evaluations} evaluations");
        assert!(error < 10.0 * tolerance && error > 1e-4 * tolerance, "error {error:e} for tolerance {tolerance:e}");
    }
}

/// Over many steps, so that the first and the last do not count.
#[test]
fn the_number_of_steps_grows_with_the_eighth_root_of_the_tolerance() {
    let steps = |rtol: f64| {
        let method = Dop853::new().rtol(rtol).atol(1e-30).max_step(10.0);
        let mut turn = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[0] * y[1].cos(), 1.0];
        method.integrate(&mut turn, (0.0, 1000.0), [1.0, 0.0]).unwrap().statistics.steps as f64
    };
    let p = 1e3_f64.ln() / (steps(1e-13) / steps(1e-10)).ln();
    println!("steps grow with the power −1/{p:.3}");
    assert!((p - 8.0).abs() < 0.5, "{p}");
}

#[test]
fn at_tight_tolerances_dop853_takes_fewer_evaluations_than_ode45() {
    let work = |statistics: Statistics| statistics.evaluations;
    let order_five = |tolerance: f64| {
        let method = Ode45::new().rtol(tolerance).atol(tolerance).max_step(3.0);
        work(method.integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap().statistics)
    };
    let order_eight = |tolerance: f64| {
        let method = Dop853::new().rtol(tolerance).atol(tolerance).max_step(3.0);
        work(method.integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap().statistics)
    };
    for tolerance in [1e-6, 1e-8, 1e-10, 1e-12] {
        println!("{tolerance:e}: {} against {}", order_eight(tolerance), order_five(tolerance));
    }
    assert!(3 * order_eight(1e-10) < 2 * order_five(1e-10));
    assert!(2 * order_eight(1e-12) < order_five(1e-12));
}

/// Errors as the energy shows them, for work at the same tolerance.
#[test]
fn a_swinging_arm_takes_fewer_evaluations_for_a_smaller_error() {
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = simulation.state(&[1.0, 0.5], &[0.0, 0.0]);
    let energy = |y: &[f64; 5]| Arm.energy(&[y[0], y[1]], &[y[2], y[3]]).total();
    for (tolerance, gain) in [(1e-8, 1.2), (1e-10, 1.8), (1e-12, 2.8)] {
        let five = Ode45::new().rtol(tolerance).atol(tolerance).integrate(&mut simulation, (0.0, 10.0), start).unwrap();
        let eight =
            Dop853::new().rtol(tolerance).atol(tolerance).integrate(&mut simulation, (0.0, 10.0), start).unwrap();
        let work = [five, eight].map(|end| end.statistics.evaluations as f64);
        let error = [five, eight].map(|end| (energy(&end.y) - energy(&start)).abs());
        println!("{tolerance:e}: {work:?} evaluations, {error:?} J");
        assert!(work[0] > gain * work[1] && error[1] < error[0], "{work:?}, {error:?}");
    }
}

#[test]
fn dense_output_costs_three_evaluations_in_a_step_that_is_looked_into_and_none_elsewhere() {
    let run = |times: &[f64]| {
        let mut answers = 0;
        let times = times.iter().copied();
        let method = Dop853::new().rtol(1e-8);
        let end = method.solve(&mut nonlinear, (0.0, 3.0), exact(0.0), times, |_, _| answers += 1).unwrap();
        (end, answers)
    };
    let (plain, _) = run(&[]);
    let (ends, _) = run(&[3.0]);
    let (asked, answers) = run(&[1.0, 1.00001, 3.0]);
    let Statistics { steps, rejected, evaluations, .. } = plain.statistics;
    assert_eq!(evaluations, 12 * (steps + rejected) + 1);
    assert_eq!(plain, ends);
    assert_eq!((asked.y, answers), (plain.y, 3));
    assert_eq!(asked.statistics.evaluations, evaluations + 3);
    let every = Dop853::new().rtol(1e-8).each_step(&mut nonlinear, (0.0, 3.0), exact(0.0), |_| ()).unwrap();
    assert_eq!(every.statistics.evaluations, evaluations + 3 * every.statistics.steps);
}

/// Coarse steps, so that the errors, which are the method's own, are far above roundoff: the reference is the pair
/// of order 8 in SciPy 1.17 (`DOP853`) with steps of 1/2 from 0 to 2, at the end and in the middle of the third step.
#[test]
fn coarse_steps_are_those_of_an_independent_implementation() {
    let mut middle = [0.0; 2];
    let method = Dop8::new(0.5);
    let end = method.solve(&mut nonlinear, (0.0, 2.0), exact(0.0), [1.25], |_, y| middle = *y).unwrap();
    println!("{:?} {middle:?}, errors {:e} {:e}", end.y, error_at(2.0, &end.y), error_at(1.25, &middle));
    for (found, expected) in end.y.iter().chain(&middle).zip(SCIPY) {
        assert!((found - expected).abs() < 1e-14, "{found} instead of {expected}");
    }
}

const SCIPY: [f64; 4] = [0.1999999853514517, 1.2845054908522404, 0.39024372017530967, 1.395387125107265];
