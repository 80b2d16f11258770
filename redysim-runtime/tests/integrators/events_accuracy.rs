//! Events that the methods of Gauss and Radau find are as accurate as the ends of their steps.

use redysim_runtime::Real;
use std::ops::ControlFlow::Continue;

use crate::problems::{errors_of_steps, exact, nonlinear, prothero_robinson};
use redysim_runtime::integrate::{FixedStep, RadauIIA};
use redysim_runtime::{Event, Gauss4, Gauss6, Integrator, Occurrence, Ode, Radau5};

/// The largest errors of the state at the ends of steps and at events: the first component, which falls, passes the
/// values that the solution has at 69 times. An error of the time of an event counts by what it changes in that
/// component.
fn errors<const N: usize, M: Integrator<f64>>(
    method: impl Fn() -> M,
    ode: &mut impl Ode<f64, [f64; N]>,
    exact: impl Fn(f64) -> [f64; N],
) -> [f64; 2] {
    let times: Vec<f64> = (1..70).map(|k| 3.0 / 70.0 * f64::from(k)).collect();
    let values: Vec<_> =
        times.iter().map(|&t| exact(t)[0]).map(|level| move |_: f64, y: &[f64; N]| y[0] - level).collect();
    let mut events: Vec<_> = values.iter().map(|value| Event::falling(value)).collect();
    let (mut found, mut worst) = (0, 0.0_f64);
    let note = |Occurrence { event, t, y, .. }: Occurrence<'_, f64, [f64; N]>| {
        assert_eq!(event, found, "once each, in order");
        found += 1;
        let (wanted, expected) = (exact(times[event]), exact(t));
        let of_state = y.iter().zip(&expected).map(|(y, expected)| (y - expected).abs());
        worst = of_state.fold(Real::maximum(worst, (expected[0] - wanted[0]).abs()), Real::maximum);
        Continue(())
    };
    method().solve_with_events(ode, (0.0, 3.0), exact(0.0), &mut events, |_| Continue(()), note).unwrap();
    assert_eq!(found, times.len());
    [errors_of_steps(method(), ode, exact).0, worst]
}

fn cosine(t: f64) -> [f64; 1] {
    [t.cos()]
}

/// From coarse steps to fine ones.
fn check_order<M: Integrator<f64>>(method: impl Fn(f64) -> M, order: f64, h: f64) {
    let [coarse, fine] = [h, h / 2.0].map(|h| errors(|| method(h), &mut nonlinear, exact));
    let measured = (coarse[1] / fine[1]).log2();
    println!("errors at ends and events {coarse:?}, {fine:?}: measured order {measured:.3}");
    assert!(measured > order - 0.3, "{measured}");
    assert!(coarse[1] < 3.0 * coarse[0] && fine[1] < 3.0 * fine[0], "{coarse:?}, {fine:?}");
}

#[test]
fn events_converge_with_the_order_of_the_steps() {
    check_order(Gauss4::new, 4.0, 0.05);
    check_order(Gauss6::new, 6.0, 0.1);
    check_order(FixedStep::<f64, RadauIIA>::new, 5.0, 0.05);
}

fn radau(tolerance: f64) -> Radau5<'static, f64> {
    Radau5::new().rtol(tolerance).atol(tolerance)
}

#[test]
fn events_within_the_steps_that_a_tolerance_chooses_are_as_accurate_as_the_ends() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let [ends, events] = errors(|| radau(tolerance), &mut nonlinear, exact);
        println!("tolerance {tolerance:e}: {ends:.1e} at the ends, {events:.1e} at events");
        assert!(events < 10.0 * ends, "{events:e} at events, {ends:e} at the ends");
    }
}

#[test]
fn events_of_a_stiff_equation_are_as_accurate_as_the_ends() {
    for stiffness in [1e2, 1e3, 1e4, 1e6] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let [ends, events] = errors(|| radau(tolerance), &mut prothero_robinson(-stiffness), cosine);
            println!("{stiffness:e}, tolerance {tolerance:e}: {ends:.1e} at the ends, {events:.1e} at events");
            assert!(events < (2.0 * ends).max(tolerance), "{events:e} at events, {ends:e} at the ends");
        }
        let fixed = || FixedStep::<f64, RadauIIA>::new(0.1);
        let [ends, events] = errors(fixed, &mut prothero_robinson(-stiffness), cosine);
        println!("{stiffness:e}, steps of 0.1: {ends:.1e} at the ends, {events:.1e} at events");
        assert!(events < 2.0 * ends + 1e-14, "{events:e} at events, {ends:e} at the ends");
    }
}
