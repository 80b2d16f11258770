//! Radau IIA of order 5: coefficients, accuracy on stiff and other problems, and what it costs.

use crate::mechanisms::{Arm, distance};
use crate::order_conditions::{defect, dot, values};
use crate::problems::{error_at, errors_of_steps, exact, nonlinear, prothero_robinson};
use redysim_runtime::integrate::collocation::RADAU_IIA_5;
use redysim_runtime::integrate::{Accepted, FixedStep, Ndf, RadauIIA};
use redysim_runtime::{ForwardSimulation, Integrator, Ode, Ode45, Pd, Radau5, Real, Statistics, ZeroTorque};

#[test]
fn the_coefficients_satisfy_every_order_condition_up_to_five_and_not_six() {
    let rows = RADAU_IIA_5.matrix.each_ref().map(|row| row.as_slice());
    let [.., weights] = RADAU_IIA_5.matrix;
    for order in 1..=5 {
        assert!(defect(rows, order, &weights, 1.0) < 1e-15, "order {order}");
    }
    assert!(defect(rows, 6, &weights, 1.0) > 1e-5);
    for (row, &node) in rows.iter().zip(&RADAU_IIA_5.nodes) {
        for power in 1..=3 {
            let integral = dot(row, &RADAU_IIA_5.nodes.map(|c| c.powi(power - 1)));
            assert!((integral - node.powi(power) / f64::from(power)).abs() < 1e-15, "C({power})");
        }
    }
}

/// p_k is 1 at its node and 0 at the others and at 0.
#[test]
fn the_polynomial_passes_through_the_stages() {
    for (k, node) in RADAU_IIA_5.nodes.into_iter().enumerate() {
        for (j, value) in values(RADAU_IIA_5.dense, node).into_iter().enumerate() {
            assert!((value - f64::from(u8::from(j == k))).abs() < 1e-14, "p_{j} is {value} at node {k}");
        }
    }
}

/// e z/h + f(t, y) vanishes for z of polynomials up to degree 3: then only the fourth power of h is left.
#[test]
fn the_estimate_is_blind_to_polynomials_of_degree_three() {
    for power in 1..=3 {
        let estimate = dot(&RADAU_IIA_5.error, &RADAU_IIA_5.nodes.map(|c| c.powi(power)));
        assert!((estimate + f64::from(u8::from(power == 1))).abs() < 1e-14, "t^{power}: {estimate}");
    }
    assert!(dot(&RADAU_IIA_5.error, &RADAU_IIA_5.nodes.map(|c| c.powi(4))).abs() > 1e-3);
}

/// The largest error of rows at times that no method chooses.
fn error_of_rows<const N: usize>(
    method: impl Integrator<f64>,
    ode: &mut impl Ode<f64, [f64; N]>,
    exact: impl Fn(f64) -> [f64; N],
) -> f64 {
    let mut largest = 0.0_f64;
    let times = (1..=70).map(|row| 3.0 / 70.0 * f64::from(row)).map(|t| t.min(3.0));
    method
        .solve(ode, (0.0, 3.0), exact(0.0), times, |t, y| largest = Real::maximum(largest, distance(y, &exact(t))))
        .unwrap();
    largest
}

fn fixed(h: f64) -> FixedStep<f64, RadauIIA> {
    FixedStep::new(h)
}

#[test]
fn radau5_converges_with_order_five_at_the_ends_of_steps_and_within() {
    let [coarse, fine] = [0.05, 0.025].map(|h| errors_of_steps(fixed(h), &mut nonlinear, exact));
    let (order, within) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
    println!("{coarse:?}, {fine:?}: measured order {order:.3}, within {within:.3}");
    assert!((order - 5.0).abs() < 0.2, "{order}");
    assert!(within > 4.7, "{within}");
    assert!(coarse.1 < 3.0 * coarse.0 && fine.1 < 3.0 * fine.0);
}

