//! The methods of Gauss and Legendre: coefficients, orders, and what they conserve.

use crate::mechanisms::{Arm, Pendulum, distance};
use crate::order_conditions::{defect, dot, values};
use crate::problems::{error_at, errors_of_steps, exact, nonlinear};
use redysim_runtime::Real;
use redysim_runtime::integrate::collocation::{GAUSS_LEGENDRE_2, GAUSS_LEGENDRE_3, GaussTableau};
use redysim_runtime::{
    ForwardSimulation, Gauss4, Gauss6, IntegrationError, Integrator, MechanicalEnergy, Ode4, Step, ZeroTorque,
};

fn matrix<const STAGES: usize>(tableau: &GaussTableau<STAGES>) -> [[f64; STAGES]; STAGES] {
    tableau.skew.map(|skew| std::array::from_fn(|j| tableau.weights[j] * (0.5 + skew[j])))
}

fn check_tableau<const STAGES: usize>(tableau: &GaussTableau<STAGES>) {
    let a = matrix(tableau);
    let rows = a.each_ref().map(|row| row.as_slice());
    for order in 1..=2 * STAGES {
        assert!(defect(rows, order, &tableau.weights, 1.0) < 1e-15, "order {order}");
    }
    assert!(defect(rows, 2 * STAGES + 1, &tableau.weights, 1.0) > 1e-5);
    for (row, &node) in a.iter().zip(&tableau.nodes) {
        for power in 1..=STAGES as i32 {
            let integral = dot(row, &tableau.nodes.map(|c| c.powi(power - 1)));
            assert!((integral - node.powi(power) / f64::from(power)).abs() < 1e-16 * 4.0, "C({power})");
        }
        for (dense, &a) in values(tableau.dense, node).iter().zip(row) {
            assert!((dense - a).abs() < 1e-15, "the polynomial passes through the stages: {dense} instead of {a}");
        }
    }
    for (dense, weight) in values(tableau.dense, 1.0).iter().zip(tableau.weights) {
        assert!((dense - weight).abs() < 1e-15, "{dense} instead of {weight}");
    }
    for order in 1..=STAGES {
        for theta in [0.1, 0.5, 0.8] {
            assert!(defect(rows, order, &values(tableau.dense, theta), theta) < 1e-15, "order {order} at {theta}");
        }
    }
}

#[test]
fn the_coefficients_satisfy_every_order_condition_and_the_polynomial_those_up_to_the_number_of_stages() {
    check_tableau(&GAUSS_LEGENDRE_2);
    check_tableau(&GAUSS_LEGENDRE_3);
}

/// Conservation and symmetry hold of the rounded numbers, not only of the exact ones.
fn check_geometry<const STAGES: usize>(tableau: &GaussTableau<STAGES>) {
    let last = STAGES - 1;
    assert_eq!(tableau.weights.iter().sum::<f64>(), 1.0);
    for i in 0..STAGES {
        assert_eq!(tableau.weights[i], tableau.weights[last - i]);
        for j in 0..STAGES {
            assert_eq!(tableau.skew[i][j], -tableau.skew[j][i], "symplectic");
            assert_eq!(tableau.skew[i][j], -tableau.skew[last - i][last - j], "symmetric");
        }
    }
}

#[test]
fn the_rounded_coefficients_are_those_of_symmetric_and_symplectic_methods() {
    check_geometry(&GAUSS_LEGENDRE_2);
    check_geometry(&GAUSS_LEGENDRE_3);
}

