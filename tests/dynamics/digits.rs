//! What a description of a robot, and a way to compute, lose of the digits that the model's own description and the
//! recursions have: on random trees of many styles, at states that the generator has not seen.

use crate::common::chains::{self, Rod};
use crate::common::random::Random;
use crate::common::styles::Style;
use redysim::Real;
use redysim_codegen::accuracy::{MEASURED, Reference};
use redysim_codegen::functions::{MethodChoice, MethodFigures, TracedFunction, trace_of};
use redysim_codegen::passes::Passes;
use redysim_model::denoc::Method;
use redysim_model::{AccelerationMethod, CodegenOptions, Function, Functions, Model, Tree};

/// Of each style. Unoptimised, a tree takes a second.
const TREES: u64 = if cfg!(debug_assertions) { 1 } else { 20 };
/// A loss smaller than this is a few roundings.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

fn traced(tree: &Tree, passes: &Passes, forward_dynamics: AccelerationMethod) -> Vec<TracedFunction> {
    let functions = Functions::of(MEASURED);
    trace_of(tree, &CodegenOptions { functions, forward_dynamics, ..CodegenOptions::default() }, passes)
        .expect("no pass changes a value")
}

/// The expressions of one function among `functions`.
fn computed(functions: &[TracedFunction], function: Function) -> &TracedFunction {
    functions.iter().find(|traced| traced.function == function).expect("it is traced")
}

/// The largest loss at states that the generator has not seen.
fn lost(references: &[Reference], functions: &[TracedFunction], function: Function) -> f64 {
    let traced = computed(functions, function);
    let losses = references.iter().map(|reference| reference.loss_by(function, |x| traced.expressions.evaluate(x)));
    losses.fold(0.0, Real::maximum)
}

fn unseen_states(tree: &Tree) -> [Reference<'_>; 4] {
    [1, 2, 3, 4].map(|seed| Reference::at(tree, seed))
}

fn random_trees(style: Style) -> impl Iterator<Item = Tree> {
    (0..TREES).map(move |seed| Tree::new(&style.model(&mut Random::new(seed), 12)))
}

/// All passes, and each one off, against none of them, on numbers as they are or rounded otherwise.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn no_pass_costs_forces_or_the_mass_matrix_a_factor_of_four() {
    let switched_off: [fn(&mut Passes); 7] = [
        |_| {},
        |passes| passes.frames = false,
        |passes| passes.base_parameters = false,
        |passes| passes.axis_masses = false,
        |passes| passes.parallel_axes = false,
        |passes| passes.units = false,
        |passes| (passes.sums, passes.factors) = (false, false),
    ];
    for style in Style::ALL {
        let mut worst = 0.0_f64;
        for (index, tree) in random_trees(style).enumerate() {
            let states = unseen_states(&tree);
            let none = traced(&tree, &Passes::none(), AccelerationMethod::Recursion);
            // All passes on every tree, and in turn one of them off.
            for switch in [switched_off[0], switched_off[1 + index % 6]] {
                let mut passes = Passes::all();
                switch(&mut passes);
                let all = traced(&tree, &passes, AccelerationMethod::Recursion);
                for function in MEASURED.into_iter().filter(|&function| function != Function::ForwardDynamics) {
                    let least = states.iter().map(|states| states.least_loss(function)).fold(0.0, Real::maximum);
                    let (least, now) = (lost(&states, &none, function).max(least), lost(&states, &all, function));
                    let factor = now / least.max(ROUNDINGS);
                    assert!(factor <= 4.0, "{style:?} {index}, {function:?}: {now:.1e} instead of {least:.1e}");
                    worst = Real::maximum(worst, factor);
                }
            }
        }
        println!("{style:?}: a factor of {worst:.1}");
    }
}

/// Of accelerations the largest error has a wide spread itself: it belongs to the one state whose mass matrix has the
/// worst condition. So the typical tree keeps the factor of four, and none loses a digit more than that.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn passes_cost_accelerations_by_the_recursion_a_factor_of_four_in_nine_of_ten_trees_and_of_20_at_most() {
    for style in Style::ALL {
        let mut factors: Vec<f64> = random_trees(style)
            .map(|tree| {
                let states = unseen_states(&tree);
                let [none, all] = [Passes::none(), Passes::all()].map(|passes| {
                    lost(&states, &traced(&tree, &passes, AccelerationMethod::Recursion), Function::ForwardDynamics)
                });
                all / none.max(1e-14)
            })
            .collect();
        factors.sort_by(f64::total_cmp);
        let (typical, worst) = (factors[factors.len() * 9 / 10], factors[factors.len() - 1]);
        println!("{style:?}: nine of ten within a factor of {typical:.1}, all within {worst:.1}");
        assert!(typical <= 4.0 && worst <= 20.0, "{style:?}: {typical}, {worst}");
    }
}

