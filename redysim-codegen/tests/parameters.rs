//! Inertias that are inputs of a function instead of constants: the same recursions and passes over trees.

use redysim_codegen::expressions::Expressions;
use redysim_codegen::passes::{Passes, simplified};
use redysim_codegen::symbol::{Symbol, Tracer};
use redysim_model::denoc::evaluate;
use redysim_model::joint::Vanishing;
use redysim_model::parameter::ParameterIn;
use redysim_model::pseudo::PseudoInertia;
use redysim_model::regroup::base_parameters;
use redysim_model::{Function, Model, Tree};

/// The arguments of a function of KR5, and the ten numbers of its last body.
const ARGUMENTS: [[f64; 6]; 3] =
    [[0.3, -0.7, 1.1, 0.4, -0.2, 0.9], [1.2, -0.5, 0.8, 2.0, -1.4, 0.6], [0.9, 1.7, -2.2, 0.3, 1.5, -0.8]];

fn kr5() -> Tree {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/peers/kr5.toml");
    let tree = Tree::new(&Model::load(path).expect("a valid model").model);
    base_parameters(&tree, Vanishing::SecondMomentZz)
}

/// A function of three arguments on KR5, of which `payload` is the inertia of the last body.
fn traced(function: Function, payload: impl for<'g> Fn(&'g Tracer) -> PseudoInertia<Symbol<'g>>) -> Expressions {
    let tracer = Tracer::default();
    let outputs = {
        let mut tree = kr5().map(|value| value.value());
        tree.bodies.last_mut().expect("six bodies").inertia = payload(&tracer);
        let tree = base_parameters(&tree, Vanishing::SecondMomentZz);
        let arguments = [0, 1, 2].map(|argument| tracer.argument(argument, 6));
        let arguments: Vec<&[Symbol]> = arguments.iter().map(Vec::as_slice).collect();
        let used = function.signature().arguments.len();
        tracer.edges(&evaluate(function, &tree, &tracer, &arguments[..used]))
    };
    simplified(Expressions { graph: tracer.into_graph(), outputs }, &Passes::default()).expect("passes keep values")
}

/// The inertia of ten numbers.
fn inertia<S: Copy>(numbers: &[S]) -> PseudoInertia<S> {
    let [mass, x, y, z, xx, yy, zz, xy, yz, xz] = *numbers else { panic!("an inertia has ten numbers") };
    let second = redysim_model::inertia::Sym3 { xx, yy, zz, xy, yz, xz };
    PseudoInertia { mass, moment: redysim_model::spatial::Vec3([x, y, z]), second }
}

const PAYLOAD: [f64; 10] = [5.0, 0.2, -0.1, 0.9, 0.11, 0.13, 0.27, 0.01, -0.02, 0.03];

#[test]
fn an_inertia_as_an_argument_has_the_values_of_the_same_inertia_as_a_constant() {
    for function in [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix, Function::Energy] {
        let constant = traced(function, |_| inertia(&PAYLOAD).map(|value| value.value()));
        let argument = traced(function, |tracer| inertia(&tracer.argument(3, 10)));
        let arguments: Vec<&[f64]> = ARGUMENTS.iter().map(|x| x.as_slice()).chain([PAYLOAD.as_slice()]).collect();
        let [constant, argument] = [constant, argument].map(|expressions| expressions.evaluate(&arguments));
        let largest = constant.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
        for (constant, argument) in constant.iter().zip(&argument) {
            assert!((constant - argument).abs() < 1e-12 * largest, "{function:?}: {argument} instead of {constant}");
        }
    }
}

/// Of a call that regroups the inertia by itself. The counts are exact and may fall.
#[test]
fn an_inertia_as_an_argument_costs_no_more_operations_than_recorded() {
    for (function, most) in [(Function::InverseDynamics, 408), (Function::MassMatrix, 269)] {
        let argument = traced(function, |tracer| inertia(&tracer.argument(3, 10)));
        let flops = argument.count().flops();
        assert!(flops <= most, "{function:?}: {flops} operations instead of {most}");
    }
}
