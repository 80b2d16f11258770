//! Expressions of the functions that a test looks at: to trace them all takes several times as long.

use redysim_codegen::functions::{TracedFunction, trace_of};
use redysim_codegen::passes::Passes;
use redysim_model::{CodegenOptions, Function, Functions, Tree};

/// These functions of the tree, after all passes.
pub fn traced(tree: &Tree, functions: &[Function]) -> Vec<TracedFunction> {
    traced_with(tree, functions, &Passes::all())
}

/// These functions of the tree, after these passes.
pub fn traced_with(tree: &Tree, functions: &[Function], passes: &Passes) -> Vec<TracedFunction> {
    let functions = Functions::of(functions.iter().copied());
    trace_of(tree, &CodegenOptions { functions, ..CodegenOptions::default() }, passes).expect("no pass changes a value")
}
