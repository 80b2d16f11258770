//! The compiled type: constants, functions and traits of one mechanism.

use crate::emit::{Vocabulary, function_body, local};
use crate::functions::{Function, SIGNATURES, Signature, trace_with};
use crate::passes::Passes;
use crate::shape;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Model, Outline, Tree};
use redysim_runtime::OperationCount;

/// The code of a mechanism, and what it costs.
#[derive(Clone, Debug)]
pub struct Generated {
    /// `impl` blocks for a type that is declared elsewhere.
    pub tokens: TokenStream,
    /// Name and operations of each function.
    pub operations: Vec<(&'static str, OperationCount)>,
}

/// The `impl`s of the type `name` for `model`; `runtime` is the path of the crate `redysim_runtime`.
pub fn implementation(model: &Model, name: &Ident, runtime: &TokenStream) -> Generated {
    implementation_with(model, name, runtime, &Passes::default())
}

/// The same with the given passes only, to see what the others gain.
pub fn implementation_with(model: &Model, name: &Ident, runtime: &TokenStream, passes: &Passes) -> Generated {
    let tree = Tree::new(model);
    let functions = trace_with(&tree, passes);
    let moving: Vec<&str> = model.moving_links().map(|link| link.name.as_str()).collect();
    let bodies: Vec<String> = tree.bodies.iter().map(|body| moving[body.coordinate].to_string()).collect();
    let operations: Vec<_> =
        functions.iter().map(|function| (function.signature.name, function.expressions.count())).collect();
    let outline = Outline::new(model);
    let definitions = functions.iter().map(|function| definition(function, &bodies, &outline, runtime));
    let tokens = type_impls(&outline, name, runtime, &operations, definitions.collect());
    Generated { tokens, operations }
}

/// The `impl`s of a type whose model has faults: everything has its type and nothing has a meaning, so that the faults
/// of the model are the only errors.
pub fn stub(outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let definitions = SIGNATURES.iter().map(|signature| {
        let head = head(signature, outline, runtime);
        quote!(pub #head { ::core::unreachable!() })
    });
    type_impls(outline, name, runtime, &[], definitions.collect())
}

fn type_impls(
    outline: &Outline,
    name: &Ident,
    runtime: &TokenStream,
    operations: &[(&str, OperationCount)],
    definitions: Vec<TokenStream>,
) -> TokenStream {
    let constants = constants(outline, operations, runtime);
    let mechanism = mechanism_trait(outline, name, runtime);
    let closure = closure_trait(outline, name, runtime);
    let own_trait = SIGNATURES.iter().filter(|signature| signature.trait_name != "LoopClosure");
    let traits = own_trait.map(|signature| trait_impl(signature, outline, name, runtime));
    quote! {
        #[allow(dead_code, unused_variables, non_snake_case, clippy::all, clippy::pedantic)]
        impl #name {
            #constants
            #(#definitions)*
        }
        #mechanism
        #(#traits)*
        #closure
    }
}

fn constants(outline: &Outline, operations: &[(&str, OperationCount)], runtime: &TokenStream) -> TokenStream {
    let Outline { name, links, joints, actuated, loop_rows } = outline;
    let (nv, nl) = (Literal::usize_unsuffixed(joints.len()), Literal::usize_unsuffixed(links.len()));
    let nc = Literal::usize_unsuffixed(loop_rows.len());
    let counts = operations.iter().map(|(field, count)| {
        let field = format_ident!("{field}");
        let [additions, multiplications, divisions, trig] =
            [count.additions, count.multiplications, count.divisions, count.trig].map(Literal::u32_unsuffixed);
        quote!(#field: #runtime::OperationCount {
            additions: #additions, multiplications: #multiplications, divisions: #divisions, trig: #trig,
        })
    });
    quote! {
        /// Name of the model.
        pub const NAME: &'static str = #name;
        /// Number of joint coordinates.
        pub const NQ: usize = #nv;
        /// Number of joint velocities.
        pub const NV: usize = #nv;
        /// Number of links.
        pub const NL: usize = #nl;
        /// Number of rows of the loop constraints.
        pub const NC: usize = #nc;
        /// Names of the links, in the model's order.
        pub const LINK_NAMES: [&'static str; #nl] = [#(#links),*];
        /// Names of the joints that move, in the model's order.
        pub const JOINT_NAMES: [&'static str; #nv] = [#(#joints),*];
        /// Name of the loop to which each row of the loop constraints belongs.
        pub const LOOP_NAMES: [&'static str; #nc] = [#(#loop_rows),*];
        /// Whether each moving joint has an actuator.
        pub const ACTUATED: [bool; #nv] = [#(#actuated),*];
        /// Operations of each function.
        pub const OPS: #runtime::Operations = #runtime::Operations { #(#counts,)* ..#runtime::Operations::NONE };
    }
}

/// The documentation and definition of one inherent function.
fn definition(function: &Function, bodies: &[String], outline: &Outline, runtime: &TokenStream) -> TokenStream {
    let Function { signature, remark, expressions } = function;
    let head = head(signature, outline, runtime);
    let vocabulary = Vocabulary { arguments: signature.arguments, bodies };
    let body =
        function_body(expressions, &vocabulary, |outputs| shape::value(signature.shape, outline, outputs, runtime));
    let count = expressions.count();
    let cost = format!(
        "{} flops: {} additions, {} multiplications, {} divisions; {} sine-cosine pairs.",
        count.flops(),
        count.additions,
        count.multiplications,
        count.divisions,
        count.trig
    );
    let paragraphs = [Some(signature.summary), *remark, Some(&cost)].into_iter().flatten();
    let docs = paragraphs.flat_map(|paragraph| [String::new(), format!(" {paragraph}")]).skip(1);
    quote! {
        #(#[doc = #docs])*
        pub #head { #body }
    }
}

/// Name, arguments and result of a function.
fn head(signature: &Signature, outline: &Outline, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", signature.name);
    let arguments = signature.arguments.iter().map(|argument| local(argument));
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let output = shape::output_type(signature.shape, outline, runtime);
    quote!(fn #name<S: #runtime::Scalar>(#(#arguments: &[S; #nv]),*) -> #output)
}

fn trait_impl(signature: &Signature, outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let trait_name = format_ident!("{}", signature.trait_name);
    let method = method(signature, outline, runtime);
    quote! {
        impl<S: #runtime::Scalar> #runtime::#trait_name<S> for #name {
            #method
        }
    }
}

/// The method of a trait that is one of the type's own functions.
fn method(signature: &Signature, outline: &Outline, runtime: &TokenStream) -> TokenStream {
    let function = format_ident!("{}", signature.name);
    let arguments: Vec<Ident> = signature.arguments.iter().map(|argument| local(argument)).collect();
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let output = shape::output_type(signature.shape, outline, runtime);
    quote! {
        #[inline]
        fn #function(&self, #(#arguments: &[S; #nv]),*) -> #output {
            Self::#function(#(#arguments),*)
        }
    }
}

fn closure_trait(outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let nc = Literal::usize_unsuffixed(outline.loop_rows.len());
    let own = SIGNATURES.iter().filter(|signature| signature.trait_name == "LoopClosure");
    let methods = own.map(|signature| method(signature, outline, runtime));
    quote! {
        impl<S: #runtime::Scalar> #runtime::LoopClosure<S, #name> for #name {
            type Rows = [S; #nc];
            type Jacobian = [[S; #nv]; #nc];
            type Gram = [[S; #nc]; #nc];
            fn nc(&self) -> usize {
                Self::NC
            }
            fn loop_name(&self, row: usize) -> ::core::option::Option<&str> {
                Self::LOOP_NAMES.get(row).copied()
            }
            #(#methods)*
        }
    }
}

fn mechanism_trait(outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let dof = outline.joints.len();
    let (nv, nl) = (Literal::usize_unsuffixed(dof), Literal::usize_unsuffixed(outline.links.len()));
    let state = Literal::usize_unsuffixed(2 * dof + 1);
    quote! {
        impl<S: #runtime::Scalar> #runtime::Mechanism<S> for #name {
            type Coordinates = [S; #nv];
            type Velocities = [S; #nv];
            type State = [S; #state];
            type Matrix = [[S; #nv]; #nv];
            type Links = [#runtime::LinkState<S>; #nl];
            fn name(&self) -> &str {
                Self::NAME
            }
            fn nq(&self) -> usize {
                Self::NQ
            }
            fn nv(&self) -> usize {
                Self::NV
            }
            fn nl(&self) -> usize {
                Self::NL
            }
            fn link_name(&self, index: usize) -> ::core::option::Option<&str> {
                Self::LINK_NAMES.get(index).copied()
            }
            fn joint_name(&self, index: usize) -> ::core::option::Option<&str> {
                Self::JOINT_NAMES.get(index).copied()
            }
            fn coordinate_rates(&self, _q: &[S; #nv], v: &[S; #nv]) -> [S; #nv] {
                *v
            }
        }
    }
}
