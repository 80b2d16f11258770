//! The compiled type: constants, functions and traits of one mechanism.

use crate::angles::Angles;
use crate::documentation;
use crate::emit::{COS, SIN, Vocabulary, angle, function_body, local, without_turns};
use crate::expressions::Expressions;
use crate::functions::{TraceError, TracedFunction, trace_of, trace_scene};
use crate::passes::{ChangedValue, Passes};
use crate::shape;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, Model, Outline, Scene, Tree};
use redysim_runtime::OperationCount;
use redysim_runtime::function::Interface;

/// The code of a mechanism, and what it costs.
#[derive(Clone, Debug)]
pub struct Generated {
    /// `impl` blocks for a type that is declared elsewhere.
    pub tokens: TokenStream,
    /// Operations of each function.
    pub operations: Vec<(Function, OperationCount)>,
    /// What was asked for and cannot be.
    pub warnings: Vec<String>,
}

/// What the functions of a mechanism cost.
#[derive(Clone, Debug)]
pub struct Counted {
    /// Operations of each function.
    pub operations: Vec<(Function, OperationCount)>,
    /// What was asked for and cannot be.
    pub warnings: Vec<String>,
}

/// The `impl`s of the type `name` for `model`; `runtime` is the path of the crate `redysim_runtime`.
///
/// # Errors
///
/// In debug builds passes over expressions are verified, and one that changes a value is reported.
pub fn implementation(model: &Model, name: &Ident, runtime: &TokenStream) -> Result<Generated, ChangedValue> {
    implementation_with(model, name, runtime, &Scene::default(), &Passes::default())
}

/// The same with no more than what is asked of the mechanism, and with the given passes only, to see what the others
/// gain.
///
/// # Errors
///
/// As [`implementation`].
pub fn implementation_with(
    model: &Model,
    name: &Ident,
    runtime: &TokenStream,
    scene: &Scene,
    passes: &Passes,
) -> Result<Generated, ChangedValue> {
    let (functions, warnings) = functions(model, scene, passes)?;
    let tree = Tree::new(model);
    let moving: Vec<&str> = model.moving_links().map(|link| link.name.as_str()).collect();
    let bodies: Vec<String> = tree.bodies.iter().map(|body| moving[body.coordinate].to_string()).collect();
    let operations = operations_of(&functions);
    let outline = Outline::new(model, scene);
    let angles = Angles::of(functions.iter().map(|function| &function.expressions));
    let writer = Writer { model, bodies: &bodies, angles: &angles, outline: &outline, runtime };
    let definitions =
        std::iter::once(writer.posture()).chain(functions.iter().map(|function| writer.function(function)));
    let tokens = type_impls(&outline, name, runtime, &operations, definitions.collect());
    Ok(Generated { tokens, operations, warnings })
}

/// What the functions of a compiled mechanism cost, and what was asked for and cannot be, without the code.
///
/// # Errors
///
/// As [`implementation`].
pub fn operations(model: &Model, scene: &Scene) -> Result<Counted, ChangedValue> {
    let (functions, warnings) = functions(model, scene, &Passes::default())?;
    Ok(Counted { operations: operations_of(&functions), warnings })
}

/// The functions that a scene asks for, and what of it cannot be.
fn functions(
    model: &Model,
    scene: &Scene,
    passes: &Passes,
) -> Result<(Vec<TracedFunction>, Vec<String>), ChangedValue> {
    let (functions, unpruned) = match trace_scene(model, scene, passes) {
        Ok(functions) => (functions, None),
        Err(TraceError::ChangedValue(changed)) => return Err(changed),
        Err(no_range @ TraceError::NoRange { .. }) => {
            let unpruned = format!("nothing is pruned: {no_range}");
            (trace_of(&Tree::new(model), scene, passes)?, Some(unpruned))
        }
    };
    let warnings = functions.iter().filter_map(documentation::warning).chain(unpruned).collect();
    Ok((functions, warnings))
}

fn operations_of(functions: &[TracedFunction]) -> Vec<(Function, OperationCount)> {
    functions.iter().map(|traced| (traced.function, traced.expressions.count())).collect()
}

