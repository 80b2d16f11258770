//! The runtime's traits, for a type that has their functions.

use super::function::{arguments, parameters};
use super::{length, results};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, PublicInterface};
use redysim_runtime::function::{Dimension, Interface};

/// The trait that has the function alone; nothing for a function of a trait that has several.
pub fn own(function: Function, interface: &PublicInterface, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let (trait_name, tangent) = match function.signature().interface {
        Interface::Own(trait_name) => (trait_name, None),
        Interface::WithTangent(trait_name) => (trait_name, Some(tangent(function, runtime))),
        Interface::LoopClosure | Interface::Frames | Interface::ConfigurationSpace => return TokenStream::new(),
    };
    let trait_name = format_ident!("{trait_name}");
    let method = own_method(function, interface, runtime);
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
            at: #runtime::Arguments<'_, S, Self>,
            slopes: #runtime::Arguments<'_, S, Self>,
        ) -> ::core::option::Option<Self::Velocities> {
            ::core::option::Option::Some(#runtime::#name(self, at, slopes))
        }
    }
}

/// The method of a trait that is one of the type's own functions.
fn own_method(function: Function, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let (name, arguments) = (format_ident!("{}", function.name()), arguments(function));
    method(function, interface, runtime, &quote!(Self::#name(#(#arguments),*)))
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
    quote! {
        impl #runtime::LoopRows for #name {
            fn nc(&self) -> usize {
                Self::NC
            }
            fn loop_name(&self, row: usize) -> ::core::option::Option<&str> {
                Self::LOOP_NAMES.get(row).copied()
            }
        }
        impl<S: #runtime::Scalar> #runtime::LoopClosure<S, #name> for #name {
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
    quote! {
        impl<S: #runtime::Scalar> #runtime::Frames<S> for #name {
            type States = [#runtime::FrameState<S>; #nf];
            type Jacobians = [#runtime::FrameJacobian<[S; #nv]>; #nf];
            type Accelerations = [#runtime::FrameAcceleration<S>; #nf];
            type Wrenches = [#runtime::Wrench<S>; #nf];
            #(#methods)*
        }
    }
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
        let method = method(function, interface, runtime, &body);
        quote!(#[allow(unused_variables, clippy::all, clippy::pedantic)] #method)
    });
    quote! {
        impl #runtime::Mechanism for #name {
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
            fn nf(&self) -> usize {
                Self::NF
            }
            fn frame_name(&self, index: usize) -> ::core::option::Option<&str> {
                Self::FRAME_NAMES.get(index).copied()
            }
        }
        impl<S: #runtime::Scalar> #runtime::ConfigurationSpace<S> for #name {
            type Coordinates = [S; #nq];
            type Velocities = [S; #nv];
            type State = [S; #state];
            type Matrix = [[S; #nv]; #nv];
            type Links = [#runtime::LinkState<S>; #nl];
            #(#methods)*
        }
    }
}