#[test]
fn within_the_steps_that_a_tolerance_chooses_the_error_is_that_of_the_ends() {
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (ends, within) = errors_of_steps(radau(tolerance), &mut nonlinear, exact);
        println!("tolerance {tolerance:e}: {ends:.1e} at the ends, {within:.1e} within");
        assert!(within < 10.0 * ends, "{within:e} within, {ends:e} at the ends");
    }
}

/// The polynomial of a long step of a stiff equation is far worse than its ends, which are the more accurate the
/// stiffer the equation.
#[test]
fn rows_within_the_steps_of_a_stiff_equation_are_as_accurate_as_the_ends() {
    for stiffness in [1e2, 1e3, 1e4, 1e6] {
        for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
            let (ends, _) = errors_of_steps(radau(tolerance), &mut prothero_robinson(-stiffness), |t| [t.cos()]);
            let rows = error_of_rows(radau(tolerance), &mut prothero_robinson(-stiffness), |t| [t.cos()]);
            println!("{stiffness:e}, tolerance {tolerance:e}: {ends:.1e} at the ends, {rows:.1e} in rows");
            assert!(rows < (2.0 * ends).max(tolerance), "{rows:e} in rows, {ends:e} at the ends");
        }
    }
}

#[test]
fn rows_within_steps_of_one_size_are_as_accurate_as_the_ends() {
    for stiffness in [1e2, 1e4, 1e6] {
        let (ends, _) = errors_of_steps(fixed(0.1), &mut prothero_robinson(-stiffness), |t| [t.cos()]);
        let rows = error_of_rows(fixed(0.1), &mut prothero_robinson(-stiffness), |t| [t.cos()]);
        assert!(rows < 2.0 * ends + 1e-14, "{rows:e} in rows, {ends:e} at the ends");
    }
    let (ends, _) = errors_of_steps(fixed(0.05), &mut nonlinear, exact);
    assert!(error_of_rows(fixed(0.05), &mut nonlinear, exact) < 2.0 * ends);
}

/// Where the derivative jumps within a step, the equations of a shorter one need not converge: the integration goes on
/// as without the look.
#[test]
fn dense_output_changes_no_step_and_ends_no_integration() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let mut jumps = |t: f64, y: &[f64; 2], rate: &mut [f64; 2]| {
            *rate = [y[1], (3.0 * t).sin() - y[0] + if y[0] > 0.05 { 1.0 } else { -1.0 }];
        };
        let method = radau(tolerance).max_steps(2000);
        let plain = method.integrate(&mut jumps, (0.0, 2.0), [0.1, -0.3]).unwrap();
        let seen = method.each_step(&mut jumps, (0.0, 2.0), [0.1, -0.3], |_| {}).unwrap();
        assert_eq!((plain.y, plain.statistics.steps), (seen.y, seen.statistics.steps));
        assert!(seen.statistics.evaluations > plain.statistics.evaluations);
    }
}

/// The decompositions of the first step serve the second, which is shorter by 4·10⁻⁵, but the equations are its own.
#[test]
fn a_step_that_is_a_little_shorter_is_as_accurate() {
    let mut growth = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = y[0];
    let to = 0.02 * (1.0 - 2e-5);
    let end = FixedStep::<f64, RadauIIA>::new(0.01).integrate(&mut growth, (0.0, to), [1.0]).unwrap();
    assert_eq!((end.statistics.steps, end.statistics.decompositions), (2, 2));
    assert!((end.y[0] - to.exp()).abs() < 1e-12, "{}", end.y[0] - to.exp());
}