/// The `impl`s of a type whose model has faults: everything has its type and nothing has a meaning, so that the faults
/// of the model are the only errors.
pub fn stub(outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let nq = outline.joints.len();
    let posture = posture_head(nq, nq, runtime);
    let functions = outline.functions.iter();
    let heads =
        functions.flat_map(|function| [head(function, outline, runtime), head_at(function, outline, nq, runtime)]);
    let definitions = std::iter::once(posture).chain(heads).map(|head| quote!(pub #head { ::core::unreachable!() }));
    type_impls(outline, name, runtime, &[], definitions.collect())
}

/// The name of the argument that has the coordinates with the sines and cosines.
const POSTURE: &str = "at";

fn type_impls(
    outline: &Outline,
    name: &Ident,
    runtime: &TokenStream,
    operations: &[(Function, OperationCount)],
    definitions: Vec<TokenStream>,
) -> TokenStream {
    let constants = constants(outline, operations, runtime);
    let mechanism = mechanism_trait(outline, name, runtime);
    let closure = closure_trait(outline, name, runtime);
    let traits = outline.functions.iter().map(|function| trait_impl(function, outline, name, runtime));
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

fn constants(outline: &Outline, operations: &[(Function, OperationCount)], runtime: &TokenStream) -> TokenStream {
    let Outline { name, links, joints, actuated, loop_rows, .. } = outline;
    let (nv, nl) = (Literal::usize_unsuffixed(joints.len()), Literal::usize_unsuffixed(links.len()));
    let nc = Literal::usize_unsuffixed(loop_rows.len());
    let counts = operations.iter().map(|(function, count)| {
        let field = format_ident!("{}", function.name());
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

/// Writes the inherent functions of one type.
struct Writer<'a> {
    model: &'a Model,
    bodies: &'a [String],
    angles: &'a Angles,
    outline: &'a Outline,
    runtime: &'a TokenStream,
}

impl Writer<'_> {
    /// The function that computes the sines and cosines of all angles.
    fn posture(&self) -> TokenStream {
        let head = posture_head(self.outline.joints.len(), self.angles.len(), self.runtime);
        let (q, runtime) = (local("q"), self.runtime);
        let (terms, angles) =
            (self.terms_of_sums(0..self.angles.len()), self.angles.at(0..self.angles.len()).map(angle));
        let body = with_target_features(&quote! {
            #terms
            let (sin, cos) = S::sin_cos_all([#(#angles),*]);
            #runtime::Posture::new(#q, &sin, &cos)
        });
        quote! {
            /// Coordinates with the sines and cosines of all angles: computed once, they serve every function whose
            /// name ends in `_at`.
            #[inline]
            pub #head {
                #body
            }
        }
    }

    /// The statement that takes whole turns off the coordinates whose sums are among the angles at `positions`.
    fn terms_of_sums(&self, positions: impl IntoIterator<Item = usize>) -> Option<TokenStream> {
        let coordinates = self.angles.summed(positions);
        let (q, names) = (local("q"), coordinates.iter().map(|&coordinate| without_turns(coordinate)));
        let places = coordinates.iter().map(|&coordinate| Literal::u32_unsuffixed(coordinate));
        (!coordinates.is_empty()).then(|| quote!(let [#(#names),*] = S::without_turns([#(#q[#places]),*]);))
    }

    /// One function with its documentation: of coordinates, and of a posture. What both compute after the sines and
    /// cosines is a function of its own, which becomes part of either, so that no posture goes through memory.
    fn function(&self, traced: &TracedFunction) -> TokenStream {
        let TracedFunction { function, ref expressions, .. } = *traced;
        let signature = function.signature();
        let Writer { model, bodies, angles, outline, runtime } = *self;
        let (head, head_at) = (head(function, outline, runtime), head_at(function, outline, angles.len(), runtime));
        let head_inlined = head_inlined(function, outline, angles.len(), runtime);
        let arguments: Vec<&str> = signature.arguments.iter().map(|argument| argument.name()).collect();
        let vocabulary = Vocabulary { arguments: &arguments, bodies, angles };
        let result = |outputs: &[TokenStream]| shape::value(signature.result, outline, outputs, runtime);
        let body = function_body(expressions, &vocabulary, result);
        let paragraphs = documentation::paragraphs(traced, model);
        let lines = paragraphs.iter().flat_map(|paragraph| std::iter::once("").chain(paragraph.lines())).skip(1);
        let docs = lines.map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
        let docs_at = format!(" [`{0}`](Self::{0}) where the sines and cosines are there already.", function.name());
        let (inlined, q, at) = (inlined(function), local("q"), local(POSTURE));
        let others: Vec<Ident> = others(function).collect();
        let (computed, sin, cos) = self.needed_angles(expressions);
        let of_coordinates = with_target_features(&quote! {
            #computed
            Self::#inlined(#q, #sin, #cos #(, #others)*)
        });
        let of_posture = with_target_features(&quote!(Self::#inlined(&#at.#q, &#at.sin, &#at.cos #(, #others)*)));
        quote! {
            #(#[doc = #docs])*
            pub #head {
                #of_coordinates
            }
            #[doc = #docs_at]
            pub #head_at {
                #of_posture
            }
            #[inline(always)]
            #head_inlined {
                #body
            }
        }
    }

    /// The statement that computes the sines and cosines that one function needs, and those of all angles, of which
    /// what it never reads is zero.
    fn needed_angles(&self, expressions: &Expressions) -> (Option<TokenStream>, TokenStream, TokenStream) {
        let needed = self.angles.needed_by(expressions);
        let values: Vec<TokenStream> = self.angles.at(needed.iter().copied()).map(angle).collect();
        let terms = self.terms_of_sums(needed.iter().copied());
        let computed = (!values.is_empty()).then(|| quote!(#terms let (sin, cos) = S::sin_cos_all([#(#values),*]);));
        if needed.len() == self.angles.len() && !needed.is_empty() {
            return (computed, quote!(&sin), quote!(&cos));
        }
        let [sin, cos] = [SIN, COS].map(|function| {
            let elements = (0..self.angles.len()).map(|position| match needed.binary_search(&position) {
                Ok(place) => {
                    let (array, place) = (local(function), Literal::usize_unsuffixed(place));
                    quote!(#array[#place])
                }
                Err(_) => quote!(S::zero()),
            });
            let elements: Vec<TokenStream> = elements.collect();
            quote!(&[#(#elements),*])
        });
        (computed, sin, cos)
    }
}

/// `body` in code for the instructions that the scalar stands on.
fn with_target_features(body: &TokenStream) -> TokenStream {
    quote!(S::with_target_features(#[inline(always)] || { #body }))
}

/// The names of a function's arguments.
fn arguments(function: Function) -> impl Iterator<Item = Ident> {
    function.signature().arguments.iter().map(|argument| local(argument.name()))
}

/// The names of those after the coordinates.
fn others(function: Function) -> impl Iterator<Item = Ident> {
    arguments(function).skip(1)
}

/// The name of what a function computes after the sines and cosines.
fn inlined(function: Function) -> Ident {
    format_ident!("{}_inlined", function.name())
}

/// Name, arguments and result of what a function computes after the sines and cosines of `angles` angles.
fn head_inlined(function: Function, outline: &Outline, angles: usize, runtime: &TokenStream) -> TokenStream {
    let name = inlined(function);
    let [nv, angles] = [outline.joints.len(), angles].map(Literal::usize_unsuffixed);
    let [q, sin, cos] = ["q", SIN, COS].map(local);
    let others = others(function);
    let output = shape::output_type(function.signature().result, outline, runtime);
    quote!(fn #name<S: #runtime::Scalar>(
        #q: &[S; #nv], #sin: &[S; #angles], #cos: &[S; #angles] #(, #others: &[S; #nv])*
    ) -> #output)
}

/// Name, argument and result of the function that computes sines and cosines.
fn posture_head(coordinates: usize, angles: usize, runtime: &TokenStream) -> TokenStream {
    let [nq, angles] = [coordinates, angles].map(Literal::usize_unsuffixed);
    let q = local("q");
    quote!(fn posture<S: #runtime::Scalar>(#q: &[S; #nq]) -> #runtime::Posture<S, #nq, #angles>)
}

/// Name, arguments and result of a function of a posture with `angles` angles.
fn head_at(function: Function, outline: &Outline, angles: usize, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}_at", function.name());
    let [nv, angles] = [outline.joints.len(), angles].map(Literal::usize_unsuffixed);
    let at = local(POSTURE);
    let others = others(function);
    let output = shape::output_type(function.signature().result, outline, runtime);
    quote!(fn #name<S: #runtime::Scalar>(
        #at: &#runtime::Posture<S, #nv, #angles> #(, #others: &[S; #nv])*
    ) -> #output)
}

/// Name, arguments and result of a function.
fn head(function: Function, outline: &Outline, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", function.name());
    let arguments = arguments(function);
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let output = shape::output_type(function.signature().result, outline, runtime);
    quote!(fn #name<S: #runtime::Scalar>(#(#arguments: &[S; #nv]),*) -> #output)
}

/// The trait that has the function alone; nothing for a function of a trait that has several.
fn trait_impl(function: Function, outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let (trait_name, tangent) = match function.signature().interface {
        Interface::Own(trait_name) => (trait_name, None),
        Interface::WithTangent(trait_name) => (trait_name, Some(tangent(function, runtime))),
        Interface::LoopClosure => return TokenStream::new(),
    };
    let trait_name = format_ident!("{trait_name}");
    let method = method(function, outline, runtime);
    quote! {
        impl<S: #runtime::Scalar> #runtime::#trait_name<S> for #name {
            #method
            #tangent
        }
    }
}

/// The derivative of a function whose trait asks for one: the same code over dual numbers.
fn tangent(function: Function, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}_tangent", function.name());
    quote! {
        fn #name(
            &self,
            at: #runtime::mechanism::Arguments<'_, S, Self>,
            slopes: #runtime::mechanism::Arguments<'_, S, Self>,
        ) -> ::core::option::Option<Self::Velocities> {
            ::core::option::Option::Some(#runtime::dual::#name(self, at, slopes))
        }
    }
}

/// The method of a trait that is one of the type's own functions.
fn method(function: Function, outline: &Outline, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", function.name());
    let arguments: Vec<Ident> = arguments(function).collect();
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let output = shape::output_type(function.signature().result, outline, runtime);
    quote! {
        #[inline]
        fn #name(&self, #(#arguments: &[S; #nv]),*) -> #output {
            Self::#name(#(#arguments),*)
        }
    }
}

/// The closure of the loops, for a type that has all of its functions.
fn closure_trait(outline: &Outline, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let own = Function::ALL.iter().copied().filter(|function| function.needs_loops());
    if !own.clone().all(|function| outline.functions.contains(function)) {
        return TokenStream::new();
    }
    let nv = Literal::usize_unsuffixed(outline.joints.len());
    let nc = Literal::usize_unsuffixed(outline.loop_rows.len());
    let methods = own.map(|function| method(function, outline, runtime));
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
