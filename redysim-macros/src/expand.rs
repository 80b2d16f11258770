//! From a declaration to code: the mechanism, its warnings, or its faults.

use crate::declaration::Declaration;
use crate::locate::{model_file, shown};
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use redysim_codegen::passes::Passes;
use redysim_codegen::{implementation_with, stub};
use redysim_model::{Diagnostic, Model, Outline, Severity};
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
    let Declaration { name, model, scene, .. } = declaration;
    let runtime = quote!(::redysim::runtime);
    let file = model_file(model);
    let registered = file.to_str().filter(|_| file.is_file()).map(|path| {
        // The compiler then knows that the code depends on the file.
        quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        )
    });
    let (diagnostics, warnings, implementation) = match Model::load_with(&file, shown(&file), scene.text.as_str()) {
        Ok(loaded) => match implementation_with(&loaded.model, name, &runtime, &loaded.scene, &Passes::default()) {
            Ok(generated) => (loaded.warnings, generated.warnings, generated.tokens),
            Err(changed) => {
                let error = compile_error(declaration, &changed.to_string(), model.span());
                let outline = Outline::new(&loaded.model, &loaded.scene);
                (loaded.warnings, Vec::new(), [error, stub(&outline, name, &runtime)].into_iter().collect())
            }
        },
        Err(faults) => (faults.diagnostics.0, Vec::new(), stub(&faults.outline, name, &runtime)),
    };
    let messages = diagnostics.iter().map(|diagnostic| {
        let (message, span) = (message(diagnostic), place(declaration, diagnostic));
        match diagnostic.severity() {
            Severity::Error => compile_error(declaration, &message, span),
            _ => compile_warning(declaration, &message, span),
        }
    });
    let warnings = warnings.iter().map(|warning| compile_warning(declaration, warning, model.span()));
    let cfgs = cfgs(declaration);
    quote! {
        #(#messages)*
        #(#warnings)*
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

fn compile_error(declaration: &Declaration, message: &str, span: Span) -> TokenStream {
    let cfgs = cfgs(declaration);
    quote_spanned!(span=> #(#cfgs)* ::core::compile_error!(#message);)
}

/// Where the compiler shows a diagnostic: at what was asked for in the declaration, or at the path of the model.
fn place(declaration: &Declaration, diagnostic: &Diagnostic) -> Span {
    let asked = diagnostic.span_in_scene().and_then(|range| declaration.scene.span_of(&range));
    asked.unwrap_or(declaration.model.span())
}

/// What the compiler says: with the line of the model file, but where it shows a line of the declaration itself.
fn message(diagnostic: &Diagnostic) -> String {
    if diagnostic.span_in_scene().is_some() {
        return format!("{}\n = help: {}", diagnostic.title(), diagnostic.help());
    }
    let picture = diagnostic.to_string();
    let severity = match diagnostic.severity() {
        Severity::Error => "error: ",
        _ => "warning: ",
    };
    picture.strip_prefix(severity).unwrap_or(&picture).to_string()
}

/// A compiler warning: the use of a constant that is deprecated for what the warning says.
fn compile_warning(declaration: &Declaration, note: &str, span: Span) -> TokenStream {
    let lints = declaration.attributes.iter().filter(is_lint_level);
    let cfgs = cfgs(declaration);
    quote_spanned! {span=>
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
