//! The coefficients against the order conditions, one for each rooted tree (Butcher's theory).

mod order_conditions;

use order_conditions::{trees, values};
use redysim_runtime::integrate::tableau::{DORMAND_PRINCE, ErrorEstimate};

const STAGES: usize = 7;
const ROUNDOFF: f64 = 1e-14;

/// The largest violation of the order conditions of one order.
fn defect(order: usize, b: &[f64], theta: f64) -> f64 {
    order_conditions::defect(DORMAND_PRINCE.rows, order, b, theta)
}

fn solution_weights() -> [f64; STAGES] {
    std::array::from_fn(|k| DORMAND_PRINCE.rows[STAGES - 1].get(k).copied().unwrap_or(0.0))
}

fn embedded_weights() -> [f64; STAGES] {
    let ErrorEstimate::Embedded(error) = DORMAND_PRINCE.error else { panic!("one embedded formula") };
    std::array::from_fn(|k| solution_weights()[k] - error[k])
}

fn dense_weights(theta: f64) -> [f64; STAGES] {
    values(DORMAND_PRINCE.dense, theta)
}

fn dense_rates(theta: f64) -> [f64; STAGES] {
    DORMAND_PRINCE
        .dense
        .map(|polynomial| (1..).zip(polynomial).map(|(power, c)| f64::from(power) * c * theta.powi(power - 1)).sum())
}

fn assert_near(found: [f64; STAGES], expected: [f64; STAGES]) {
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < ROUNDOFF, "{found} instead of {expected}");
    }
}

fn unit(stage: usize) -> [f64; STAGES] {
    std::array::from_fn(|k| f64::from(k == stage))
}

#[test]
fn there_are_as_many_rooted_trees_as_cayley_counted() {
    assert_eq!([1, 2, 3, 4, 5, 6].map(|order| trees(order).len()), [1, 1, 2, 4, 9, 20]);
}

#[test]
fn every_row_has_as_many_entries_as_there_are_stages_before_it_and_sums_to_its_node() {
    for (k, row) in DORMAND_PRINCE.rows.iter().enumerate() {
        assert_eq!(row.len(), k);
        assert!((row.iter().sum::<f64>() - DORMAND_PRINCE.nodes[k]).abs() < ROUNDOFF, "row {k}");
    }
}

#[test]
fn dormand_prince_satisfies_every_order_condition_up_to_five_and_not_six() {
    for order in 1..=5 {
        assert!(defect(order, &solution_weights(), 1.0) < ROUNDOFF, "order {order}");
    }
    assert!(defect(6, &solution_weights(), 1.0) > 1e-4);
}

#[test]
fn the_embedded_formula_satisfies_every_order_condition_up_to_four_and_not_five() {
    assert_eq!(DORMAND_PRINCE.error_exponent, 5);
    for order in 1..=4 {
        assert!(defect(order, &embedded_weights(), 1.0) < ROUNDOFF, "order {order}");
    }
    assert!(defect(5, &embedded_weights(), 1.0) > 1e-4);
}

#[test]
fn the_continuous_extension_satisfies_every_order_condition_up_to_four_within_the_whole_step() {
    for order in 1..=4 {
        for theta in [0.0, 0.1, 0.25, 0.5, 0.7, 0.9, 1.0] {
            assert!(defect(order, &dense_weights(theta), theta) < ROUNDOFF, "order {order}, θ = {theta}");
        }
    }
}

#[test]
fn the_continuous_extension_meets_its_neighbours_in_value_and_in_derivative() {
    assert_near(dense_weights(1.0), solution_weights());
    assert_near(dense_rates(0.0), unit(0));
    assert_near(dense_rates(1.0), unit(STAGES - 1));
}
