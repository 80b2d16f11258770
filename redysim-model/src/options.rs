//! Options of code generation: what is traced, generated and compiled.

use crate::run_time::RunTimeParameter;
use redysim_runtime::Functions;

/// Options of code generation. The default is every function, without pruning.
///
/// A model file may have options, under its keys `functions`, `locked`, `tolerance`, `forward_dynamics` and `parameters`. Each key
/// that is given to `redysim!` takes precedence over the file's. Locked joints are not among the options: in a loaded
/// model they are fixed already.
///
/// ```
/// use redysim_model::{CodegenOptions, Function, Functions};
///
/// let functions = Functions::of([Function::InverseDynamics, Function::MassMatrix]);
/// let options = CodegenOptions { functions, ..CodegenOptions::default() };
/// assert!(options.functions.contains(Function::MassMatrix) && !options.functions.contains(Function::Energy));
/// assert!(CodegenOptions::default().functions.contains(Function::Energy));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CodegenOptions {
    /// The functions that are generated, beside those of `ConfigurationSpace`, which every mechanism has.
    pub functions: Functions,
    /// The share of each joint's largest force by which joint forces, and of the largest of each of their results by
    /// which the mass matrix and accelerations, may be wrong within the ranges of the joints. `None` prunes nothing.
    pub tolerance: Option<f64>,
    /// How forward dynamics is computed.
    pub forward_dynamics: AccelerationMethod,
    /// The numbers that are given at run time. With any, nothing is pruned.
    pub parameters: Vec<RunTimeParameter>,
}

/// How compiled forward dynamics is computed: the key `forward_dynamics` of a model file or a declaration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum AccelerationMethod {
    /// `"auto"`: by the factorisation where that takes fewer operations and keeps the digits that the recursion keeps,
    /// else by the recursion.
    #[default]
    Auto,
    /// `"recursion"`: by the O(n) recursion over articulated bodies (ABA).
    Recursion,
    /// `"factorisation"`: by the factorisation U D Uᵀ of the explicit mass matrix (CRBA).
    Factorisation,
}

impl AccelerationMethod {
    /// Every method, with the name it has in a model.
    pub const NAMES: [(&'static str, AccelerationMethod); 3] = [
        (AccelerationMethod::Auto.name(), AccelerationMethod::Auto),
        (AccelerationMethod::Recursion.name(), AccelerationMethod::Recursion),
        (AccelerationMethod::Factorisation.name(), AccelerationMethod::Factorisation),
    ];

    /// Its name in a model.
    pub const fn name(self) -> &'static str {
        match self {
            AccelerationMethod::Auto => "auto",
            AccelerationMethod::Recursion => "recursion",
            AccelerationMethod::Factorisation => "factorisation",
        }
    }
}
