//! From a declaration to code: the mechanism, its warnings, or its faults.

use crate::declaration::Declaration;
use crate::locate::{model_file, shown};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use redysim_codegen::{implementation, stub};
use redysim_model::{Diagnostic, Model, Severity};
use syn::Attribute;

/// The struct and its `impl`s.
pub fn declared(declaration: &Declaration) -> TokenStream {
    let Declaration { attributes, visibility, name, .. } = declaration;
    let derive = if attributes.iter().any(|attribute| attribute.path().is_ident("derive")) {
        None
    } else {
        Some(quote!(#[derive(Clone, Copy, Debug, Default)]))
    };
    let implementation = derived(declaration);
    quote! {
        #(#attributes)*
        #derive
        #visibility struct #name;
        #implementation
    }
}

/// The `impl`s of a struct that stands in the caller's code.
pub fn derived(declaration: &Declaration) -> TokenStream {
    let Declaration { name, model, .. } = declaration;
    let runtime = quote!(::redysim::runtime);
    let file = model_file(model);
    let registered = file.to_str().filter(|_| file.is_file()).map(|path| {
        // The compiler then knows that the code depends on the file.
        quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        )
    });
    let (diagnostics, implementation) = match Model::load_as(&file, shown(&file)) {
        Ok(loaded) => (loaded.warnings, implementation(&loaded.model, name, &runtime).tokens),
        Err(faults) => (faults.diagnostics, stub(&faults.outline, name, &runtime)),
    };
    let messages = diagnostics.iter().map(|diagnostic| match diagnostic.severity() {
        Severity::Error => compile_error(declaration, diagnostic),
        Severity::Warning => compile_warning(declaration, diagnostic),
    });
    let cfgs = cfgs(declaration);
    quote! {
        #(#messages)*
        #(#cfgs)*
        const _: () = {
            #registered
            #implementation
        };
    }
}

/// What the existence of the struct, and so of all that belongs to it, depends on.
fn cfgs(declaration: &Declaration) -> impl Iterator<Item = &Attribute> {
    declaration.attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

fn compile_error(declaration: &Declaration, error: &Diagnostic) -> TokenStream {
    let message = error.to_string();
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    let cfgs = cfgs(declaration);
    quote_spanned!(declaration.model.span()=> #(#cfgs)* ::core::compile_error!(#message);)
}

/// A compiler warning: the use of a constant that is deprecated for what the warning says.
fn compile_warning(declaration: &Declaration, warning: &Diagnostic) -> TokenStream {
    let lints = declaration.attributes.iter().filter(is_lint_level);
    let note = warning.to_string();
    let note = note.strip_prefix("warning: ").unwrap_or(&note);
    let cfgs = cfgs(declaration);
    quote_spanned! {declaration.model.span()=>
        #(#cfgs)*
        #(#lints)*
        const _: () = {
            #[deprecated(note = #note)]
            const MODEL_WARNING: () = ();
            MODEL_WARNING
        };
    }
}

fn is_lint_level(attribute: &&Attribute) -> bool {
    ["allow", "warn", "deny", "forbid"].iter().any(|level| attribute.path().is_ident(level))
}
