//! What a generated function returns: its type, and its value from the outputs of a graph.

use super::length;
use proc_macro2::TokenStream;
use quote::quote;
use redysim_model::PublicInterface;
use redysim_runtime::function::{Dimension, Shape};

/// The return type.
pub fn output_type(shape: Shape, interface: &PublicInterface, runtime: &TokenStream) -> TokenStream {
    let sizes =
        [Dimension::Coordinates, Dimension::Velocities, Dimension::Links, Dimension::LoopRows, Dimension::Frames];
    let [nq, nv, nl, nc, nf] = sizes.map(|dimension| length(interface, dimension));
    match shape {
        Shape::Coordinates => quote!([S; #nq]),
        Shape::Forces | Shape::Accelerations | Shape::Displacement => quote!([S; #nv]),
        Shape::MassMatrix | Shape::CoriolisMatrix => quote!([[S; #nv]; #nv]),
        Shape::Energy => quote!(#runtime::Energy<S>),
        Shape::Power => quote!(S),
        Shape::CenterOfMass => quote!(#runtime::CenterOfMass<S>),
        Shape::Momentum => quote!(#runtime::Momentum<S>),
        Shape::HybridMotion => quote!(#runtime::HybridMotion<[S; #nv]>),
        Shape::Links => quote!([#runtime::LinkState<S>; #nl]),
        Shape::LoopRows => quote!([S; #nc]),
        Shape::LoopJacobian => quote!([[S; #nv]; #nc]),
        Shape::Frames => quote!([#runtime::FrameState<S>; #nf]),
        Shape::FrameJacobians => quote!([#runtime::FrameJacobian<[S; #nv]>; #nf]),
        Shape::FrameAccelerations => quote!([#runtime::FrameAcceleration<S>; #nf]),
    }
}

/// The value returned, made of the outputs in the order in which they were traced.
pub fn value(shape: Shape, interface: &PublicInterface, outputs: &[TokenStream], runtime: &TokenStream) -> TokenStream {
    match shape {
        Shape::Forces | Shape::Accelerations | Shape::LoopRows | Shape::Coordinates | Shape::Displacement => {
            array(outputs)
        }
        Shape::MassMatrix | Shape::CoriolisMatrix | Shape::LoopJacobian => {
            array(&rows(outputs, interface.size(Dimension::Velocities)))
        }
        Shape::Energy => {
            let [kinetic, potential] = [&outputs[0], &outputs[1]];
            quote!(#runtime::Energy { kinetic: #kinetic, potential: #potential })
        }
        Shape::Power => outputs[0].clone(),
        Shape::CenterOfMass => {
            let vectors = rows(outputs, 3);
            let [position, velocity] = [&vectors[0], &vectors[1]];
            quote!(#runtime::CenterOfMass { position: #position, velocity: #velocity })
        }
        Shape::Momentum => {
            let vectors = rows(outputs, 3);
            let [linear, angular] = [&vectors[0], &vectors[1]];
            quote!(#runtime::Momentum { linear: #linear, angular: #angular })
        }
        Shape::HybridMotion => {
            let vectors = rows(outputs, interface.size(Dimension::Velocities));
            let [a, tau] = [&vectors[0], &vectors[1]];
            quote!(#runtime::HybridMotion { a: #a, tau: #tau })
        }
        Shape::Links => {
            let vectors = rows(outputs, 3);
            let links: Vec<TokenStream> = vectors.chunks(7).map(|link| link_state(link, runtime)).collect();
            array(&links)
        }
        Shape::Frames => {
            let vectors = rows(outputs, 3);
            let states: Vec<TokenStream> = vectors.chunks(6).map(|frame| frame_state(frame, runtime)).collect();
            array(&states)
        }
        Shape::FrameJacobians => {
            let rows = rows(outputs, interface.size(Dimension::Velocities));
            let jacobian = |rows: &[TokenStream]| {
                let [linear, angular] = [array(&rows[..3]), array(&rows[3..])];
                quote!(#runtime::FrameJacobian { linear: #linear, angular: #angular })
            };
            array(&rows.chunks(6).map(jacobian).collect::<Vec<_>>())
        }
        Shape::FrameAccelerations => {
            let vectors = rows(outputs, 3);
            let acceleration = |frame: &[TokenStream]| {
                let [linear, angular] = [&frame[0], &frame[1]];
                quote!(#runtime::FrameAcceleration { linear: #linear, angular: #angular })
            };
            array(&vectors.chunks(2).map(acceleration).collect::<Vec<_>>())
        }
    }
}

/// The seven vectors of a link: three rows of its rotation, then the others in the order of the fields.
fn link_state(vectors: &[TokenStream], runtime: &TokenStream) -> TokenStream {
    let rotation = array(&vectors[..3]);
    let [origin, com, velocity, angular_velocity] = [3, 4, 5, 6].map(|index| &vectors[index]);
    quote!(#runtime::LinkState {
        rotation: #rotation,
        origin: #origin,
        com: #com,
        velocity: #velocity,
        angular_velocity: #angular_velocity,
    })
}

/// The six vectors of a frame: three rows of its rotation, then the others in the order of the fields.
fn frame_state(vectors: &[TokenStream], runtime: &TokenStream) -> TokenStream {
    let rotation = array(&vectors[..3]);
    let [origin, velocity, angular_velocity] = [3, 4, 5].map(|index| &vectors[index]);
    quote!(#runtime::FrameState {
        rotation: #rotation,
        origin: #origin,
        velocity: #velocity,
        angular_velocity: #angular_velocity,
    })
}

fn rows(elements: &[TokenStream], length: usize) -> Vec<TokenStream> {
    elements.chunks(length).map(array).collect()
}

/// An array of values.
fn array(elements: &[TokenStream]) -> TokenStream {
    quote!([#(#elements),*])
}