/// The largest losses of accelerations, for each kind of motion, at states that the generator has not seen.
fn losses(references: &[Reference], functions: &[TracedFunction]) -> [f64; 3] {
    let function = computed(functions, Function::ForwardDynamics);
    let of = |reference: &Reference| {
        reference.losses_by(Function::ForwardDynamics, |arguments| function.expressions.evaluate(arguments))
    };
    references.iter().map(of).fold([0.0_f64; 3], |a, b| std::array::from_fn(|kind| a[kind].max(b[kind])))
}

/// Asserts what the generator promises, with half a digit for the states that it has not seen.
fn assert_kept(what: &str, losses: [f64; 3], of_recursion: [f64; 3]) {
    let kept = losses.iter().zip(of_recursion).all(|(&lost, least)| lost <= (30.0 * least).max(3e-13));
    assert!(kept, "{what}: {losses:.1?} where the recursion loses {of_recursion:.1?}");
}

#[test]
fn compiled_forward_dynamics_keeps_what_the_recursion_keeps() {
    for style in Style::ALL {
        for (index, tree) in random_trees(style).enumerate() {
            let states = unseen_states(&tree);
            let chosen = traced(&tree, &Passes::all(), AccelerationMethod::Auto);
            let recursion = traced(&tree, &Passes::none(), AccelerationMethod::Recursion);
            let [now, least] = [&chosen, &recursion].map(|functions| losses(&states, functions));
            assert_kept(&format!("{style:?} {index}"), now, least);
        }
    }
}

/// Either takes fewer operations by the explicit mass matrix, which loses digits that the recursion keeps.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_heavy_tip_and_a_palm_with_fingers_keep_the_digits_of_the_recursion() {
    let tip = |index| if index == 5 { 1e6 } else { 1.0 };
    let heavy_tip = chains::chain(6, |index| Rod { axis: chains::oblique(index), mass: tip(index), length: 0.5 });
    for (name, tree) in [("a chain of six with a heavy tip", heavy_tip), ("a palm", chains::palm(5, 8))] {
        let states = unseen_states(&tree);
        let ways = [AccelerationMethod::Auto, AccelerationMethod::Recursion, AccelerationMethod::Factorisation];
        let ways = ways.map(|method| traced(&tree, &Passes::all(), method));
        let [chosen, recursion, factorisation] = ways.each_ref().map(|way| losses(&states, way));
        println!("{name}: {chosen:?}, recursion {recursion:?}, factorisation {factorisation:?}; {}", choice(&ways[0]));
        assert_kept(name, chosen, recursion);
    }
}

fn choice(functions: &[TracedFunction]) -> MethodChoice {
    computed(functions, Function::ForwardDynamics).method.expect("forward dynamics states its method")
}

fn model(name: &str) -> Model {
    Model::load(format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).expect("a good model").model
}

#[test]
fn kr5_and_the_gripper_are_computed_by_the_factorisation() {
    for name in ["kr5", "gripper", "peers/kr5", "peers/gripper"] {
        let tree = Tree::new(&model(name));
        let functions = traced(&tree, &Passes::all(), AccelerationMethod::Auto);
        assert_eq!(choice(&functions).used.method, Method::Factorisation, "{name}");
    }
}

#[test]
fn the_key_forward_dynamics_decides_and_the_documentation_states_both_ways() {
    let tree = Tree::new(&model("kr5"));
    let of = |method| traced(&tree, &Passes::all(), method);
    let (recursion, factorisation) = (of(AccelerationMethod::Recursion), of(AccelerationMethod::Factorisation));
    let flops =
        |functions: &[TracedFunction]| computed(functions, Function::ForwardDynamics).expressions.count().flops();
    let expected = [(Method::Recursion, flops(&recursion)), (Method::Factorisation, flops(&factorisation))];
    for (functions, [used, other]) in [(&recursion, expected), (&factorisation, [expected[1], expected[0]])] {
        let choice = choice(functions);
        let figures = |figures: MethodFigures| (figures.method, figures.flops);
        assert_eq!((figures(choice.used), choice.other.map(figures)), (used, Some(other)));
        let documentation = choice.to_string();
        for (_, flops) in expected {
            assert!(documentation.contains(&flops.to_string()), "{documentation}");
        }
    }
}
