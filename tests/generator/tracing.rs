//! Traced operations have the value of the operations, whatever signs move to the edges of the graph.

use redysim_codegen::expressions::Expressions;
use redysim_codegen::symbol::{Symbol, Tracer};
use redysim_runtime::Scalar;

/// The expressions of a function of two numbers.
fn traced(function: impl for<'g> Fn(Symbol<'g>, Symbol<'g>) -> Vec<Symbol<'g>>) -> Expressions {
    let tracer = Tracer::default();
    let outputs = {
        let arguments = tracer.argument(0, 2);
        tracer.edges(&function(arguments[0], arguments[1]))
    };
    Expressions { graph: tracer.into_graph(), outputs }
}

/// Compares a function with its trace at points of all signs.
macro_rules! assert_traced {
    ($function:ident) => {
        let expressions = traced(|x, y| $function(x, y));
        for (x, y) in [(0.3, 0.7), (-0.4, 1.9), (2.5, -0.6), (-1.2, -3.4)] {
            let (found, expected) = (expressions.evaluate(&[&[x, y]]), $function(x, y));
            for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
                let close = f64::abs(found - expected) <= 1e-14 * f64::abs(*expected).max(1.0);
                assert!(close, "{} {index} at {x}, {y}: {found}, not {expected}", stringify!($function));
            }
        }
    };
}

fn k<S: Scalar>(value: f64) -> S {
    S::from_f64(value)
}

#[test]
fn sums_and_products_of_all_signs() {
    fn signs<S: Scalar>(x: S, y: S) -> Vec<S> {
        let mut sum = x;
        sum += y;
        sum -= -x;
        vec![x + y, x - y, -x + y, -x - y, (x - y) - (y - x), (y - x) * (x - y), -x * -y, x * -y, sum]
    }
    assert_traced!(signs);
}

#[test]
fn quotients_of_all_signs() {
    fn quotients<S: Scalar>(x: S, y: S) -> Vec<S> {
        vec![x / y, -x / y, x / -y, -x / -y, x / x, -x / x, x / k(-4.0), k::<S>(3.0) / y, k::<S>(0.0) / y]
    }
    assert_traced!(quotients);
}

#[test]
fn sine_is_odd_and_cosine_even() {
    fn angles<S: Scalar>(x: S, y: S) -> Vec<S> {
        let angles = [x, -x, x - y, y - x, k(0.5), k(-0.5), x + k(1.0)];
        angles.into_iter().flat_map(|angle| [angle.sin_cos().0, angle.sin_cos().1]).collect()
    }
    assert_traced!(angles);
}

#[test]
fn roots_keep_their_values() {
    fn roots<S: Scalar>(x: S, y: S) -> Vec<S> {
        vec![(x * x).sqrt(), (x * x + y * y).sqrt(), ((x - y) * (x - y)).sqrt(), k::<S>(2.0).sqrt()]
    }
    assert_traced!(roots);
}
