//! From a model to the code of a mechanism.

use crate::backend::rust::{self, TypeTokens};
use crate::documentation;
use crate::expressions::Expressions;
use crate::functions::{ParametricFunctions, TraceError, TracedFunction, trace_model, trace_of, trace_with_parameters};
use crate::mechanism::MechanismProgram;
use crate::passes::{PassError, Passes};
use crate::siblings::Siblings;
use proc_macro2::{Ident, TokenStream};
use redysim_model::{CodegenOptions, Function, Functions, Model, PublicInterface, Tree};
use redysim_runtime::OperationCount;

/// The code of a mechanism, and its operations.
#[derive(Clone, Debug)]
pub struct Generated {
    /// The type, to be declared where it is used.
    pub tokens: TypeTokens,
    /// Operations of each function.
    pub operations: Vec<(Function, OperationCount)>,
    /// Options that have no effect, and why.
    pub warnings: Vec<String>,
}

/// The operations of a mechanism's functions.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Operations of each function.
    pub operations: Vec<(Function, OperationCount)>,
    /// Options that have no effect, and why.
    pub warnings: Vec<String>,
}

/// The `impl`s of the type `name` for `model`; `runtime` is the path of the crate `redysim_runtime`.
///
/// # Errors
///
/// In debug builds passes over expressions are verified, and one that changes a value or breaks the graph is reported.
pub fn implementation(model: &Model, name: &Ident, runtime: &TokenStream) -> Result<Generated, PassError> {
    implementation_with(model, name, runtime, &CodegenOptions::default(), &Passes::default())
}

/// The same with options, and with the given passes only.
///
/// # Errors
///
/// As [`implementation`].
pub fn implementation_with(
    model: &Model,
    name: &Ident,
    runtime: &TokenStream,
    options: &CodegenOptions,
    passes: &Passes,
) -> Result<Generated, PassError> {
    let traced = traced(model, options, passes)?;
    let interface = PublicInterface::new(model, options);
    let mechanism = MechanismProgram::new(model, &interface, &traced, &rust::RESERVED);
    let tokens = rust::mechanism(&mechanism, name, runtime);
    Ok(Generated { tokens, operations: operations_of(&traced.functions), warnings: traced.warnings })
}

/// The operations and warnings of [`implementation_with`], with all passes, without the code.
///
/// # Errors
///
/// As [`implementation`].
pub fn operations(model: &Model, options: &CodegenOptions) -> Result<Counted, PassError> {
    let TracedMechanism { functions, warnings, .. } = traced(model, options, &Passes::default())?;
    Ok(Counted { operations: operations_of(&functions), warnings })
}

/// The functions of a mechanism before they are printed.
pub(crate) struct TracedMechanism {
    pub functions: Vec<TracedFunction>,
    /// The branches that are alike, if they may be computed side by side.
    pub siblings: Vec<Siblings>,
    /// What depends on run-time parameters alone, if there are any.
    pub lumped: Option<Expressions>,
    /// Options that have no effect, and why.
    pub warnings: Vec<String>,
}

/// The functions that `options` select and those that every mechanism has, and warnings.
///
/// # Errors
///
/// As [`implementation`].
pub(crate) fn traced(model: &Model, options: &CodegenOptions, passes: &Passes) -> Result<TracedMechanism, PassError> {
    let always_present = Function::ALL.iter().copied().filter(|function| function.is_always_present());
    let functions = Functions::of(options.functions.iter().chain(always_present));
    let options = &CodegenOptions { functions, ..options.clone() };
    let siblings = if passes.siblings { Siblings::of(&Tree::new(model)) } else { Vec::new() };
    if !options.parameters.is_empty() {
        let ParametricFunctions { functions, lumped } = trace_with_parameters(model, options, passes)?;
        let unpruned = options.tolerance.map(|_| {
            "nothing is pruned: a tolerance holds for the numbers of the model, but some are parameters, which are given \
             at run time"
                .to_string()
        });
        return Ok(TracedMechanism {
            functions,
            siblings,
            lumped: Some(lumped),
            warnings: unpruned.into_iter().collect(),
        });
    }
    let (functions, unpruned) = match trace_model(model, options, passes) {
        Ok(functions) => (functions, None),
        Err(TraceError::Pass(error)) => return Err(error),
        Err(no_range @ TraceError::NoRange { .. }) => {
            let unpruned = format!("nothing is pruned: {no_range}");
            (trace_of(&Tree::new(model), options, passes)?, Some(unpruned))
        }
    };
    let warnings = functions.iter().filter_map(documentation::warning).chain(unpruned).collect();
    Ok(TracedMechanism { functions, siblings, lumped: None, warnings })
}

fn operations_of(functions: &[TracedFunction]) -> Vec<(Function, OperationCount)> {
    functions.iter().map(|traced| (traced.function, traced.expressions.count())).collect()
}
