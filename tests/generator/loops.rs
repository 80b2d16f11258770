//! Where a long function does the same on many bodies, its code is a loop.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use redysim_codegen::passes::Passes;
use redysim_codegen::{Generated, implementation_with};
use redysim_model::{CodegenOptions, Function, Functions, Model};

/// The code of a model, without spaces, function by function: name and body. Those that every mechanism has are methods
/// of a trait, and left out.
fn functions(model: &Model, passes: &Passes) -> Vec<(String, String)> {
    chosen_functions(model, &CodegenOptions::default(), passes)
}

/// Those of them that the options choose.
fn chosen_functions(model: &Model, options: &CodegenOptions, passes: &Passes) -> Vec<(String, String)> {
    let Generated { tokens, operations, .. } =
        implementation_with(model, &format_ident!("Robot"), &quote!(redysim_runtime), options, passes)
            .expect("no pass changes a value");
    let text = without_spaces(tokens.impls);
    let start = |name: &str| {
        text.find(&format!("pubfn{name}_with_trig<")).expect("every function takes joint trigonometry, too")
    };
    let body = |name: &str| text[start(name)..].split("pubfn").nth(1).unwrap_or_default().to_string();
    let own = operations.into_iter().filter(|(function, _)| !function.is_always_present());
    own.map(|(function, _)| (function.to_string(), body(function.name()))).collect()
}

fn without_spaces(tokens: TokenStream) -> String {
    tokens.to_string().split_whitespace().collect()
}

fn shipped(name: &str) -> Model {
    Model::load(format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap().model
}

/// Names of the functions that have loops.
fn with_loops(model: &Model, passes: &Passes) -> Vec<String> {
    let functions = functions(model, passes).into_iter();
    functions.filter(|(_, body)| body.contains("forgroupin")).map(|(name, _)| name).collect()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_long_functions_of_a_chain_have_loops() {
    let expected = ["inverse_dynamics", "forward_dynamics", "bias_forces"];
    assert_eq!(with_loops(&shipped("peers/chain40"), &Passes::all()), expected);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn without_the_pass_nothing_is_a_loop() {
    let passes = Passes { loops: false, ..Passes::all() };
    assert!(with_loops(&shipped("peers/chain40"), &passes).is_empty());
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn short_functions_and_robots_without_uniform_links_are_unrolled() {
    for name in ["kr5", "gripper", "peers/humanoid30"] {
        assert!(with_loops(&shipped(name), &Passes::all()).is_empty(), "{name}");
    }
}

#[test]
fn inverse_dynamics_of_a_chain_twice_as_long_has_at_most_25_percent_more_code() {
    // The body of a function ends where the next begins.
    let chosen = Functions::of([Function::InverseDynamics, Function::GravityForces]);
    let options = CodegenOptions { functions: chosen, ..CodegenOptions::default() };
    let length = |name: &str| {
        let functions = chosen_functions(&shipped(name), &options, &Passes::all());
        let (_, inverse) = functions.into_iter().find(|(name, _)| name == "inverse_dynamics").unwrap();
        // The table of constants is data.
        inverse
            .split("staticCONSTANTS")
            .map(|part| part.split_once("]];").map_or(part, |(_, rest)| rest).len())
            .sum::<usize>()
    };
    let (forty, eighty) = (length("peers/chain40"), length("peers/chain80"));
    assert!(eighty < forty * 5 / 4, "{forty} characters for 40 joints, {eighty} for 80");
}
