//! One function of a mechanism: of coordinates, and of precomputed joint trigonometry.

use super::angles::{angle, without_turns};
use super::body::{COS, SIN, body, local};
use super::{documentation, length, results};
use crate::angles::Angles;
use crate::expressions::Expressions;
use crate::functions::TracedFunction;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, Model, PublicInterface};
use redysim_runtime::function::{Argument, Dimension};

/// The name of the argument that has the coordinates with the sines and cosines.
const TRIG: &str = "trig";

/// Writes the inherent functions of one type.
pub struct Writer<'a> {
    pub model: &'a Model,
    pub bodies: &'a [String],
    pub angles: &'a Angles,
    pub interface: &'a PublicInterface,
    pub runtime: &'a TokenStream,
}

impl Writer<'_> {
    /// The function that computes the sines and cosines of all angles.
    pub fn joint_trig(&self) -> TokenStream {
        let head = joint_trig_head(self.interface, self.angles.len(), self.runtime);
        let (q, runtime) = (local("q"), self.runtime);
        let (terms, angles) =
            (self.terms_of_sums(0..self.angles.len()), self.angles.at(0..self.angles.len()).map(angle));
        let body = with_target_features(&quote! {
            #terms
            let (sin, cos) = S::sin_cos_all([#(#angles),*]);
            #runtime::JointTrig::new(#q, &sin, &cos)
        });
        quote! {
            /// The coordinates with the sines and cosines of all angles, computed once for every function whose
            /// name ends in `_with_trig`.
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

    /// One function with its documentation, of coordinates and of joint trigonometry. The code after the sines and
    /// cosines is a third function, inlined into both, so that sines and cosines do not go through memory.
    pub fn function(&self, traced: &TracedFunction) -> TokenStream {
        let TracedFunction { function, ref expressions, .. } = *traced;
        let signature = function.signature();
        let Writer { model, bodies, angles, interface, runtime } = *self;
        let (head, head_with_trig) =
            (head(function, interface, runtime), head_with_trig(function, interface, angles.len(), runtime));
        let head_inlined = head_inlined(function, interface, angles.len(), runtime);
        let arguments: Vec<&str> = signature.arguments.iter().map(|argument| argument.name()).collect();
        let result = |outputs: &[TokenStream]| results::value(signature.result, interface, outputs, runtime);
        let body = body(expressions, &arguments, bodies, angles, result);
        let paragraphs = documentation::paragraphs(traced, model);
        let lines = paragraphs.iter().flat_map(|paragraph| std::iter::once("").chain(paragraph.lines())).skip(1);
        let docs = lines.map(|line| if line.is_empty() { String::new() } else { format!(" {line}") });
        let docs_with_trig =
            format!(" [`{0}`](Self::{0}) with sines and cosines that are already computed.", function.name());
        let (inlined, q, trig) = (inlined(function), local("q"), local(TRIG));
        let others: Vec<Ident> = others(function).collect();
        let (computed, sin, cos) = self.needed_angles(expressions);
        let of_coordinates = with_target_features(&quote! {
            #computed
            Self::#inlined(#q, #sin, #cos #(, #others)*)
        });
        let of_joint_trig =
            with_target_features(&quote!(Self::#inlined(&#trig.#q, &#trig.sin, &#trig.cos #(, #others)*)));
        quote! {
            #(#[doc = #docs])*
            pub #head {
                #of_coordinates
            }
            #[doc = #docs_with_trig]
            pub #head_with_trig {
                #of_joint_trig
            }
            #[inline(always)]
            #head_inlined {
                #body
            }
        }
    }

    /// The statement that computes the sines and cosines that one function needs, and the arrays of those of all
    /// angles, with zeros for the others.
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

/// `body`, compiled for the target features that the scalar needs.
fn with_target_features(body: &TokenStream) -> TokenStream {
    quote!(S::with_target_features(#[inline(always)] || { #body }))
}

/// The names of a function's arguments.
pub fn arguments(function: Function) -> impl Iterator<Item = Ident> {
    function.signature().arguments.iter().map(|argument| local(argument.name()))
}

/// The names of the arguments after the coordinates.
fn others(function: Function) -> impl Iterator<Item = Ident> {
    arguments(function).skip(1)
}

/// The arguments with their types.
pub fn parameters(function: Function, interface: &PublicInterface) -> impl Iterator<Item = TokenStream> {
    function.signature().arguments.iter().map(|argument: &Argument| {
        let (name, length) = (local(argument.name()), length(interface, argument.dimension()));
        quote!(#name: &[S; #length])
    })
}

/// The name of the function that is given the sines and cosines.
fn inlined(function: Function) -> Ident {
    format_ident!("{}_inlined", function.name())
}

/// Name, arguments and result of the function that is given the sines and cosines of `angles` angles.
fn head_inlined(function: Function, interface: &PublicInterface, angles: usize, runtime: &TokenStream) -> TokenStream {
    let name = inlined(function);
    let angles = Literal::usize_unsuffixed(angles);
    let [sin, cos] = [SIN, COS].map(local);
    let (q, others) = (parameters(function, interface).take(1), parameters(function, interface).skip(1));
    let output = results::output_type(function.signature().result, interface, runtime);
    quote!(fn #name<S: #runtime::Scalar>(
        #(#q,)* #sin: &[S; #angles], #cos: &[S; #angles] #(, #others)*
    ) -> #output)
}

/// Name, argument and result of the function that computes sines and cosines.
pub fn joint_trig_head(interface: &PublicInterface, angles: usize, runtime: &TokenStream) -> TokenStream {
    let (nq, angles) = (length(interface, Dimension::Coordinates), Literal::usize_unsuffixed(angles));
    let q = local("q");
    quote!(fn joint_trig<S: #runtime::Scalar>(#q: &[S; #nq]) -> #runtime::JointTrig<S, #nq, #angles>)
}

/// Name, arguments and result of a function of the joint trigonometry of `angles` angles.
pub fn head_with_trig(
    function: Function,
    interface: &PublicInterface,
    angles: usize,
    runtime: &TokenStream,
) -> TokenStream {
    let name = format_ident!("{}_with_trig", function.name());
    let (nq, angles) = (length(interface, Dimension::Coordinates), Literal::usize_unsuffixed(angles));
    let (trig, others) = (local(TRIG), parameters(function, interface).skip(1));
    let output = results::output_type(function.signature().result, interface, runtime);
    quote!(fn #name<S: #runtime::Scalar>(
        #trig: &#runtime::JointTrig<S, #nq, #angles> #(, #others)*
    ) -> #output)
}

/// Name, arguments and result of a function.
pub fn head(function: Function, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}", function.name());
    let parameters = parameters(function, interface);
    let output = results::output_type(function.signature().result, interface, runtime);
    quote!(fn #name<S: #runtime::Scalar>(#(#parameters),*) -> #output)
}
