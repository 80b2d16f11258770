//! The runtime's traits, for a type that has their functions.

use super::function::{arguments, parameters};
use super::parametric::{Form, is_parametric};
use super::{length, length_of, results};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, PublicInterface};
use redysim_runtime::VelocityCoordinates;
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
    let Form { over_scalar, over_dual, arguments, .. } = Form::of(interface, runtime);
    let over_dual = tangent.is_some().then_some(over_dual);
    quote! {
        impl<S: #runtime::Scalar #over_scalar #over_dual> #runtime::#trait_name<S> for #name #arguments {
            #method
            #tangent
        }
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
    let caller = Form::of(interface, runtime).caller_in_trait;
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
    let Form { generics, over_scalar, arguments, .. } = Form::of(interface, runtime);
    quote! {
        impl #generics #runtime::LoopRows for #name #arguments {
            fn nc(&self) -> usize {
                <#name>::NC
            }
            fn loop_name(&self, row: usize) -> ::core::option::Option<&str> {
                <#name>::LOOP_NAMES.get(row).copied()
            }
        }
        impl<S: #runtime::Scalar #over_scalar> #runtime::LoopClosure<S, #name #arguments> for #name #arguments {
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
    let Form { over_scalar, arguments, .. } = Form::of(interface, runtime);
    quote! {
        impl<S: #runtime::Scalar #over_scalar> #runtime::Frames<S> for #name #arguments {
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
    let state = length_of(interface, state);
    let Form { generics, over_scalar, arguments, reads_in_trait, .. } = Form::of(interface, runtime);
    let own_coordinates = own_coordinates(interface, runtime);
    let actuated = actuated(interface, name);
    let tangent = rates_tangent(interface, runtime);
    let methods = configuration.into_iter().map(|(function, body)| {
        let method = method(function, interface, runtime, &quote!(#reads_in_trait #body));
        quote!(#[allow(unused_variables, clippy::all, clippy::pedantic)] #method)
    });
    quote! {
        impl #generics #runtime::Mechanism for #name #arguments {
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
            fn coordinate_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::COORDINATE_NAMES.get(index).copied()
            }
            fn velocity_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::VELOCITY_NAMES.get(index).copied()
            }
            #actuated
            #own_coordinates
            fn nf(&self) -> usize {
                <#name>::NF
            }
            fn frame_name(&self, index: usize) -> ::core::option::Option<&str> {
                <#name>::FRAME_NAMES.get(index).copied()
            }
        }
        impl<S: #runtime::Scalar #over_scalar> #runtime::ConfigurationSpace<S> for #name #arguments {
            type Coordinates = [S; #nq];
            type Velocities = [S; #nv];
            type State = [S; #state];
            type Matrix = [[S; #nv]; #nv];
            type Links = [#runtime::LinkState<S>; #nl];
            #(#methods)*
            #tangent
        }
    }
}

/// The method `is_actuated`, for a mechanism in which some velocities do not have an actuator.
fn actuated(interface: &PublicInterface, name: &Ident) -> Option<TokenStream> {
    if interface.actuated().all(|actuated| actuated) {
        return None;
    }
    Some(quote! {
        fn is_actuated(&self, index: usize) -> bool {
            <#name>::ACTUATED.get(index).copied().unwrap_or(false)
        }
    })
}

/// Which coordinates each velocity changes, for a mechanism with a joint that has several.
fn own_coordinates(interface: &PublicInterface, runtime: &TokenStream) -> Option<TokenStream> {
    if !has_several_coordinates(interface) {
        return None;
    }
    let nv = length(interface, Dimension::Velocities);
    let kind = quote!(#runtime::VelocityCoordinates);
    let of_velocities = interface.moved_coordinates().into_iter().map(|moved| {
        let of = |variant: &str, first: usize| {
            let (variant, first) = (format_ident!("{variant}"), Literal::usize_unsuffixed(first));
            quote!(#kind::#variant(#first))
        };
        match moved {
            VelocityCoordinates::One(coordinate) => of("One", coordinate),
            VelocityCoordinates::Position(first) => of("Position", first),
            VelocityCoordinates::Quaternion(first) => of("Quaternion", first),
            VelocityCoordinates::Unknown => quote!(#kind::Unknown),
        }
    });
    Some(quote! {
        fn coordinate_of_velocity(&self, index: usize) -> ::core::option::Option<usize> {
            match self.coordinates_of_velocity(index) {
                #kind::One(coordinate) => ::core::option::Option::Some(coordinate),
                _ => ::core::option::Option::None,
            }
        }
        fn coordinates_of_velocity(&self, index: usize) -> #kind {
            const COORDINATES: [#kind; #nv] = [#(#of_velocities),*];
            COORDINATES.get(index).copied().unwrap_or(#kind::Unknown)
        }
    })
}

/// The derivative of the rates of coordinates, where they are not the velocities: the same code over dual numbers.
fn rates_tangent(interface: &PublicInterface, runtime: &TokenStream) -> Option<TokenStream> {
    if !has_several_coordinates(interface) || is_parametric(interface) {
        return None;
    }
    Some(quote! {
        fn coordinate_rates_tangent(
            &self,
            q: &Self::Coordinates,
            v: &Self::Velocities,
            dq: &Self::Coordinates,
        ) -> ::core::option::Option<Self::Coordinates> {
            ::core::option::Option::Some(#runtime::coordinate_rates_tangent(self, q, v, dq))
        }
    })
}

/// Whether a joint has more than one coordinate.
fn has_several_coordinates(interface: &PublicInterface) -> bool {
    interface.joints.iter().any(|joint| joint.coordinates.len() > 1)
}
