//! A mechanism as Rust: `impl`s of a type, over any `S: Scalar`.

mod angles;
mod body;
mod function;
mod moments;
mod parametric;
mod results;
mod sines;
#[cfg(feature = "source")]
pub mod source;
mod traits;
mod trig;
mod values;
mod writes;

use crate::mechanism::MechanismProgram;
pub use body::RESERVED;
use body::local;
use function::{Writer, head, head_with_trig, joint_trig_head};
pub use parametric::TypeTokens;
use parametric::{constructors, is_parametric};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use redysim_model::{Function, Functions, PublicInterface};
use redysim_runtime::OperationCount;
use redysim_runtime::function::Dimension;

/// Prints `mechanism` as the type `name`.
pub fn mechanism(mechanism: &MechanismProgram, name: &Ident, runtime: &TokenStream) -> TypeTokens {
    let MechanismProgram { interface, ref trig, ref functions, ref lumped } = *mechanism;
    let writer = Writer { interface, trig, runtime };
    let (configuration, own): (Vec<_>, Vec<_>) =
        functions.iter().partition(|program| program.function.is_always_present());
    let definitions =
        std::iter::once(writer.joint_trig()).chain(own.into_iter().map(|program| writer.function(program)));
    let configuration = configuration.into_iter().map(|program| (program.function, writer.whole_body(program)));
    let operations: Vec<_> = functions.iter().map(|program| (program.function, program.operations)).collect();
    let constructors = constructors(interface, lumped.as_ref(), name, runtime);
    let impls = type_impls(interface, configuration.collect(), name, runtime, &operations, definitions.collect());
    let numbers = lumped.as_ref().map_or(0, |program| program.outputs.len());
    TypeTokens::new(interface, numbers, quote!(#impls #constructors))
}

/// A type that cannot be generated because of `error`, an expression that does not compile, such as
/// `compile_error!("..")`: it has every item, but no function has a body. If its model has faults, it has all functions,
/// and `error` is the size of every array: the compiler reports nothing further of such arrays, so that the faults of the
/// model are the only errors, whatever size the code around it expects.
pub fn stub(interface: &PublicInterface, name: &Ident, runtime: &TokenStream, error: &TokenStream) -> TypeTokens {
    let functions = if interface.is_valid { interface.functions } else { Functions::ALL };
    let interface = &PublicInterface { functions, ..interface.clone() };
    let unknown = local(UNKNOWN).into_token_stream();
    let joint_trig = joint_trig_head(interface, &unknown, runtime);
    let own = interface.functions.iter().filter(|function| !function.is_always_present());
    let heads = own.flat_map(|function| {
        [head(function, interface, runtime), head_with_trig(function, interface, &unknown, runtime)]
    });
    let body = quote!(::core::unreachable!());
    let definitions = std::iter::once(joint_trig).chain(heads).map(|head| quote!(pub #head { #body }));
    let configuration = Function::ALL.iter().copied().filter(|function| function.is_always_present());
    let configuration = configuration.map(|function| (function, body.clone()));
    let constructors = constructors(interface, None, name, runtime);
    let impls = type_impls(interface, configuration.collect(), name, runtime, &[], definitions.collect());
    TypeTokens::new(interface, 0, quote!(const #unknown: usize = #error; #impls #constructors))
}

fn type_impls(
    interface: &PublicInterface,
    configuration: Vec<(Function, TokenStream)>,
    name: &Ident,
    runtime: &TokenStream,
    operations: &[(Function, OperationCount)],
    definitions: Vec<TokenStream>,
) -> TokenStream {
    let constants = constants(interface, operations, runtime);
    let mechanism = traits::mechanism(interface, configuration, name, runtime);
    let closure = traits::closure(interface, name, runtime);
    let frames = traits::frames(interface, name, runtime);
    let traits = interface.functions.iter().map(|function| traits::own(function, interface, name, runtime));
    let definitions = quote!(#(#definitions)*);
    // Constants do not depend on the scalar: a type over scalars has them in a block of their own.
    let (beside_constants, block) = if is_parametric(interface) {
        let block = quote! {
            #[allow(dead_code, unused_variables, non_snake_case, clippy::all, clippy::pedantic)]
            impl<S: #runtime::Scalar> #name<S> {
                #definitions
            }
        };
        (None, Some(block))
    } else {
        (Some(definitions), None)
    };
    quote! {
        #[allow(dead_code, unused_variables, non_snake_case, clippy::all, clippy::pedantic)]
        impl #name {
            #constants
            #beside_constants
        }
        #block
        #mechanism
        #(#traits)*
        #closure
        #frames
    }
}

/// The constant that stands for every size of a mechanism whose model has faults.
const UNKNOWN: &str = "UNKNOWN";

/// `value`, which the compiler does not evaluate where the model has faults.
fn known(interface: &PublicInterface, value: TokenStream) -> TokenStream {
    if interface.is_valid {
        return value;
    }
    let unknown = local(UNKNOWN);
    quote!({ let _: usize = #unknown; #value })
}

/// A size of the mechanism, as the length of an array.
fn length(interface: &PublicInterface, dimension: Dimension) -> TokenStream {
    length_of(interface, interface.size(dimension))
}

/// The length of an array, which is unknown where the model has faults.
fn length_of(interface: &PublicInterface, length: usize) -> TokenStream {
    if interface.is_valid {
        Literal::usize_unsuffixed(length).into_token_stream()
    } else {
        local(UNKNOWN).into_token_stream()
    }
}

fn constants(
    interface: &PublicInterface,
    operations: &[(Function, OperationCount)],
    runtime: &TokenStream,
) -> TokenStream {
    let PublicInterface { name, links, joints, loop_rows, frames, mass, .. } = interface;
    let parameters = parametric::constants(interface);
    let mass_doc = if is_parametric(interface) {
        " Mass of all links, kg, with the parameters of the model."
    } else {
        " Mass of all links, kg."
    };
    let (nj, joints) = (length_of(interface, joints.len()), joints.iter().map(|joint| &joint.name));
    let (coordinates, velocities) = (interface.coordinate_names(), interface.velocity_names());
    let actuated = interface.actuated();
    let sizes =
        [Dimension::Coordinates, Dimension::Velocities, Dimension::Links, Dimension::LoopRows, Dimension::Frames];
    let [nq, nv, nl, nc, nf] = sizes.map(|dimension| length(interface, dimension));
    let counts = operations.iter().map(|(function, count)| {
        let field = format_ident!("{}", function.name());
        let [additions, multiplications, divisions, trig] =
            [count.additions, count.multiplications, count.divisions, count.trig].map(Literal::u32_unsuffixed);
        quote!(#field: #runtime::OperationCount {
            additions: #additions, multiplications: #multiplications, divisions: #divisions, trig: #trig,
        })
    });
    let mass = known(interface, mass.to_token_stream());
    let operations = known(interface, quote!(#runtime::Operations { #(#counts,)* ..#runtime::Operations::NONE }));
    quote! {
        /// Name of the model.
        pub const NAME: &'static str = #name;
        /// Number of joints that move.
        pub const NJ: usize = #nj;
        /// Number of joint coordinates.
        pub const NQ: usize = #nq;
        /// Number of joint velocities.
        pub const NV: usize = #nv;
        /// Number of links.
        pub const NL: usize = #nl;
        /// Number of rows of the loop constraints.
        pub const NC: usize = #nc;
        /// Number of frames of interest.
        pub const NF: usize = #nf;
        #parameters
        #[doc = #mass_doc]
        pub const MASS: f64 = #mass;
        /// Names of the links, in the model's order.
        pub const LINK_NAMES: [&'static str; #nl] = [#(#links),*];
        /// Names of the joints that move, in the model's order.
        pub const JOINT_NAMES: [&'static str; #nj] = [#(#joints),*];
        /// Names of the joint coordinates, in the model's order.
        pub const COORDINATE_NAMES: [&'static str; #nq] = [#(#coordinates),*];
        /// Names of the joint velocities, in the model's order.
        pub const VELOCITY_NAMES: [&'static str; #nv] = [#(#velocities),*];
        /// Name of the loop to which each row of the loop constraints belongs.
        pub const LOOP_NAMES: [&'static str; #nc] = [#(#loop_rows),*];
        /// Names of the frames of interest, in the model's order.
        pub const FRAME_NAMES: [&'static str; #nf] = [#(#frames),*];
        /// Whether each joint velocity has an actuator.
        pub const ACTUATED: [bool; #nv] = [#(#actuated),*];
        /// Operations of each function.
        pub const OPS: #runtime::Operations = #operations;
    }
}