/// A spring and a damper released at rest at zero: differences over a part of the state alone would see no damping. In
/// the end the rate is of rounding size.
#[test]
fn steps_of_one_size_have_differences_also_where_components_are_zero() {
    for damping in [250.0, 1e4, 1e6] {
        let mut joint = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| {
            *dydt = [y[1], 1e4 * (1.0 - y[0]) - damping * y[1]];
        };
        let root = (damping * damping / 4.0 - 1e4_f64).sqrt();
        // The slow eigenvalue −c/2 + √(c²/4 − k), without cancellation, and the fast one, which has died down.
        let slow = -1e4 / (damping / 2.0 + root);
        let fast = -damping / 2.0 - root;
        let exact = 1.0 - (0.5 * slow).exp() * fast / (fast - slow);
        let end = FixedStep::<f64, RadauIIA>::new(0.01).integrate(&mut joint, (0.0, 0.5), [0.0, 0.0]).unwrap();
        assert!((end.y[0] - exact).abs() < 1e-4, "damping {damping}: {} instead of {exact}", end.y[0]);
        let end = FixedStep::<f64, Ndf>::new(0.001).integrate(&mut joint, (0.0, 0.5), [0.0, 0.0]).unwrap();
        assert!((end.y[0] - exact).abs() < 1e-2, "damping {damping}: {} instead of {exact}", end.y[0]);
    }
}

/// The order of the stages is 3: where λ is large, so is that of the steps, but their error is that much smaller.
#[test]
fn the_errors_of_a_stiff_equation_shrink_with_its_stiffness_and_the_third_power_of_the_step() {
    let cosine = |t: f64| [t.cos()];
    let [coarse, fine] = [0.1, 0.05].map(|h| errors_of_steps(fixed(h), &mut prothero_robinson(-1e6), cosine));
    let stiffer = errors_of_steps(fixed(0.1), &mut prothero_robinson(-1e7), cosine);
    let (order, power) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
    println!("{coarse:?}, {fine:?}, stiffer {stiffer:?}: order {order:.3}, power within {power:.3}");
    assert!((order - 3.0).abs() < 0.3, "{order}");
    assert!((power - 4.0).abs() < 0.3, "{power}");
    // The collocation polynomial errs by 6.7e-8.
    assert!(coarse.1 < 5e-8, "{coarse:?}");
    assert!((coarse.0 / stiffer.0 - 10.0).abs() < 2.0, "{coarse:?} {stiffer:?}");
}

fn radau(tolerance: f64) -> Radau5<'static, f64> {
    Radau5::new().rtol(tolerance).atol(tolerance)
}

/// With error proportional to tolerance and to h⁶ in each step, the number of steps grows with the tolerance to the
/// power −1/6.
#[test]
fn the_error_is_below_the_tolerance_with_steps_of_order_six() {
    let measure = |tolerance: f64| {
        let end = radau(tolerance).max_step(3.0).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
        (error_at(end.t, &end.y), end.statistics)
    };
    for digits in 3..=12 {
        let tolerance = 10.0_f64.powi(-digits);
        let (error, statistics) = measure(tolerance);
        println!("tolerance {tolerance:e}: error {error:e}, {statistics:?}");
        assert!(error < tolerance, "error {error:e} for tolerance {tolerance:e}");
        assert!(statistics.evaluations < 10 * statistics.steps + 50, "two turns of the iteration, and rarely a third");
    }
    let [coarse, fine] = [1e-8, 1e-12].map(|tolerance| measure(tolerance).1.steps as f64);
    let p = (1e4_f64).ln() / (fine / coarse).ln();
    println!("steps grow with the power −1/{p:.3}");
    assert!((p - 6.0).abs() < 0.2, "{p}");
}

#[test]
fn integration_backward_in_time_returns_to_the_start() {
    let forward = radau(1e-11).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    let back = radau(1e-11).integrate(&mut nonlinear, (3.0, 0.0), forward.y).unwrap();
    assert_eq!(back.t, 0.0);
    assert!(error_at(0.0, &back.y) < 1e-9, "{:?}", back.y);
}

/// A. Prothero and A. Robinson's equation, from its solution and from far off it.
#[test]
fn a_fast_decay_takes_fewer_than_150_steps() {
    for lambda in [-1e2, -1e4, -1e6, -1e9] {
        for start in [1.0, 2.0] {
            let end = radau(1e-8).integrate(&mut prothero_robinson(lambda), (0.0, 10.0), [start]).unwrap();
            let error = (end.y[0] - 10.0_f64.cos()).abs();
            println!("λ = {lambda:e} from {start}: error {error:e}, {:?}", end.statistics);
            assert!(error < 2e-7, "{error:e}");
            assert!(end.statistics.steps < 150, "{:?}", end.statistics);
        }
    }
}

