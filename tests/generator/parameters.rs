//! Run-time parameters: what they cost, and that a robot with parameters is the robot with these numbers.

use redysim::Real;
use redysim_codegen::functions::{ParametricFunctions, trace_with_parameters};
use redysim_codegen::passes::Passes;
use redysim_model::denoc::{Untraced, evaluate};
use redysim_model::{Function, Inertia, Loaded, Model, Tree};
use redysim_runtime::function::Argument;

fn load(model: &str, parameters: &[&str]) -> Loaded {
    let path = format!("{}/models/{model}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::load_with(path, model, format!("parameters = {parameters:?}")).unwrap_or_else(|faults| panic!("{faults}"))
}

fn made(model: &Model, loaded: &Loaded, passes: &Passes) -> ParametricFunctions {
    trace_with_parameters(model, &loaded.options, passes).expect("sound passes")
}

/// Operations of inverse dynamics, forward dynamics and the mass matrix.
fn flops(made: &ParametricFunctions) -> [u32; 3] {
    [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix].map(|wanted| {
        let found = made.functions.iter().find(|function| function.function == wanted).expect("every function");
        found.expressions.count().flops()
    })
}

fn flops_of_kr5(parameters: &[&str]) -> [u32; 3] {
    let loaded = load("peers/kr5", parameters);
    flops(&made(&loaded.model, &loaded, &Passes::all()))
}

const PAYLOAD: [&str; 3] = ["link6.mass", "link6.com", "link6.inertia"];

#[test]
fn an_inertia_that_is_given_costs_a_call_what_constants_without_zeros_cost() {
    let none = load("peers/kr5", &[]);
    let mut general = none.model.clone();
    let tool = general.links.last_mut().expect("six links");
    (tool.mass, tool.com.0) = (3.1, [0.031, -0.042, 0.123]);
    tool.inertia = Inertia { xx: 0.021, yy: 0.025, zz: 0.018, xy: 0.0021, yz: -0.0017, xz: 0.0013 };
    let constants = flops(&made(&general, &none, &Passes::all()));
    let given = flops_of_kr5(&PAYLOAD);
    assert_eq!((constants, given), ([336, 657, 211], [339, 655, 214]));
    let readme = include_str!("../../README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let in_words = |[inverse, forward, matrix]: [u32; 3]| format!("{inverse}, {forward} and {matrix}");
    let sentence = format!(
        "cost a call {} operations (inverse dynamics, forward dynamics, mass matrix), about what any constants without zeros cost \
         there ({})",
        in_words(given),
        in_words(constants)
    );
    assert!(readme.contains(&sentence), "README.md lacks: {sentence}");
}

#[test]
fn gravity_and_rotors_that_are_given_cost_a_call_few_operations() {
    let constants = flops_of_kr5(&[]);
    let more = |parameters: &[&str]| {
        let found = flops_of_kr5(parameters);
        [0, 1, 2].map(|i| found[i] - constants[i])
    };
    let armatures = ["link1", "link2", "link3", "link4", "link5", "link6"].map(|joint| format!("{joint}.armature"));
    assert_eq!(constants, [282, 538, 157]);
    assert_eq!(more(&["gravity"]), [12, 12, 0]);
    assert_eq!(more(&armatures.each_ref().map(String::as_str)), [8, 10, 3]);
}

/// A number within ±1 that depends on nothing but `seed`.
fn share(seed: usize) -> f64 {
    2.0 * (0.618_033_988_749_895 * (seed + 1) as f64).fract() - 1.0
}

/// Parameters: all of some links and joints, and gravity.
const ROBOTS: [(&str, &[&str]); 8] = [
    ("peers/kr5", &PAYLOAD),
    (
        "kr5_drives",
        &[
            "gravity",
            "link3.mass",
            "link5.com",
            "link1.inertia",
            "link1.armature",
            "link2.damping",
            "link3.friction",
            "link3.friction_velocity",
            "link4.stiffness",
            "link4.rest",
        ],
    ),
    ("gripper", &["link1.mass", "link3.com", "link4.inertia", "gravity", "link2.damping"]),
    ("fourbar", &["gravity", "crank.mass", "coupler.mass", "coupler.com"]),
    ("peers/chain40", &["gravity", "link20.mass", "link20.damping"]),
    // On joints in series, under a free base and on a quaternion.
    (
        "test/joints_in_series",
        &["gravity", "sleeve.mass", "wrist.com", "probe.inertia", "carriage.mass", "swivel.com", "wrist.damping"],
    ),
    (
        "floating_three_link",
        &["gravity", "satellite.mass", "satellite.com", "link3.inertia", "link2.mass", "joint1.damping"],
    ),
    ("spherical_pendulum", &["gravity", "bob.mass", "bob.com", "pivot.armature"]),
];

#[test]
fn a_robot_with_parameters_is_the_robot_with_these_numbers() {
    for (name, parameters) in ROBOTS.into_iter().step_by(if cfg!(debug_assertions) { 2 } else { 1 }) {
        let loaded = load(name, parameters);
        let nominal: Vec<f64> =
            loaded.options.parameters.iter().flat_map(|parameter| parameter.values(&loaded.model)).collect();
        for passes in [Passes::all(), Passes::none()].into_iter().take(if cfg!(debug_assertions) { 1 } else { 2 }) {
            let ParametricFunctions { functions, lumped } = made(&loaded.model, &loaded, &passes);
            for seed in 0..if cfg!(debug_assertions) { 1 } else { 4 } {
                // Positive, for masses, friction and its velocity; vectors and tensors may be any.
                let values: Vec<f64> = nominal
                    .iter()
                    .enumerate()
                    .map(|(i, x)| x * (1.0 + 0.5 * share(seed + i)) + 0.1 * (seed as f64))
                    .collect();
                let given = lumped.evaluate_with::<f64>(&[], |index, _| values[index as usize]);
                let robot = Tree::with_parameters(&loaded.model, &loaded.options.parameters, &values);
                for traced in &functions {
                    let function = traced.function;
                    let argument = |(position, argument): (usize, &Argument)| {
                        let length = robot.argument_length(*argument);
                        (0..length).map(|i| 3.0 * share(97 * seed + 31 * position + i)).collect::<Vec<f64>>()
                    };
                    let arguments: Vec<Vec<f64>> =
                        function.signature().arguments.iter().enumerate().map(argument).collect();
                    let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
                    let found = traced.expressions.evaluate_with(&arguments, |index, _| given[index as usize]);
                    let expected = evaluate(function, &robot, &Untraced, &arguments);
                    assert_eq!(found.len(), expected.len());
                    let largest = expected.iter().fold(1e-3_f64, |largest, x| Real::maximum(largest, x.abs()));
                    for (found, expected) in found.iter().zip(&expected) {
                        let error = (found - expected).abs() / largest;
                        assert!(error < 1e-12, "{name}, {function:?}: {found} instead of {expected}");
                    }
                }
            }
        }
    }
}
