//! The coefficients against the order conditions, one for each rooted tree (Butcher's theory).

use crate::order_conditions::{trees, values};
use redysim_runtime::integrate::tableau::{DORMAND_PRINCE, DORMAND_PRINCE_853, ErrorEstimate, RUNGE_KUTTA_4, Tableau};

/// For coefficients of moderate size.
const ROUNDOFF: f64 = 1e-14;
/// For those of order 8, which are up to 43 in the stages and up to 530 in the extension.
const ROUNDOFF_853: f64 = 1e-12;

const THETAS: [f64; 9] = [0.0, 0.1, 0.25, 0.5, 0.7, 0.9, 0.99, 0.9999, 1.0];

/// The largest violation of the order conditions of one order.
fn defect<const N: usize>(tableau: &Tableau<N>, order: usize, b: &[f64], theta: f64) -> f64 {
    crate::order_conditions::defect(tableau.rows, order, b, theta)
}

/// Whether a formula satisfies all conditions up to an order, and clearly not those of the next.
fn has_order<const N: usize>(tableau: &Tableau<N>, order: usize, b: &[f64], roundoff: f64) {
    for lower in 1..=order {
        let defect = defect(tableau, lower, b, 1.0);
        assert!(defect < roundoff, "order {lower}: {defect:e}");
    }
    let next = defect(tableau, order + 1, b, 1.0);
    assert!(next > 1e-6, "order {}: {next:e}", order + 1);
}

fn solution_weights<const N: usize>(tableau: &Tableau<N>) -> [f64; N] {
    std::array::from_fn(|k| tableau.rows[tableau.main - 1].get(k).copied().unwrap_or(0.0))
}

/// The embedded formula of which `error` is the difference.
fn embedded_weights<const N: usize>(tableau: &Tableau<N>, error: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| solution_weights(tableau)[k] - error[k])
}

fn dense_weights<const N: usize>(tableau: &Tableau<N>, theta: f64) -> [f64; N] {
    values(tableau.dense, theta)
}

fn dense_rates<const N: usize>(tableau: &Tableau<N>, theta: f64) -> [f64; N] {
    tableau
        .dense
        .map(|polynomial| (1..).zip(polynomial).map(|(power, c)| f64::from(power) * c * theta.powi(power - 1)).sum())
}

fn assert_near<const N: usize>(found: [f64; N], expected: [f64; N], roundoff: f64) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < roundoff, "{found} instead of {expected}");
    }
}

fn unit<const N: usize>(stage: usize) -> [f64; N] {
    std::array::from_fn(|k| f64::from(k == stage))
}

fn check_rows<const N: usize>(tableau: &Tableau<N>) {
    for (k, row) in tableau.rows.iter().enumerate() {
        assert_eq!(row.len(), k);
        let sum: f64 = row.iter().sum();
        assert!((sum - tableau.nodes[k]).abs() < 10.0 * ROUNDOFF, "row {k}: {sum}");
    }
    assert_eq!(tableau.nodes[tableau.main - 1], 1.0);
}

/// A continuous extension of `order` that joins its neighbours in value and derivative.
fn check_extension<const N: usize>(tableau: &Tableau<N>, order: usize, roundoff: f64) {
    for lower in 1..=order {
        for theta in THETAS {
            let defect = defect(tableau, lower, &dense_weights(tableau, theta), theta);
            assert!(defect < roundoff, "order {lower}, θ = {theta}: {defect:e}");
        }
    }
    assert!(defect(tableau, order + 1, &dense_weights(tableau, 0.5), 0.5) > 1e-7);
    assert_near(dense_weights(tableau, 1.0), solution_weights(tableau), roundoff);
    assert_near(dense_rates(tableau, 0.0), unit(0), roundoff);
    assert_near(dense_rates(tableau, 1.0), unit(tableau.main - 1), 10.0 * roundoff);
}

#[test]
fn there_are_as_many_rooted_trees_as_cayley_counted() {
    assert_eq!([1, 2, 3, 4, 5, 6, 7, 8].map(|order| trees(order).len()), [1, 1, 2, 4, 9, 20, 48, 115]);
}

#[test]
fn every_row_has_as_many_entries_as_there_are_stages_before_it_and_sums_to_its_node() {
    check_rows(&RUNGE_KUTTA_4);
    check_rows(&DORMAND_PRINCE);
    check_rows(&DORMAND_PRINCE_853);
}

#[test]
fn every_method_satisfies_the_conditions_of_its_order_and_not_those_of_the_next() {
    has_order(&RUNGE_KUTTA_4, 4, &solution_weights(&RUNGE_KUTTA_4), ROUNDOFF);
    has_order(&DORMAND_PRINCE, 5, &solution_weights(&DORMAND_PRINCE), ROUNDOFF);
    has_order(&DORMAND_PRINCE_853, 8, &solution_weights(&DORMAND_PRINCE_853), ROUNDOFF_853);
}

#[test]
fn the_embedded_formula_of_dormand_prince_is_of_order_four() {
    let tableau = &DORMAND_PRINCE;
    let ErrorEstimate::Embedded(error) = &tableau.error else { panic!("one embedded formula") };
    has_order(tableau, 4, &embedded_weights(tableau, error), ROUNDOFF);
    assert_eq!(tableau.error_exponent, 5);
}

/// The estimate e²/ẽ shrinks with h⁶ · h⁶ / h⁴.
#[test]
fn the_embedded_formulas_of_the_pair_of_order_eight_are_of_orders_five_and_three() {
    let tableau = &DORMAND_PRINCE_853;
    let ErrorEstimate::Stretched { higher, lower } = &tableau.error else { panic!("two embedded formulas") };
    has_order(tableau, 5, &embedded_weights(tableau, higher), ROUNDOFF_853);
    has_order(tableau, 3, &embedded_weights(tableau, lower), ROUNDOFF_853);
    assert_eq!(tableau.error_exponent, 2 * 6 - 4);
}

#[test]
fn the_continuous_extensions_have_their_order_within_the_whole_step_and_meet_their_neighbours() {
    check_extension(&RUNGE_KUTTA_4, 3, ROUNDOFF);
    check_extension(&DORMAND_PRINCE, 4, ROUNDOFF);
    check_extension(&DORMAND_PRINCE_853, 7, ROUNDOFF_853);
}
