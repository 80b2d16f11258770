//! How coordinates move with velocities: the methods of `ConfigurationSpace`.

use super::body::{body, local};
use super::length;
use super::results::array;
use crate::configuration::{CONFIGURATION_FUNCTIONS, ConfigurationFunction};
use crate::program::Program;
use proc_macro2::TokenStream;
use quote::quote;
use redysim_model::PublicInterface;

/// The methods with the given programs. `None` is for an invalid model: the methods have signatures and no code.
pub fn methods(programs: Option<&[Program]>, interface: &PublicInterface) -> TokenStream {
    let program = |index: usize| programs.map(|programs| &programs[index]);
    let functions = CONFIGURATION_FUNCTIONS.iter().enumerate();
    functions.map(|(index, function)| definition(function, program(index), interface)).collect()
}

fn definition(function: &ConfigurationFunction, program: Option<&Program>, interface: &PublicInterface) -> TokenStream {
    let (name, result) = (local(function.name), length(interface, function.result));
    let parameters = function.arguments.iter().map(|&(argument, dimension)| {
        let (argument, length) = (local(argument), length(interface, dimension));
        quote!(#argument: &[S; #length])
    });
    let body = program
        .map_or_else(|| quote!(::core::unreachable!()), |program| body(program, &function.argument_names(), array));
    quote! {
        #[allow(unused_variables, clippy::all, clippy::pedantic)]
        #[inline]
        fn #name(&self, #(#parameters),*) -> [S; #result] {
            #body
        }
    }
}