/// From coarse steps to fine ones.
fn check_orders<M: Integrator<f64>>(method: impl Fn(f64) -> M, order: f64, h: f64) {
    let [coarse, fine] = [h, h / 2.0].map(|h| errors_of_steps(method(h), &mut nonlinear, exact));
    let measured = [(coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2()];
    println!("errors {coarse:?} and {fine:?}: measured orders {measured:?} at the ends and within");
    assert!((measured[0] - order).abs() < 0.2, "{measured:?}");
    assert!(measured[1] > order - 0.3, "{measured:?}");
    assert!(coarse.1 < 3.0 * coarse.0 && fine.1 < 3.0 * fine.0, "{coarse:?}, {fine:?}");
}

#[test]
fn each_method_converges_with_its_order_at_the_ends_of_steps_and_within() {
    check_orders(Gauss4::new, 4.0, 0.05);
    check_orders(Gauss6::new, 6.0, 0.1);
}

/// A double pendulum released from the horizontal, whose second arm turns over, with steps of 10 ms.
#[test]
fn rows_between_the_ends_of_steps_keep_the_energy_as_the_ends_do() {
    fn drift(method: &impl Integrator<f64>, apart: f64) -> f64 {
        let mut arm = ForwardSimulation::new(&Arm, ZeroTorque);
        let start = arm.state(&[std::f64::consts::FRAC_PI_2, 0.0], &[0.0, 0.0]);
        let energy = |y: &[f64; 5]| Arm.energy(&[y[0], y[1]], &[y[2], y[3]]).total();
        let (first, mut drift) = (energy(&start), 0.0_f64);
        let times = (0..).map(|k| apart * f64::from(k)).take_while(|t| *t <= 20.0);
        let see = |_: f64, y: &[f64; 5]| drift = drift.max((energy(y) - first).abs());
        method.solve(&mut arm, (0.0, 20.0), start, times, see).unwrap();
        drift
    }
    fn check(method: impl Integrator<f64>) {
        let (ends, rows) = (drift(&method, 0.01), drift(&method, 0.007));
        println!("rows each 10 ms: {ends:.1e} J, each 7 ms: {rows:.1e} J");
        assert!(ends > 1e-9, "not all rounding: {ends:e} J");
        assert!(rows < 3.0 * ends, "{rows:e} J between the ends, {ends:e} J at them");
    }
    check(Gauss4::new(0.01));
    check(Gauss6::new(0.01));
}

#[test]
fn steps_forward_and_back_return_to_the_start() {
    fn check(method: impl Integrator<f64>) {
        let mut arm = ForwardSimulation::new(&Arm, ZeroTorque);
        let start = arm.state(&[1.0, -0.5], &[0.3, 2.0]);
        let there = method.integrate(&mut arm, (0.0, 10.0), start).unwrap().y;
        let back = method.integrate(&mut arm, (10.0, 0.0), there).unwrap().y;
        println!("back within {:e} of the start", distance(&back, &start));
        assert!(distance(&there, &start) > 0.1);
        assert!(distance(&back, &start) < 1e-11, "{back:?}");
    }
    // Roundoff is amplified by the motion, but a method that is not symmetric would miss by its truncation error.
    check(Gauss4::new(0.02));
    check(Gauss6::new(0.02));
}

/// A rigid body without forces conserves |L|² and L·ω, two quadratic forms.
#[test]
fn quadratic_invariants_are_kept_to_roundoff() {
    fn defects(method: impl Integrator<f64>) -> f64 {
        let inertia = [1.0, 2.0, 3.5];
        let mut euler = |_t: f64, l: &[f64; 3], rate: &mut [f64; 3]| {
            let w: [f64; 3] = std::array::from_fn(|i| l[i] / inertia[i]);
            *rate = [l[1] * w[2] - l[2] * w[1], l[2] * w[0] - l[0] * w[2], l[0] * w[1] - l[1] * w[0]];
        };
        let invariants =
            |l: &[f64; 3]| [dot(l, l), l.iter().zip(inertia).map(|(l, inertia)| l * l / inertia).sum::<f64>()];
        let start = [0.3, 1.0, -0.6];
        let end = method.integrate(&mut euler, (0.0, 1000.0), start).unwrap().y;
        let [before, after] = [start, end].map(|l| invariants(&l));
        before.iter().zip(after).map(|(before, after)| (after / before - 1.0).abs()).fold(0.0, Real::maximum)
    }
    let (four, six, explicit) = (defects(Gauss4::new(0.1)), defects(Gauss6::new(0.1)), defects(Ode4::new(0.1)));
    println!("relative defects after 10⁴ steps: {four:e}, {six:e}; of Ode4: {explicit:e}");
    assert!(four < 1e-14 && six < 1e-14);
    assert!(explicit > 1e-8);
}

/// The least-squares slope of the relative energy error over time.
fn energy_slope(method: impl Integrator<f64>, step: f64, until: f64) -> (f64, f64) {
    let mut arm = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = arm.state(&[0.8, -0.5], &[0.0, 0.0]);
    let energy = |y: &[f64; 5]| {
        let energy = Arm.energy(&[y[0], y[1]], &[y[2], y[3]]);
        energy.kinetic + energy.potential
    };
    let first = energy(&start);
    let (mut n, mut t_sum, mut e_sum, mut te, mut tt, mut largest) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0_f64);
    // The ends of the steps, so that nothing is evaluated within.
    let times = (1..).map(|k| step * f64::from(k)).take_while(|t| *t <= until);
    method
        .solve(&mut arm, (0.0, until), start, times, |t, y| {
            let e = (energy(y) - first) / first.abs();
            (n, t_sum, e_sum, te, tt) = (n + 1.0, t_sum + t, e_sum + e, te + t * e, tt + t * t);
            largest = Real::maximum(largest, e.abs());
        })
        .unwrap();
    ((te - t_sum * e_sum / n) / (tt - t_sum * t_sum / n), largest)
}

#[test]
fn the_energy_of_a_double_pendulum_has_no_slope() {
    let duration = if cfg!(debug_assertions) { 100.0 } else { 1000.0 };
    let (six, largest) = energy_slope(Gauss6::new(0.01), 0.01, duration);
    println!("Gauss6: slope {six:e} per s, largest error {largest:e}");
    assert!(six.abs() < 1e-15 && largest < 1e-11);
}