/// The estimate from the derivative at the start is that of an error of the size of the transient; the one from where
/// that estimate points to is not.
#[test]
fn a_transient_that_is_over_within_the_first_step_is_jumped_over() {
    let method = radau(1e-8).initial_step(0.01);
    let end = method.integrate(&mut prothero_robinson(-1e9), (0.0, 1.0), [2.0]).unwrap();
    println!("error {:e}, {:?}", end.y[0] - 1.0_f64.cos(), end.statistics);
    assert!((end.y[0] - 1.0_f64.cos()).abs() < 1e-8);
    assert!(end.statistics.rejected <= 1 && end.statistics.steps < 30);
}

/// H. H. Robertson's reactions: reference values from section IV.10 of *Solving Ordinary Differential Equations II*.
#[test]
fn the_reactions_of_robertson_end_where_the_reference_does() {
    let mut reactions = |_t: f64, y: &[f64; 3], rate: &mut [f64; 3]| {
        let (slow, fast, medium) = (0.04 * y[0], 3e7 * y[1] * y[1], 1e4 * y[1] * y[2]);
        *rate = [medium - slow, slow - medium - fast, fast];
    };
    let method = Radau5::new().rtol(1e-8).atol(1e-14).max_step(1e12);
    let end = method.integrate(&mut reactions, (0.0, 1e11), [1.0, 0.0, 0.0]).unwrap();
    println!("{:?}, {:?}", end.y, end.statistics);
    let reference = [0.208_334_014_970_125_5e-7, 0.833_336_077_033_471_3e-13, 0.999_999_979_166_505];
    for (y, reference) in end.y.into_iter().zip(reference) {
        assert!((y / reference - 1.0).abs() < 1e-6, "{y:e} instead of {reference:e}");
    }
    assert!(end.statistics.steps < 800, "{:?}", end.statistics);
}

/// The oscillator of B. van der Pol with μ = 1000, against the same at the tightest tolerance, over more than one
/// period of slow motion with jumps between.
#[test]
fn the_relaxations_of_van_der_pol_are_followed() {
    let mut oscillator =
        |_t: f64, y: &[f64; 2], rate: &mut [f64; 2]| *rate = [y[1], 1000.0 * (1.0 - y[0] * y[0]) * y[1] - y[0]];
    let mut end = |tolerance: f64| {
        let method = Radau5::new().rtol(tolerance).atol(0.1 * tolerance);
        method.integrate(&mut oscillator, (0.0, 2000.0), [2.0, 0.0]).unwrap()
    };
    let reference = end(1e-13).y;
    println!("reference {reference:?}");
    // E. Hairer's page of test problems gives y₁(2000) = 1.706167732170469 for μ = 1000.
    assert!((reference[0] - 1.706_167_732_170_469).abs() < 1e-10, "{reference:?}");
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let end = end(tolerance);
        let error = (end.y[0] - reference[0]).abs();
        println!("tolerance {tolerance:e}: error {error:e}, {:?}", end.statistics);
        assert!(error < 30.0 * tolerance, "{error:e} for {tolerance:e}");
        assert!(end.statistics.steps < 2200 && end.statistics.rejected < 55, "{:?}", end.statistics);
    }
}

