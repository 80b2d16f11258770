//! What differs for a type that is given numbers at run time: it has a field with what depends on them alone, its
//! functions are methods, and the scalar is a parameter of the type.

use super::body::{GIVEN, Schedule, body, local};
use super::length_of;
use super::values::constant;
use crate::program::Program;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use redysim_model::PublicInterface;
use redysim_runtime::ParameterRule;

/// Whether the type is given numbers at run time.
pub fn is_parametric(interface: &PublicInterface) -> bool {
    !interface.parameters.is_empty()
}

/// A type: its declaration, and its `impl`s.
#[derive(Clone, Debug)]
pub struct TypeTokens {
    /// The generics and fields of the struct; `None` for a unit struct.
    pub fields: Option<TokenStream>,
    /// Its `impl`s.
    pub impls: TokenStream,
}

impl TypeTokens {
    /// The type of `interface` with these `impl`s, whose functions read `numbers` numbers that are given at run time.
    pub(super) fn new(interface: &PublicInterface, numbers: usize, impls: TokenStream) -> TypeTokens {
        let (given, length) = (local(GIVEN), Literal::usize_unsuffixed(numbers));
        let fields = is_parametric(interface).then(|| quote!(<S = f64> { #given: [S; #length] }));
        TypeTokens { fields, impls }
    }

    /// What follows the name of the struct in its declaration.
    pub fn declaration(&self) -> TokenStream {
        self.fields.clone().unwrap_or(quote!(;))
    }

    /// The traits that the struct derives by default.
    pub fn derives(&self) -> TokenStream {
        // The default of a type with parameters is the robot of the model.
        if self.fields.is_some() { quote!(Clone, Copy, Debug) } else { quote!(Clone, Copy, Debug, Default) }
    }
}

/// How the functions of a type are declared and called: associated functions over any scalar, or methods of a type that
/// has its numbers in one scalar, `P` in traits, where they are lifted to the scalar `S` of the computation.
pub struct Form {
    /// The generic parameters of an inherent function.
    pub function: TokenStream,
    /// The first argument of an inherent function.
    pub receiver: TokenStream,
    /// What stands before the name of an inherent function that another one calls.
    pub caller: TokenStream,
    /// The statement by which an inherent function reads the numbers.
    pub reads: TokenStream,
    /// The arguments of the type in `impl`s of traits.
    pub arguments: TokenStream,
    /// The generic parameters of an `impl` of a trait that does not depend on the scalar.
    pub generics: TokenStream,
    /// Those of an `impl` of a trait over the scalar, after it.
    pub over_scalar: TokenStream,
    /// A further bound there, for derivatives.
    pub over_dual: TokenStream,
    /// What stands before the name of an inherent function that a method of a trait calls.
    pub caller_in_trait: TokenStream,
    /// The statement by which a method of a trait reads the numbers.
    pub reads_in_trait: TokenStream,
}

impl Form {
    /// The form of the functions of a type.
    pub fn of(interface: &PublicInterface, runtime: &TokenStream) -> Form {
        if is_parametric(interface) {
            let given = local(GIVEN);
            Form {
                function: quote!(),
                receiver: quote!(&self,),
                caller: quote!(self.),
                reads: quote!(let #given = &self.#given;),
                arguments: quote!(<P>),
                generics: quote!(<P: #runtime::Scalar>),
                over_scalar: quote!(, P: #runtime::Scalar + #runtime::Lift<S>),
                over_dual: quote!(+ #runtime::Lift<#runtime::Dual<S>>),
                caller_in_trait: quote!(self.lifted::<S>().),
                reads_in_trait: quote!(let #given = self.lifted::<S>().#given;),
            }
        } else {
            Form {
                function: quote!(S: #runtime::Scalar),
                receiver: quote!(),
                caller: quote!(Self::),
                reads: quote!(),
                arguments: quote!(),
                generics: quote!(),
                over_scalar: quote!(),
                over_dual: quote!(),
                caller_in_trait: quote!(Self::),
                reads_in_trait: quote!(),
            }
        }
    }
}

/// The constants of the parameters.
pub fn constants(interface: &PublicInterface) -> TokenStream {
    let np = length_of(interface, interface.parameters.len());
    let names = interface.parameters.iter().map(|parameter| &parameter.name);
    let values = interface.parameters.iter().map(|parameter| constant(parameter.value));
    quote! {
        /// Number of run-time parameters.
        pub const NP: usize = #np;
        /// Names of the run-time parameters.
        pub const PARAMETER_NAMES: [&'static str; #np] = [#(#names),*];
        /// The values that the run-time parameters have in the model.
        pub const PARAMETERS: [f64; #np] = [#(#values),*];
    }
}

/// The functions that make the type from its parameters; nothing for a type without.
pub fn constructors(
    interface: &PublicInterface,
    lumped: Option<&Program>,
    name: &Ident,
    runtime: &TokenStream,
) -> TokenStream {
    if !is_parametric(interface) {
        return TokenStream::new();
    }
    let (np, given) = (length_of(interface, interface.parameters.len()), local(GIVEN));
    let new = match lumped {
        Some(program) => {
            body(program, &[], runtime, &Schedule::default(), |outputs| quote!(#name { #given: [#(#outputs),*] }))
        }
        None => quote!(::core::unreachable!()),
    };
    let rules = interface.parameters.iter().map(|parameter| match parameter.rule {
        ParameterRule::NotNegative => quote!(NotNegative),
        ParameterRule::Positive => quote!(Positive),
        ParameterRule::Inertia => quote!(Inertia),
        ParameterRule::Quaternion => quote!(Quaternion),
        _ => quote!(Finite),
    });
    quote! {
        #[allow(dead_code, unused_variables, clippy::all, clippy::pedantic)]
        impl<S: #runtime::Scalar> #name<S> {
            /// The robot with the given parameters, in the order of `PARAMETER_NAMES`: kg, m, kg m² and so on.
            ///
            /// What depends on them alone is computed here, once. Parameters are not checked;
            /// [`try_new`](Self::try_new) checks them.
            pub fn new(#given: &[S; #np]) -> Self {
                #new
            }

            /// The robot with the given parameters, if a rigid body and its joint can have them.
            ///
            /// # Errors
            ///
            /// The first parameter that violates a rule: one that is not finite, a negative mass, armature, damping,
            /// friction or stiffness, a friction velocity that is not positive, or an inertia tensor that no rigid body
            /// has. In a model file, a tensor that violates the triangle inequality is reported by the lint
            /// `inertia-triangle`; here it is an error.
            pub fn try_new(
                parameters: &[S; #np],
            ) -> ::core::result::Result<Self, #runtime::ParameterError>
            where
                S: #runtime::Real,
            {
                const RULES: [#runtime::ParameterRule; #np] = [#(#runtime::ParameterRule::#rules),*];
                #runtime::check_parameters(parameters, &<#name>::PARAMETER_NAMES, &RULES)?;
                ::core::result::Result::Ok(Self::new(parameters))
            }

            /// The same robot over another scalar.
            #[inline(always)]
            pub fn lifted<T: #runtime::Scalar>(&self) -> #name<T>
            where
                S: #runtime::Lift<T>,
            {
                #name { #given: self.#given.map(#runtime::Lift::lift) }
            }
        }
        impl<S: #runtime::Scalar> ::core::default::Default for #name<S> {
            /// The robot with the parameters of the model.
            fn default() -> Self {
                Self::new(&<#name>::PARAMETERS.map(S::from_f64))
            }
        }
    }
}
