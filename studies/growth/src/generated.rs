//! What the generator makes of a model, and how long it takes.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use redysim_codegen::passes::Passes;
use redysim_codegen::{Generated, implementation_with};
use redysim_model::{Function, Model};
use std::time::Instant;

/// The code of one mechanism.
pub struct Code {
    /// From reading the model to tokens, s.
    pub seconds: f64,
    /// A Rust module with the type `Robot`.
    pub source: String,
    /// Floating-point operations of inverse dynamics, forward dynamics and the mass matrix.
    pub flops: [u32; 3],
}

/// The code of the mechanism described by `text`.
pub fn code(text: &str, passes: &Passes) -> Code {
    let begun = Instant::now();
    let loaded = Model::from_toml(text.to_owned(), "model.toml").unwrap_or_else(|faults| panic!("{faults}"));
    let name = format_ident!("Robot");
    let Generated { tokens, operations, .. } =
        implementation_with(&loaded.model, &name, &quote!(::redysim::runtime), &loaded.options, passes)
            .unwrap_or_else(|error| panic!("{error}"));
    let seconds = begun.elapsed().as_secs_f64();
    let flops = [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix]
        .map(|function| operations.iter().find(|(name, _)| *name == function).map_or(0, |(_, count)| count.flops()));
    Code { seconds, source: module(&tokens.impls), flops }
}

fn module(tokens: &TokenStream) -> String {
    quote!(
        #[derive(Clone, Copy, Debug, Default)]
        pub struct Robot;
        #tokens
    )
    .to_string()
}