/// A robot arm with a stiff servo: damping that explicit steps must follow to the end.
#[test]
fn a_stiff_servo_costs_far_fewer_evaluations_than_explicit_steps_need() {
    let law = || Pd { target: [1.0, 1.0], kp: [1e5, 1e5], kd: [1e4, 1e4] };
    let start = ForwardSimulation::new(&Arm, law()).state(&[0.0, 0.0], &[0.0, 0.0]);
    let implicit = Radau5::new().rtol(1e-6).atol(1e-8);
    let implicit = implicit.integrate(&mut ForwardSimulation::new(&Arm, law()), (0.0, 1.0), start).unwrap();
    let explicit = Ode45::new().rtol(1e-6).atol(1e-8).stiffness_limit(None);
    let explicit = explicit.integrate(&mut ForwardSimulation::new(&Arm, law()), (0.0, 1.0), start).unwrap();
    println!("{:?}\n{:?}\n{:?}\n{:?}", implicit.statistics, explicit.statistics, implicit.y, explicit.y);
    assert!((0..4).all(|i| (implicit.y[i] - explicit.y[i]).abs() < 1e-5));
    assert!(100 * implicit.statistics.evaluations < explicit.statistics.evaluations);
}

/// The same equation without its tangents.
struct Differences<O>(O);

impl<O: Ode<f64, Y>, Y> Ode<f64, Y> for Differences<O> {
    fn derivative(&mut self, t: f64, y: &Y, dydt: &mut Y) {
        self.0.derivative(t, y, dydt);
    }
}

#[test]
fn tangents_and_differences_lead_to_the_same_motion() {
    let law = || Pd { target: [1.0, 1.0], kp: [1e3, 1e3], kd: [1e2, 1e2] };
    let mut exact = ForwardSimulation::new(&Arm, law());
    let start = exact.state(&[0.0, 0.0], &[0.0, 0.0]);
    let with = radau(1e-8).integrate(&mut exact, (0.0, 1.0), start).unwrap();
    let without =
        radau(1e-8).integrate(&mut Differences(ForwardSimulation::new(&Arm, law())), (0.0, 1.0), start).unwrap();
    println!("{:?}\n{:?}\n{:e}", with.statistics, without.statistics, distance(&with.y, &without.y));
    assert!(distance(&with.y, &without.y) < 1e-7);
    assert_eq!(with.statistics.steps, without.statistics.steps);
    assert!(without.statistics.evaluations >= with.statistics.evaluations + 5 * without.statistics.jacobians);
}

#[test]
fn jacobians_and_decompositions_are_kept_while_they_serve() {
    let mut linear = |_t: f64, y: &[f64; 2], rate: &mut [f64; 2]| *rate = [-1000.0 * (y[0] - y[1]), -y[1]];
    let end = radau(1e-6).integrate(&mut linear, (0.0, 10.0), [2.0, 1.0]).unwrap();
    println!("{:?}", end.statistics);
    assert_eq!(end.statistics.jacobians, 1, "of a linear equation one is enough");
    let Statistics { steps, rejected, decompositions, .. } = end.statistics;
    assert!(2 * decompositions < 3 * (steps + rejected), "some sizes are kept");
}

/// With steps of one size there is no driver that would take a smaller one.
#[test]
fn a_jacobian_that_does_not_serve_any_more_is_evaluated_again() {
    struct Caught;
    impl Ode<f64, [f64; 1]> for Caught {
        fn derivative(&mut self, _t: f64, y: &[f64; 1], rate: &mut [f64; 1]) {
            rate[0] = if y[0] < 1.0 { 0.5 } else { -1e4 * (y[0] - 2.0) };
        }
        fn accepted(&mut self, t: f64, _step: f64, y: &mut [f64; 1]) -> Accepted {
            if t == 0.5 {
                y[0] = 3.0;
                return Accepted::Corrected;
            }
            Accepted::Unchanged
        }
    }
    let end = FixedStep::<f64, RadauIIA>::new(0.1).integrate(&mut Caught, (0.0, 1.0), [0.0]).unwrap();
    assert!((2..5).contains(&end.statistics.jacobians), "{:?}", end.statistics);
    assert!((end.y[0] - 2.0).abs() < 1e-9, "{:?}", end.y);
}

