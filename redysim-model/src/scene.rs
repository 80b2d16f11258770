//! What one program asks of a mechanism: no more than that is traced, emitted and compiled.

use redysim_runtime::Functions;

/// What is asked of a mechanism. By default, everything.
///
/// A model file may have a scene, under its keys `functions`, `locked` and `tolerance`; `redysim!` may be given
/// another, of which each key wins over the file's. Locked joints are no part of this: a model that is loaded has them
/// fixed already.
///
/// ```
/// use redysim_model::{Function, Functions, Scene};
///
/// let functions = Functions::of([Function::InverseDynamics, Function::MassMatrix]);
/// let scene = Scene { functions, ..Scene::default() };
/// assert!(scene.functions.contains(Function::MassMatrix) && !scene.functions.contains(Function::Energy));
/// assert!(Scene::default().functions.contains(Function::Energy));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Scene {
    /// The functions that are wanted.
    pub functions: Functions,
    /// The share of each joint's largest force by which joint forces, and of the largest of each of their results by
    /// which the mass matrix and accelerations, may be wrong within the ranges of the joints. `None` prunes nothing.
    pub tolerance: Option<f64>,
    /// How forward dynamics is computed.
    pub forward_dynamics: AccelerationMethod,
}

/// How compiled forward dynamics is computed: the key `forward_dynamics` of a model or a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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
        ("auto", AccelerationMethod::Auto),
        ("recursion", AccelerationMethod::Recursion),
        ("factorisation", AccelerationMethod::Factorisation),
    ];
}
