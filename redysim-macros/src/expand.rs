//! From a declaration to code: the mechanism, its warnings, or its faults.

use crate::declaration::Declaration;
use crate::locate::{model_file, shown};
use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};
use redysim_codegen::{implementation, stub};
use redysim_model::{Diagnostic, Model, Outline};
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
    let text = match std::fs::read_to_string(&file) {
        Ok(text) => text,
        Err(error) => {
            let message = format!("cannot read the model `{}`: {error}", file.display());
            let error = quote_spanned!(model.span()=> ::core::compile_error!(#message););
            let stub = stub(&Outline::default(), name, &runtime);
            return quote!(#registered #error #stub);
        }
    };
    let implementation = match Model::from_toml(text, shown(&file)) {
        Ok(loaded) => {
            let warnings = loaded.warnings.iter().map(|warning| compile_warning(declaration, warning));
            let code = implementation(&loaded.model, name, &runtime).tokens;
            quote!(#(#warnings)* #code)
        }
        Err(faults) => {
            let errors = faults.diagnostics.iter().map(|fault| {
                let message = fault.to_string();
                let message = message.strip_prefix("error: ").unwrap_or(&message);
                quote_spanned!(model.span()=> ::core::compile_error!(#message);)
            });
            let stub = stub(&faults.outline, name, &runtime);
            quote!(#(#errors)* #stub)
        }
    };
    quote!(#registered #implementation)
}

/// A compiler warning: the use of a constant that is deprecated for what the warning says.
fn compile_warning(declaration: &Declaration, warning: &Diagnostic) -> TokenStream {
    let lints = declaration.attributes.iter().filter(is_lint_level);
    let note = warning.to_string();
    let note = note.strip_prefix("warning: ").unwrap_or(&note);
    quote_spanned! {declaration.model.span()=>
        #(#lints)*
        const _: () = {
            #[deprecated(note = #note)]
            const MODEL_WARNING: () = ();
            MODEL_WARNING
        };
    }
}

fn is_lint_level(attribute: &&Attribute) -> bool {
    ["allow", "expect", "warn", "deny", "forbid"].iter().any(|level| attribute.path().is_ident(level))
}