#[test]
fn a_correction_after_each_step_is_gone_on_from() {
    struct Circle;
    impl Ode<f64, [f64; 2]> for Circle {
        fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
            *dydt = [-y[1], y[0]];
        }
        fn accepted(&mut self, _t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
            let radius = y[0].hypot(y[1]);
            *y = y.map(|y| y / radius);
            Accepted::Corrected
        }
    }
    let mut last = [1.0, 0.0];
    let end = radau(1e-5)
        .each_step(&mut Circle, (0.0, 3.0), last, |step| {
            assert_eq!(*step.start().1, last);
            assert_eq!(step.at(step.end().0), *step.end().1);
            last = *step.end().1;
        })
        .unwrap();
    assert_eq!(end.statistics.corrections, end.statistics.steps);
    assert!((end.y[1] / end.y[0] - 3.0_f64.tan()).abs() < 1e-4, "{:?}", end.y);
}

/// λ/h − J = 0 for the first step that is tried: a smaller one is taken.
#[test]
fn a_singular_matrix_makes_the_step_smaller() {
    let mut growth = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = RADAU_IIA_5.real.value * y[0];
    struct Tangent<F>(F);
    impl<F: FnMut(f64, &[f64; 1], &mut [f64; 1])> Ode<f64, [f64; 1]> for Tangent<F> {
        fn derivative(&mut self, t: f64, y: &[f64; 1], dydt: &mut [f64; 1]) {
            (self.0)(t, y, dydt);
        }
        fn tangent(&mut self, _t: f64, _y: &[f64; 1], direction: &[f64; 1], slope: &mut [f64; 1]) -> bool {
            slope[0] = RADAU_IIA_5.real.value * direction[0];
            true
        }
    }
    let method = radau(1e-6).initial_step(1.0).max_step(1.0);
    let end = method.integrate(&mut Tangent(&mut growth), (0.0, 3.0), [1.0]).unwrap();
    assert!(end.statistics.rejected > 0);
    let exact = (3.0 * RADAU_IIA_5.real.value).exp();
    assert!((end.y[0] / exact - 1.0).abs() < 1e-4, "{} instead of {exact}", end.y[0]);
}

/// The bound is that of the explicit methods in `accuracy.rs`.
#[test]
fn single_precision_ends_within_25_roundoff_units_of_the_error_in_double_precision() {
    let from = exact(0.0).map(|y| y as f32);
    let end = Radau5::new().rtol(2e-5_f32).atol(1e-6).integrate(&mut nonlinear, (0.0, 3.0), from).unwrap();
    let double = Radau5::new().rtol(2e-5).atol(1e-6).integrate(&mut nonlinear, (0.0, 3.0), exact(0.0)).unwrap();
    let [single, double] = [error_at(end.t, &end.y), error_at(double.t, &double.y)];
    println!("{single:e} in single precision, {double:e} in double");
    assert!(single < double + 25.0 * f64::from(f32::EPSILON), "{:?}", end.y);
}

#[cfg(feature = "alloc")]
#[test]
fn vectors_give_the_same_bits_as_arrays() {
    let mut array = |t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| nonlinear(t, y, dydt);
    let mut vector = |t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>| {
        let mut rate = [0.0; 2];
        nonlinear(t, &[y[0], y[1]], &mut rate);
        dydt.copy_from_slice(&rate);
    };
    let from = exact(0.0);
    let (array, vector) = (
        radau(1e-8).integrate(&mut array, (0.0, 3.0), from).unwrap(),
        radau(1e-8).integrate(&mut vector, (0.0, 3.0), from.to_vec()).unwrap(),
    );
    assert_eq!((array.y.to_vec(), array.statistics), (vector.y, vector.statistics));
    let mut nothing = |_t: f64, _y: &Vec<f64>, _dydt: &mut Vec<f64>| {};
    assert!(Radau5::new().integrate(&mut nothing, (0.0, 1.0), vec![]).is_ok());
}

#[test]
fn an_arm_at_rest_stays_exactly_where_it_is() {
    let mut arm = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = arm.state(&[0.0, 0.0], &[0.0, 0.0]);
    assert_eq!(Radau5::new().integrate(&mut arm, (0.0, 10.0), start).unwrap().y, [0.0; 5]);
}
