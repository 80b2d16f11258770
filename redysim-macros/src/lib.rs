//! The macros of redysim. They are documented where they are re-exported, in the crate `redysim`.

mod declaration;
mod expand;
mod locate;
mod options;

use proc_macro::TokenStream;

/// Declares a unit struct and makes it the mechanism of a model file.
///
/// ```text
/// redysim! {
///     /// The KUKA KR5 of the ReDySim paper.
///     pub struct Kr5("models/kr5.toml");
/// }
/// ```
///
/// The path `"models/kr5.toml"` is found from the package's manifest; `"./kr5.toml"` and `"../kr5.toml"` from the file
/// that calls the macro. An edited model is compiled again.
///
/// The type has the constants `NAME`, `NQ`, `NV`, `NL`, `NC`, `NF`, `NP`, `PARAMETER_NAMES`, `PARAMETERS`, `MASS`, `LINK_NAMES`, `JOINT_NAMES`, `LOOP_NAMES`,
/// `FRAME_NAMES`, `ACTUATED` and `OPS`, the functions `inverse_dynamics`, `forward_dynamics`, `mass_matrix`,
/// `bias_forces`, `coriolis_matrix`, `gravity_forces`, `passive_forces`, `energy`, `center_of_mass`, `link_kinematics`,
/// `loop_residual`, `loop_jacobian` and `loop_bias`, if the model has frames also `frame_kinematics`, `frame_jacobians`,
/// `frame_bias` and `frame_forces`,
/// all over any `S: Scalar`, and the traits that have them. Unless the declaration derives traits itself, the type is
/// `Clone`, `Copy`, `Debug` and `Default`.
///
/// Options may follow the path:
///
/// ```text
/// redysim! {
///     pub struct Kr5("models/kr5.toml", functions = [inverse_dynamics], locked = { joint6 = "0 deg" });
/// }
/// ```
///
/// - `functions = [..]`: only these, with their forms `…_with_trig` and the angles they need in `joint_trig`, and only
///   the traits that they make up; `OPS` has no operations for the others. Every mechanism has the functions of
///   `ConfigurationSpace`.
/// - `locked = { joint6 = "0 deg", slide = 0.3 }`: joints, by their names or those of their links, are held at these
///   coordinates, as if they were fixed there.
/// - `tolerance = 1e-3`: joint forces, accelerations and the mass matrix may have errors of this share of each joint's
///   scale while every joint stays within the `range` that the model file gives it, and terms that do not matter then
///   are left out. The documentation of each function states its operations before and after, the ranges, and the worst
///   error of 100,000 sampled states; the compiler warns where the tolerance did not hold and a function is left whole.
///
/// - `parameters = ["gravity", "tool.mass", "tool.com", "tool.inertia", "joint2.damping"]`: numbers that the program gives
///   when it runs: gravity; `mass`, `com` and `inertia` of a link; `armature`, `damping`, `friction`, `friction_velocity`,
///   `stiffness` and `rest` of a joint. The type is then `Kr5<S = f64>` over the scalar of its numbers, and its functions
///   are methods. `Kr5::new(&parameters)` computes once what depends on them alone, so that a call pays for the general
///   numbers only; `try_new` refuses those that no body has; `default` takes the values of the model, `PARAMETERS`, in the
///   order of `PARAMETER_NAMES`. Only `redysim!` declares such a type, the derive does not.
///
/// A model file may have the same options at its top, with names in quotes: `functions = ["inverse_dynamics"]`. A key
/// that is given here takes precedence over the file's.
///
/// Errors in the model are compile errors that show the lines of the model file. Warnings about the model are warnings
/// of the lint `deprecated`, the only kind that a macro can emit; `#[allow(deprecated)]` on the struct silences them, and
/// `allow = ["gravity-up"]` at the top of the model file those with these names.
#[proc_macro]
pub fn redysim(input: TokenStream) -> TokenStream {
    match syn::parse(input) {
        Ok(declaration::Macro(declaration)) => expand::struct_and_impls(&declaration),
        Err(error) => error.into_compile_error(),
    }
    .into()
}

/// Makes a unit struct the mechanism of a model file: `#[derive(Mechanism)] #[mechanism("models/kr5.toml")]`.
///
/// The same code as [`redysim!`], for a type that is declared outside the macro. Options may follow the path, as there:
/// `#[mechanism("models/kr5.toml", functions = [inverse_dynamics])]`.
#[proc_macro_derive(Mechanism, attributes(mechanism))]
pub fn mechanism(input: TokenStream) -> TokenStream {
    match syn::parse(input) {
        Ok(declaration::Derive(declaration)) => expand::impls(&declaration),
        Err(error) => error.into_compile_error(),
    }
    .into()
}
