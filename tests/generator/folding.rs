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
fn constants_are_lumped_into_one_term_also_of_a_sum_that_is_used_twice() {
    assert_eq!(counts(|x| vec![k(2.0) - (k(3.0) - (x[0] + k(1.0)))]), [0; 4]);
    assert_eq!(counts(|x| vec![(x[0] + k(0.1)) + k(0.2) - k(0.3)]), [0; 4]);
    fn offsets<'g>(x: &[Symbol<'g>]) -> [Symbol<'g>; 2] {
        let shared = k(3.0) - x[0] * x[1];
        [shared + k(1.0), k(2.0) - shared]
    }
    assert_eq!(counts(|x| offsets(x).into_iter().map(|offset| x[2] * offset).collect()), [2, 3, 0, 0]);
    assert_eq!(traced(|x| offsets(x).to_vec()).evaluate(&[&[2.0, 5.0, 0.0, 0.0]]), [-6.0, 9.0]);
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

#[test]
fn the_sine_of_a_sum_of_angles_whose_sines_are_there_takes_no_pair_of_its_own() {
    fn sum<'g>(x: &[Symbol<'g>], sign: f64) -> Vec<Symbol<'g>> {
        let [(sin_a, cos_a), (sin_b, cos_b)] = [x[0].sin_cos(), x[1].sin_cos()];
        let (sin, cos) = (x[0] + k(sign) * x[1]).sin_cos();
        [sin_a, cos_a, sin_b, cos_b, sin, cos].map(|x| x * k(2.0)).to_vec()
    }
    for sign in [1.0, -1.0] {
        let tracer = Tracer::default();
        let outputs = tracer.edges(&sum(&tracer.argument(0, 4), sign));
        let traced = Expressions { graph: tracer.into_graph(), outputs };
        let found = passes::simplified(traced, &Passes::default()).expect("no pass changes a value");
        assert_eq!((found.count().trig, found.count().flops()), (2, 6 + 6));
        for (a, b) in [(0.3, 0.5), (-2.0, 1.1), (3.0, -0.4)] {
            let values = found.evaluate(&[&[a, b, 0.0, 0.0]]);
            let (sin, cos) = (a + sign * b).sin_cos();
            assert!((values[4] - 2.0 * sin).abs() < 1e-15 && (values[5] - 2.0 * cos).abs() < 1e-15, "{values:?}");
        }
    }
    // Of an angle that is there only in the sum, the pair is.
    assert_eq!(counts(|x| vec![x[0].sin_cos().0, (x[0] + x[1]).sin_cos().1]), [1, 0, 0, 2]);
}

#[test]
fn sums_and_differences_of_two_values_are_taken_apart_where_that_saves_an_addition() {
    fn both<'g>(x: &[Symbol<'g>]) -> Symbol<'g> {
        let (sum, difference) = (x[0] + x[1], x[0] - x[1]);
        k(3.0) * sum + k(5.0) * difference + x[2]
    }
    // 8 x₀ − 2 x₁ + x₂.
    assert_eq!(counts(|x| vec![both(x)]), [2, 2, 0, 0]);
    assert_eq!(counts(|x| vec![both(x), x[3] * (x[0] - x[1])]), [3, 3, 0, 0]);
    assert_eq!(traced(|x| vec![both(x)]).evaluate(&[&[2.0, 7.0, 1.0, 0.0]]), [3.0]);
    // Where both are there anyway, nothing is saved.
    assert_eq!(counts(|x| vec![both(x), x[3] * (x[0] - x[1]), x[3] / (x[0] + x[1])]), [4, 3, 1, 0]);
}

#[test]
fn a_constant_is_multiplied_once_by_what_several_products_have_beside_it() {
    assert_eq!(counts(|x| vec![k(2.0) * (x[0] * x[1]), k(2.0) * (x[0] * x[2]) + x[3]]), [1, 3, 0, 0]);
    assert_eq!(counts(|x| vec![k(2.0) * x[0], k(2.0) * (x[0] * x[2]) + x[3]]), [1, 2, 0, 0]);
    assert_eq!(counts(|x| vec![k(2.0) * (x[0] * x[1]), k(3.0) * (x[0] * x[2]) + x[3]]), [1, 4, 0, 0]);
    let values = traced(|x| vec![k(2.0) * (x[0] * x[1]), k(-2.0) * (x[2] * x[0])]).evaluate(&[&[3.0, 5.0, 7.0, 0.0]]);
    assert_eq!(values, [30.0, -42.0]);
}

/// x′ = c x + s y and y′ = c y − s x, with the sums that give y′² + u.
fn rotated<S: Scalar>(x: &[S]) -> Vec<S> {
    let [x, y, u, angle] = [x[0], x[1], x[2], x[3]];
    let (s, c) = angle.sin_cos();
    let (turned_x, turned_y) = (c * x + s * y, c * y - s * x);
    let [square_x, square_y] = [turned_x * turned_x, turned_y * turned_y];
    vec![x * x + y * y, u - square_x, square_y + u, S::from_f64(-2.0) * square_x + turned_y]
}

#[test]
fn the_square_of_a_rotated_component_comes_from_sums_that_the_rotation_keeps() {
    let plain = Passes { rotations: false, ..Passes::default() };
    let with = |passes: &Passes, outputs: &[usize], change: fn(Symbol) -> Symbol| {
        let tracer = Tracer::default();
        let made = rotated(&tracer.argument(0, 4));
        let outputs = tracer.edges(&outputs.iter().map(|&output| change(made[output])).collect::<Vec<_>>());
        let traced = Expressions { graph: tracer.into_graph(), outputs };
        passes::simplified(traced, passes).expect("no pass changes a value")
    };
    let flops = |passes: &Passes, outputs: &[usize], change| with(passes, outputs, change).count().flops();
    for change in [|value| value, |value: Symbol| -value] as [fn(Symbol) -> Symbol; 2] {
        // y′² is not computed: a multiplication less.
        assert_eq!(flops(&Passes::default(), &[0, 1, 2, 3], change) + 1, flops(&plain, &[0, 1, 2, 3], change));
        // Where one of the two sums is not there, nothing is saved.
        for outputs in [&[0, 2, 3], &[1, 2, 3]] {
            assert_eq!(flops(&Passes::default(), outputs, change), flops(&plain, outputs, change));
        }
    }
    for state in [[0.3, -0.7, 1.9, 0.4], [-2.0, 0.1, -0.5, 2.8], [1.0, 1.0, 0.0, -1.2]] {
        let found: Vec<f64> = with(&Passes::default(), &[0, 1, 2, 3], |value| value).evaluate(&[&state]);
        for (found, expected) in found.iter().zip(rotated(&state)) {
            assert!((found - expected).abs() <= 1e-14, "{found} {expected}");
        }
    }
}
