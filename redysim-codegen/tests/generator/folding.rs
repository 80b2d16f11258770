//! What the graph folds when a value is made, and what it must not touch.

use redysim_codegen::expressions::Expressions;
use redysim_codegen::passes::{self, Passes};
use redysim_codegen::symbol::{Symbol, Tracer};
use redysim_runtime::Scalar;

/// The simplified expressions of a function of x[0..4].
fn traced(function: impl for<'g> Fn(&[Symbol<'g>]) -> Vec<Symbol<'g>>) -> Expressions {
    let tracer = Tracer::default();
    let outputs = tracer.edges(&function(&tracer.argument(0, 4)));
    let traced = Expressions { graph: tracer.into_graph(), outputs };
    passes::simplified(traced, &Passes::default()).expect("no pass changes a value")
}

/// Its additions, multiplications, divisions and sine-cosine pairs.
fn counts(function: impl for<'g> Fn(&[Symbol<'g>]) -> Vec<Symbol<'g>>) -> [u32; 4] {
    let count = traced(function).count();
    [count.additions, count.multiplications, count.divisions, count.trig]
}

fn k(value: f64) -> Symbol<'static> {
    Symbol::from_f64(value)
}

#[test]
fn zeros_and_ones_cost_nothing() {
    assert_eq!(counts(|x| vec![k(0.0) * x[0] + k(1.0) * x[1] - k(-1.0) * x[2] * k(0.0)]), [0; 4]);
    assert_eq!(counts(|x| vec![-(-x[0]), x[1] / k(1.0), k(0.0) / x[2], x[3] / x[3]]), [0; 4]);
}

#[test]
fn constants_are_lumped_into_one_factor() {
    assert_eq!(counts(|x| vec![k(2.0) * (x[0] * k(3.0)) / k(4.0)]), [0, 1, 0, 0]);
    assert_eq!(counts(|x| vec![k(2.0) * (k(3.0) * x[0]) + k(0.5) * x[0]]), [0, 1, 0, 0]);
    assert_eq!(traced(|x| vec![k(2.0) * (k(3.0) * x[0]) + k(0.5) * x[0]]).evaluate(&[&[2.0, 0.0, 0.0, 0.0]]), [13.0]);
}

#[test]
fn like_terms_of_a_long_sum_become_one() {
    assert_eq!(counts(|x| vec![k(2.0) * x[0] + x[1] + (x[2] - k(5.0) * x[0]) + k(3.0) * x[0]]), [1, 0, 0, 0]);
    assert_eq!(counts(|x| vec![(x[0] + x[1]) + (x[2] - x[0])]), [1, 0, 0, 0]);
    assert_eq!(counts(|x| vec![(k(1.0) + x[0]) + (x[1] + k(2.0))]), [2, 0, 0, 0]);
}

#[test]
fn a_sum_that_is_used_twice_is_not_taken_apart() {
    let both = counts(|x| {
        let shared = x[0] + x[1];
        vec![shared * x[2], shared + x[3]]
    });
    assert_eq!(both, [2, 1, 0, 0]);
}

#[test]
fn terms_that_are_only_roundoff_are_left_out() {
    assert_eq!(counts(|x| vec![k(0.1) * x[0] + k(0.2) * x[0] - k(0.3) * x[0]]), [0; 4]);
    assert_eq!(counts(|x| vec![k(0.1) * x[0] + x[1] + k(0.2) * x[0] - k(0.3) * x[0]]), [0; 4]);
}

#[test]
fn equal_values_are_computed_once_whatever_their_sign_and_order() {
    assert_eq!(counts(|x| vec![x[0] * x[1], -(x[1] * x[0]), (-x[0]) * x[1]]), [0, 1, 0, 0]);
    assert_eq!(counts(|x| vec![x[0] - x[1], x[1] - x[0], -x[0] + x[1]]), [1, 0, 0, 0]);
}

#[test]
fn common_factors_leave_a_sum() {
    assert_eq!(counts(|x| vec![x[0] * x[1] + x[2] + x[0] * x[3]]), [2, 1, 0, 0]);
    assert_eq!(counts(|x| vec![k(3.0) * x[1] - k(3.0) * x[2] + x[0] * x[1]]), [2, 2, 0, 0]);
    let values = traced(|x| vec![x[2] - x[0] * x[1] + x[0] * x[3], k(3.0) * x[1] - k(3.0) * x[2]]);
    assert_eq!(values.evaluate(&[&[2.0, 3.0, 5.0, 7.0]]), [13.0, -6.0]);
}

#[test]
fn products_that_are_used_twice_keep_their_factor() {
    let both = counts(|x| {
        let (first, second) = (x[0] * x[1], x[0] * x[2]);
        vec![first + second, first * x[3], second * x[3]]
    });
    assert_eq!(both, [1, 4, 0, 0]);
}

#[test]
fn a_product_is_never_multiplied_out() {
    assert_eq!(counts(|x| vec![x[0] * (x[1] + x[2]), k(2.0) * (x[1] + x[2])]), [1, 2, 0, 0]);
}

#[test]
fn an_angle_and_its_negative_share_one_sine_and_cosine() {
    let expressions = traced(|x| {
        let ((sin, cos), (minus_sin, same_cos)) = (x[0].sin_cos(), (-x[0]).sin_cos());
        vec![sin + minus_sin, cos - same_cos, sin * cos]
    });
    assert_eq!(expressions.count().trig, 1);
    assert_eq!(expressions.count().flops(), 1);
}

#[test]
fn what_no_output_needs_is_not_counted() {
    let dead = counts(|x| {
        let _ = (x[0] * x[1]).sin_cos().0 / x[2];
        vec![x[3]]
    });
    assert_eq!(dead, [0; 4]);
}

#[test]
fn tracing_and_simplifying_keep_the_value() {
    fn function<S: Scalar>(x: &[S]) -> Vec<S> {
        let k = S::from_f64;
        let (sin, cos) = (x[0] + k(0.3)).sin_cos();
        let sum = k(2.0) * sin - x[1] * (cos - k(0.5)) + k(0.25) * sin;
        vec![sum / (x[2] + k(3.0)), -(sum * sum), (sum * sum + k(1.0)).sqrt() - sum, k(7.0)]
    }
    let expressions = traced(|x| function(x));
    for seed in 0..100 {
        let x: Vec<f64> = (0..4).map(|i| f64::from(seed * 4 + i).sin()).collect();
        for (found, expected) in expressions.evaluate(&[&x]).iter().zip(function(&x)) {
            assert!((found - expected).abs() <= 1e-14 * (1.0 + expected.abs()), "{found} {expected}");
        }
    }
}
