//! The runtime's traits, for a type that has their functions.

use super::body::{GIVEN, local};
use super::function::{arguments, parameters};
use super::parametric::is_parametric;
use super::{length, results};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, PublicInterface};
use redysim_runtime::function::{Dimension, Interface};

/// The trait that has the function alone; nothing for a function of a trait that has several.
pub fn own(function: Function, interface: &PublicInterface, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let (trait_name, tangent) = match function.signature().interface {
        Interface::Own(trait_name) => (trait_name, None),
        Interface::WithTangent(trait_name) => (trait_name, Some(tangent(function, interface, runtime))),
        Interface::LoopClosure | Interface::Frames | Interface::ConfigurationSpace => return TokenStream::new(),
    };
    let trait_name = format_ident!("{trait_name}");
    let method = own_method(function, interface, runtime);
    let with_dual = is_parametric(interface) && tangent.is_some();
    let dual = with_dual.then(|| quote!(+ #runtime::Lift<#runtime::Dual<S>>));
    let (generics, of) = over_scalars(interface, runtime, &dual.unwrap_or_default());
    quote! {
        impl<S: #runtime::Scalar #generics> #runtime::#trait_name<S> for #name #of {
            #method
            #tangent
        }
    }
}

/// The generic parameters of an `impl` of functions over the scalar `S`, and the arguments of the type in it: a type
/// with parameters has its numbers in any `P` that can be lifted to `S`.
fn over_scalars(interface: &PublicInterface, runtime: &TokenStream, more: &TokenStream) -> (TokenStream, TokenStream) {
    if is_parametric(interface) {
        (quote!(, P: #runtime::Scalar + #runtime::Lift<S> #more), quote!(<P>))
    } else {
        (TokenStream::new(), TokenStream::new())
    }
}

/// The derivative of a function whose trait asks for one: the same code over dual numbers.
fn tangent(function: Function, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let name = format_ident!("{}_tangent", function.name());
    let derivative = if is_parametric(interface) {
        let own = format_ident!("{}", function.name());
        let arguments = [0, 1, 2].map(Literal::usize_unsuffixed).map(|argument| {
            quote!(&::core::array::from_fn(|i| #runtime::Dual { value: at.#argument[i], slope: slopes.#argument[i] }))
        });
        quote!(self.lifted::<#runtime::Dual<S>>().#own(#(#arguments),*).map(|result| result.slope))
    } else {
        let name = &name;
        quote!(#runtime::#name(self, at, slopes))
    };
    quote! {
        fn #name(
            &self,
            at: #runtime::Arguments<'_, S, Self>,
            slopes: #runtime::Arguments<'_, S, Self>,
        ) -> ::core::option::Option<Self::Velocities> {
            ::core::option::Option::Some(#derivative)
        }
    }
}

/// The method of a trait that is one of the type's own functions.
fn own_method(function: Function, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let (name, arguments) = (format_ident!("{}", function.name()), arguments(function));
    let caller = if is_parametric(interface) { quote!(self.lifted::<S>().) } else { quote!(Self::) };
    method(function, interface, runtime, &quote!(#caller #name(#(#arguments),*)))
}

/// The method of a trait with the given body.
fn method(function: Function, interface: &PublicInterface, runtime: &TokenStream, body: &TokenStream) -> TokenStream {
    let (name, parameters) = (format_ident!("{}", function.name()), parameters(function, interface, runtime));
    let output = results::output_type(function.signature().result, interface, runtime);
    quote! {
        #[inline]
        fn #name(&self, #(#parameters),*) -> #output {
            #body
        }
    }
}

/// The closure of the loops, for a type that has all of its functions.
pub fn closure(interface: &PublicInterface, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let own = Function::ALL.iter().copied().filter(|function| function.needs_loops());
    if !own.clone().all(|function| interface.functions.contains(function)) {
        return TokenStream::new();
    }
    let [nv, nc] = [Dimension::Velocities, Dimension::LoopRows].map(|dimension| length(interface, dimension));
    let methods = own.map(|function| own_method(function, interface, runtime));
    let ((generics, of), (numbers, _)) = (over_scalars(interface, runtime, &none()), of_numbers(interface, runtime));
    quote! {
        impl #numbers #runtime::LoopRows for #name #of {
            fn nc(&self) -> usize {
                <#name>::NC
            }
            fn loop_name(&self, row: usize) -> ::core::option::Option<&str> {
                <#name>::LOOP_NAMES.get(row).copied()
            }
        }
        impl<S: #runtime::Scalar #generics> #runtime::LoopClosure<S, #name #of> for #name #of {
            type Rows = [S; #nc];
            type Jacobian = [[S; #nv]; #nc];
            type Gram = [[S; #nc]; #nc];
            #(#methods)*
        }
    }
}

/// The frames of interest, for a type that has all of their functions.
pub fn frames(interface: &PublicInterface, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let own = Function::ALL.iter().copied().filter(|function| function.needs_frames());
    if !own.clone().all(|function| interface.functions.contains(function)) {
        return TokenStream::new();
    }
    let [nv, nf] = [Dimension::Velocities, Dimension::Frames].map(|dimension| length(interface, dimension));
    let methods = own.map(|function| own_method(function, interface, runtime));
    let (generics, of) = over_scalars(interface, runtime, &none());
    quote! {
        impl<S: #runtime::Scalar #generics> #runtime::Frames<S> for #name #of {
            type States = [#runtime::FrameState<S>; #nf];
            type Jacobians = [#runtime::FrameJacobian<[S; #nv]>; #nf];
            type Accelerations = [#runtime::FrameAcceleration<S>; #nf];
            type Wrenches = [#runtime::Wrench<S>; #nf];
            #(#methods)*
        }
    }
}

fn none() -> TokenStream {
    TokenStream::new()
}

/// The generic parameters of an `impl` that does not depend on the scalar, and the arguments of the type in it.
fn of_numbers(interface: &PublicInterface, runtime: &TokenStream) -> (TokenStream, TokenStream) {
    if is_parametric(interface) { (quote!(<P: #runtime::Scalar>), quote!(<P>)) } else { (none(), none()) }
}

/// Sizes, names, and the space of positions with its functions, each with its code.
pub fn mechanism(
    interface: &PublicInterface,
    configuration: Vec<(Function, TokenStream)>,
    name: &Ident,
    runtime: &TokenStream,
) -> TokenStream {
    let [nq, nv, nl] =
        [Dimension::Coordinates, Dimension::Velocities, Dimension::Links].map(|dimension| length(interface, dimension));
    // Coordinates, velocities, and the energy of the actuators.
    let state = interface.size(Dimension::Coordinates) + interface.size(Dimension::Velocities) + 1;
    let state = Literal::usize_unsuffixed(state);
    let methods = configuration.into_iter().map(|(function, body)| {
        let given = local(GIVEN);
        let reads = is_parametric(interface).then(|| quote!(let #given = self.lifted::<S>().#given;));
        let method = method(function, interface, runtime, &quote!(#reads #body));
        quote!(#[allow(unused_variables, clippy::all, clippy::pedantic)] #method)
    });
    let ((generics, of), (numbers, _)) = (over_scalars(interface, runtime, &none()), of_numbers(interface, runtime));
    quote! {
        impl #numbers #runtime::Mechanism for #name #of {
            fn name(&self) -> &str {
                <#name>::NAME
            }
            fn nq(&self) -> usize {
                <#name>::NQ
            }
            fn nv(&self) -> usize {
                <#name>::NV
            }
            fn nl(&self) -> usize {
                <#name>::NL
            }
            fn link_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::LINK_NAMES.get(index).copied()
            }
            fn joint_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::JOINT_NAMES.get(index).copied()
            }
            fn nf(&self) -> usize {
                <#name>::NF
            }
            fn frame_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::FRAME_NAMES.get(index).copied()
            }
        }
        impl<S: #runtime::Scalar #generics> #runtime::ConfigurationSpace<S> for #name #of {
            type Coordinates = [S; #nq];
            type Velocities = [S; #nv];
            type State = [S; #state];
            type Matrix = [[S; #nv]; #nv];
            type Links = [#runtime::LinkState<S>; #nl];
            #(#methods)*
        }
    }
}