/// By the fifth power: 1024 times as much with steps four times as large.
#[test]
fn ode4_loses_energy_in_proportion_to_a_power_of_its_step() {
    let duration = if cfg!(debug_assertions) { 50.0 } else { 200.0 };
    let [long, short] = [0.01, 0.0025].map(|step| energy_slope(Ode4::new(step), step, duration).0);
    println!("Ode4: slopes {long:e} and {short:e} per s, ratio {}", long / short);
    assert!((long / short / 1024.0 - 1.0).abs() < 0.2);
}

fn kepler(_t: f64, y: &[f64; 4], rate: &mut [f64; 4]) {
    let r3 = y[0].hypot(y[1]).powi(3);
    *rate = [y[2], y[3], -y[0] / r3, -y[1] / r3];
}

/// The largest energy errors in the first and in the last of 100 revolutions of eccentricity 0.6, with steps of 1/200
/// of one.
fn energy_errors_of_a_planet<M: Integrator<f64>>(method: impl Fn(f64) -> M) -> (f64, f64) {
    let period = std::f64::consts::TAU;
    let (mut first, mut last) = (0.0_f64, 0.0_f64);
    let look = |step: &Step<'_, f64, [f64; 4]>| {
        let (t, y) = step.end();
        // The energy is −1/2.
        let error = (0.5 * (y[2] * y[2] + y[3] * y[3]) - 1.0 / y[0].hypot(y[1]) + 0.5).abs();
        if t < period {
            first = first.max(error);
        } else if t > 99.0 * period {
            last = last.max(error);
        }
    };
    method(period / 200.0).each_step(&mut kepler, (0.0, 100.0 * period), [0.4, 0.0, 0.0, 2.0], look).unwrap();
    (first, last)
}

/// In canonical coordinates the errors may be large: they remain what they are in one revolution.
#[test]
fn the_energy_of_a_planet_oscillates_without_growing() {
    let (gauss, explicit) = (energy_errors_of_a_planet(Gauss4::new), energy_errors_of_a_planet(Ode4::new));
    println!("largest error in the first and in the last revolution: Gauss4 {gauss:?}, Ode4 {explicit:?}");
    assert!(gauss.1 < 1.05 * gauss.0);
    assert!(explicit.1 > 20.0 * explicit.0);
}

#[test]
fn an_iteration_that_does_not_converge_is_an_error_with_its_time_and_the_remedies() {
    let mut stiff = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -1e6 * (y[0] - t.cos());
    let error = Gauss4::new(0.1).integrate(&mut stiff, (0.0, 1.0), [0.5]).unwrap_err();
    assert_eq!(error, IntegrationError::NotConverged { t: 0.0, step: 0.1 });
    let message = error.to_string();
    for word in ["t = 0.0", "0.1", "smaller steps", "Radau5"] {
        assert!(message.contains(word), "{message:?} lacks {word:?}");
    }
    // h λ = 2 contracts, though not with every turn.
    assert!(Gauss4::new(2e-6).integrate(&mut stiff, (0.0, 1e-4), [0.5]).is_ok());
}

/// At an equilibrium that is one only up to roundoff the iteration has nothing to do but noise.
#[test]
fn a_pendulum_at_rest_moves_by_less_than_1e_minus_13() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    for q in [0.0, 3e-17, std::f64::consts::PI] {
        let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
        let start = simulation.state(&[q], &[0.0]);
        let end = Gauss6::new(0.01).integrate(&mut simulation, (0.0, 1.0), start).unwrap();
        assert!((end.y[0] - q).abs() < 1e-13, "{:?}", end.y);
    }
}

/// The bound is that of the explicit methods in `accuracy.rs`.
#[test]
fn single_precision_ends_within_25_roundoff_units() {
    let from = exact(0.0).map(|y| y as f32);
    for end in [
        Gauss4::new(0.01_f32).integrate(&mut nonlinear, (0.0, 3.0), from).unwrap(),
        Gauss6::new(0.05_f32).integrate(&mut nonlinear, (0.0, 3.0), from).unwrap(),
    ] {
        assert!(error_at(end.t, &end.y) < 25.0 * f64::from(f32::EPSILON), "{:?}", end.y);
    }
}

/// From the polynomial of the last step the iteration needs fewer turns than from the state.
#[test]
fn a_step_begins_where_the_last_one_points_to() {
    let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
    let one = Gauss6::new(0.1).integrate(&mut oscillator, (0.0, 0.1), [1.0, 0.0]).unwrap().statistics.evaluations;
    let all = Gauss6::new(0.1).integrate(&mut oscillator, (0.0, 10.0), [1.0, 0.0]).unwrap().statistics.evaluations;
    println!("{one} evaluations for the first step, {} for each of a hundred", all / 100);
    assert!(all < 85 * one);
}
