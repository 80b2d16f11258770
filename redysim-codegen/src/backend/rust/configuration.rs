//! How coordinates move with velocities: the methods of `ConfigurationSpace`.

use super::body::{body, local};
use super::length;
use super::results::array;
use crate::angles::Angles;
use crate::symbol::Symbol;
use crate::tracing::traced_of;
use proc_macro2::TokenStream;
use quote::quote;
use redysim_model::{PublicInterface, Tree, denoc};
use redysim_runtime::function::Dimension;

/// A function over coordinates and velocities: its name, its arguments, and what it computes.
struct Method {
    name: &'static str,
    arguments: &'static [(&'static str, Dimension)],
    result: Dimension,
    computed: for<'g> fn(&Tree, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
}

const METHODS: [Method; 4] = [
    Method {
        name: "coordinate_rates",
        arguments: &[("q", Dimension::Coordinates), ("v", Dimension::Velocities)],
        result: Dimension::Coordinates,
        computed: |tree, x| denoc::coordinate_rates(tree, x[0], x[1]),
    },
    Method {
        name: "integrate",
        arguments: &[("q", Dimension::Coordinates), ("dv", Dimension::Velocities)],
        result: Dimension::Coordinates,
        computed: |tree, x| denoc::integrate(tree, x[0], x[1]),
    },
    Method {
        name: "difference",
        arguments: &[("q0", Dimension::Coordinates), ("q1", Dimension::Coordinates)],
        result: Dimension::Velocities,
        computed: |tree, x| denoc::difference(tree, x[0], x[1]),
    },
    Method {
        name: "neutral",
        arguments: &[],
        result: Dimension::Coordinates,
        computed: |tree, _| denoc::neutral(tree),
    },
];

/// The methods, of the mechanism with the given tree; without one, of a model that has faults, they have types alone.
pub fn methods(tree: Option<&Tree>, interface: &PublicInterface) -> TokenStream {
    METHODS.iter().map(|method| method.definition(tree, interface)).collect()
}

impl Method {
    fn definition(&self, tree: Option<&Tree>, interface: &PublicInterface) -> TokenStream {
        let (name, result) = (local(self.name), length(interface, self.result));
        let parameters = self.arguments.iter().map(|&(argument, dimension)| {
            let (argument, length) = (local(argument), length(interface, dimension));
            quote!(#argument: &[S; #length])
        });
        let body = tree.map_or_else(|| quote!(::core::unreachable!()), |tree| self.body(tree, interface));
        quote! {
            #[allow(unused_variables, clippy::all, clippy::pedantic)]
            #[inline]
            fn #name(&self, #(#parameters),*) -> [S; #result] {
                #body
            }
        }
    }

    fn body(&self, tree: &Tree, interface: &PublicInterface) -> TokenStream {
        let lengths = self.arguments.iter().map(|&(_, dimension)| interface.size(dimension));
        let expressions = traced_of(lengths, |_, x| (self.computed)(tree, x));
        let arguments: Vec<&str> = self.arguments.iter().map(|&(argument, _)| argument).collect();
        body(&expressions, &arguments, &[], &Angles::of([&expressions]), array)
    }
}
