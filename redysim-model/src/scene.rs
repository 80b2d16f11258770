//! What one program asks of a mechanism: no more than that is traced, emitted and compiled.

/// The functions that a mechanism can have, in the order in which its code has them.
pub const FUNCTIONS: [&str; 10] = [
    "inverse_dynamics",
    "forward_dynamics",
    "mass_matrix",
    "bias_forces",
    "gravity_forces",
    "energy",
    "link_kinematics",
    "loop_residual",
    "loop_jacobian",
    "loop_bias",
];

/// What is asked of a mechanism. By default, everything.
///
/// A model file may have a scene, under its keys `functions`, `locked` and `tolerance`; `redysim!` may be given
/// another, of which each key wins over the file's. Locked joints are no part of this: a model that is loaded has them
/// fixed already.
///
/// ```
/// use redysim_model::{Functions, Scene};
///
/// let scene = Scene { functions: Functions::of(["inverse_dynamics", "mass_matrix"])?, ..Scene::default() };
/// assert!(scene.functions.contains("mass_matrix") && !scene.functions.contains("energy"));
/// assert!(Scene::default().functions.contains("energy"));
/// # Ok::<(), redysim_model::UnknownFunction>(())
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

/// A set of [`FUNCTIONS`]; by default all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Functions([bool; FUNCTIONS.len()]);

impl Functions {
    /// Every function.
    pub const ALL: Functions = Functions([true; FUNCTIONS.len()]);

    /// The functions of these names.
    ///
    /// # Errors
    ///
    /// The first name that is none of [`FUNCTIONS`].
    pub fn of<'a>(names: impl IntoIterator<Item = &'a str>) -> Result<Functions, UnknownFunction> {
        let mut functions = Functions([false; FUNCTIONS.len()]);
        for name in names {
            let place = FUNCTIONS.iter().position(|known| *known == name);
            functions.0[place.ok_or_else(|| UnknownFunction(name.to_string()))?] = true;
        }
        Ok(functions)
    }

    /// The same but for the function of this name.
    pub(crate) fn without(self, name: &str) -> Functions {
        let mut functions = self;
        for (_, wanted) in FUNCTIONS.iter().zip(&mut functions.0).filter(|(known, _)| **known == name) {
            *wanted = false;
        }
        functions
    }

    /// Whether the function of this name is among them.
    pub fn contains(&self, name: &str) -> bool {
        FUNCTIONS.iter().zip(self.0).any(|(known, wanted)| *known == name && wanted)
    }
}

impl Default for Functions {
    /// Every function.
    fn default() -> Self {
        Functions::ALL
    }
}

/// A name that no function of a mechanism has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFunction(String);

impl std::fmt::Display for UnknownFunction {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "`{}` is no function of a mechanism; the functions are: {}", self.0, FUNCTIONS.join(", "))
    }
}

impl std::error::Error for UnknownFunction {}
