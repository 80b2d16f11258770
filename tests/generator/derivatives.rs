//! A recursion over dual numbers of symbols traces its derivatives, with the steps and the names of the recursion
//! itself.

use redysim::Real;
use redysim_codegen::expressions::Expressions;
use redysim_codegen::graph::Name;
use redysim_codegen::symbol::{Symbol, Tracer};
use redysim_model::denoc::{Untraced, evaluate};
use redysim_model::{Function, Model, Tree};
use redysim_runtime::Dual;
use std::collections::BTreeSet;

const ROBOTS: [&str; 5] = ["kr5_drives", "test/springs", "gripper", "test/gantry", "test/frames"];

fn tree(name: &str) -> Tree {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Tree::new(&Model::load(path).expect("a valid model").model)
}

/// The lengths of the arguments of a function.
fn lengths(function: Function, tree: &Tree) -> Vec<usize> {
    function.signature().arguments.iter().map(|argument| tree.argument_length(*argument)).collect()
}

/// Values, then slopes.
fn parts<S: Copy>(duals: &[Dual<S>]) -> Vec<S> {
    duals.iter().map(|dual| dual.value).chain(duals.iter().map(|dual| dual.slope)).collect()
}

fn slices<T>(vectors: &[Vec<T>]) -> Vec<&[T]> {
    vectors.iter().map(Vec::as_slice).collect()
}

/// The arguments of a function, each with its direction. In `numbers` the directions follow the arguments.
fn duals<S: Copy>(numbers: &[Vec<S>]) -> Vec<Vec<Dual<S>>> {
    let (values, slopes) = numbers.split_at(numbers.len() / 2);
    let dual = |(&value, &slope): (&S, &S)| Dual { value, slope };
    values.iter().zip(slopes).map(|(values, slopes)| values.iter().zip(slopes).map(dual).collect()).collect()
}

/// The expressions of `computed`, a function of vectors of the given lengths.
fn traced_of(
    lengths: &[usize],
    computed: impl for<'g> Fn(&'g Tracer, &[Vec<Symbol<'g>>]) -> Vec<Symbol<'g>>,
) -> Expressions {
    let tracer = Tracer::default();
    let outputs = {
        let arguments: Vec<Vec<Symbol>> =
            (0..).zip(lengths).map(|(index, &length)| tracer.argument(index, length)).collect();
        tracer.edges(&computed(&tracer, &arguments))
    };
    Expressions { graph: tracer.into_graph(), outputs }
}

fn traced(function: Function, tree: &Tree) -> Expressions {
    traced_of(&lengths(function, tree), |tracer, x| evaluate(function, tree, tracer, &slices(x)))
}

/// The function and its derivative along a direction.
fn traced_with_derivative(function: Function, tree: &Tree) -> Expressions {
    traced_of(&lengths(function, tree).repeat(2), |tracer, x| {
        parts(&evaluate(function, tree, tracer, &slices(&duals(x))))
    })
}

/// Arguments and direction in general position.
fn arguments(lengths: &[usize], point: usize) -> Vec<Vec<f64>> {
    let both = lengths.iter().chain(lengths).enumerate();
    let element = |argument: usize, i: usize| (1.7 * point as f64 + 0.9 * argument as f64 + 2.3 * i as f64).sin();
    both.map(|(argument, &length)| (0..length).map(|i| element(argument, i)).collect()).collect()
}

/// Bodies move through about a hundred operations each, whose roundoff stays below 1e-12 of the largest output.
#[test]
fn traced_derivatives_are_those_of_dual_numbers() {
    for robot in ROBOTS {
        let tree = tree(robot);
        let has =
            |function: &&Function| !function.needs_loops() && (!function.needs_frames() || !tree.frames.is_empty());
        let depends_on_motion = |function: &&Function| !function.signature().arguments.is_empty();
        // Without drives and springs, nothing acts in the joints or between points.
        let acts = |function: &&Function| {
            ["kr5_drives", "test/springs"].contains(&robot)
                || !matches!(function, Function::PassiveForces | Function::DissipatedPower)
        };
        let functions = Function::ALL.iter().filter(acts).filter(has).filter(depends_on_motion);
        for &function in functions {
            let (expressions, lengths) = (traced_with_derivative(function, &tree), lengths(function, &tree));
            for point in 0..3 {
                let numbers = arguments(&lengths, point);
                let expected = parts(&evaluate(function, &tree, &Untraced, &slices(&duals(&numbers))));
                let found = expressions.evaluate(&slices(&numbers));
                assert_eq!(found.len(), expected.len());
                for half in [0..expected.len() / 2, expected.len() / 2..expected.len()] {
                    let scale = expected[half.clone()].iter().fold(0.0_f64, |most, x| Real::maximum(most, x.abs()));
                    assert!(scale > 0.0, "{robot} {function}: all zero");
                    for i in half {
                        let (found, expected) = (found[i], expected[i]);
                        let close = (found - expected).abs() <= 1e-12 * scale;
                        assert!(close, "{robot} {function}, output {i}: {found} instead of {expected}");
                    }
                }
            }
        }
    }
}

/// The steps in which nodes arise.
fn steps(expressions: &Expressions) -> BTreeSet<(&'static str, usize)> {
    let graph = &expressions.graph;
    (0..graph.len()).filter_map(|node| graph.step(node)).map(|step| (step.sweep, step.body)).collect()
}

/// The names of values that are differentiated `order` times.
fn names(expressions: &Expressions, order: u8) -> BTreeSet<(&'static str, usize, &'static str)> {
    let graph = &expressions.graph;
    let names = (0..graph.len()).filter_map(|node| graph.name(node)).filter(|name| name.order == order);
    names.map(|Name { quantity, body, component, .. }| (quantity, body, component)).collect()
}

#[test]
fn a_traced_derivative_has_the_sweeps_and_the_names_of_the_recursion() {
    for robot in ROBOTS {
        let tree = tree(robot);
        for function in [Function::InverseDynamics, Function::ForwardDynamics] {
            let (plain, with_derivative) = (traced(function, &tree), traced_with_derivative(function, &tree));
            assert_eq!(steps(&with_derivative), steps(&plain), "{robot} {function}");
            let sweeps: BTreeSet<&str> = steps(&plain).into_iter().map(|(sweep, _)| sweep).collect();
            assert!(sweeps.len() >= 2, "{robot} {function}: {sweeps:?}");
            let (values, slopes) = (names(&with_derivative, 0), names(&with_derivative, 1));
            assert_eq!(values, names(&plain, 0), "{robot} {function}");
            assert!(slopes.is_subset(&values) && !slopes.is_empty(), "{robot} {function}: {slopes:?}");
            assert!(names(&with_derivative, 2).is_empty());
        }
    }
}
