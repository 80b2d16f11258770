//! What differs for a type that is given numbers at run time: it has a field with what depends on them alone, its
//! functions are methods, and the scalar is a parameter of the type.

use super::body::{GIVEN, body, constant, local};
use crate::program::Program;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use redysim_model::PublicInterface;
use redysim_runtime::ParameterRule;

/// Whether the type is given numbers at run time.
pub fn is_parametric(interface: &PublicInterface) -> bool {
    !interface.parameters.is_empty()
}

/// What follows the name of the struct in its declaration, and the traits that it may derive. `numbers` is how many
/// numbers its functions read; `None` for a type without parameters.
pub fn declaration(numbers: Option<usize>) -> (TokenStream, TokenStream) {
    match numbers {
        None => (quote!(;), quote!(Clone, Copy, Debug, Default)),
        Some(numbers) => {
            let (given, length) = (local(GIVEN), Literal::usize_unsuffixed(numbers));
            (quote!(<S = f64> { #given: [S; #length] }), quote!(Clone, Copy, Debug))
        }
    }
}

/// The same for a type whose model has faults.
pub fn stub_declaration(interface: &PublicInterface) -> (TokenStream, TokenStream) {
    declaration(is_parametric(interface).then_some(0))
}

/// How functions of a type are declared and called.
pub struct Form {
    /// The generic parameters of an inherent function.
    pub function: TokenStream,
    /// The first argument of an inherent function.
    pub receiver: TokenStream,
    /// What stands before the name of an inherent function that another one calls.
    pub caller: TokenStream,
    /// The statement by which the code of a function reads the numbers.
    pub reads: TokenStream,
}

impl Form {
    /// The form of the functions of a type.
    pub fn of(interface: &PublicInterface, runtime: &TokenStream) -> Form {
        let none = TokenStream::new;
        if is_parametric(interface) {
            let given = local(GIVEN);
            Form {
                function: none(),
                receiver: quote!(&self,),
                caller: quote!(self.),
                reads: quote!(let #given = &self.#given;),
            }
        } else {
            Form { function: quote!(<S: #runtime::Scalar>), receiver: none(), caller: quote!(Self::), reads: none() }
        }
    }
}

/// The constants of the parameters, and with any, the functions that make the type from them.
pub fn constants(interface: &PublicInterface) -> TokenStream {
    let np = Literal::usize_unsuffixed(interface.parameters.len());
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
    let (np, given) = (Literal::usize_unsuffixed(interface.parameters.len()), local(GIVEN));
    let new = match lumped {
        Some(program) => body(program, &[], |outputs| quote!(#name { #given: [#(#outputs),*] })),
        None => quote!(::core::unreachable!()),
    };
    let rules = interface.parameters.iter().map(|parameter| match parameter.rule {
        ParameterRule::NotNegative => quote!(NotNegative),
        ParameterRule::Positive => quote!(Positive),
        ParameterRule::Inertia => quote!(Inertia),
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
