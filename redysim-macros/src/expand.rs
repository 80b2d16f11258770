//! From a declaration to code: the mechanism, warnings and errors.

use crate::declaration::Declaration;
use crate::locate::{Located, shown};
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use redysim_codegen::passes::Passes;
use redysim_codegen::{TypeTokens, implementation_with, stub};
use redysim_model::{Diagnostic, Diagnostics, Model, PublicInterface, Severity};
use syn::Attribute;

/// The struct and its `impl`s.
pub fn struct_and_impls(declaration: &Declaration) -> TokenStream {
    let Declaration { attributes, visibility, name, .. } = declaration;
    let tokens = tokens(declaration);
    let (body, derives, impls) = (tokens.declaration(), tokens.derives(), &tokens.impls);
    let has_own = attributes.iter().any(|attribute| attribute.path().is_ident("derive"));
    let derive = (!has_own).then(|| quote!(#[derive(#derives)]));
    quote! {
        #(#attributes)*
        #derive
        #visibility struct #name #body
        #impls
    }
}

/// The `impl`s of a unit struct in the caller's code, which cannot have run-time parameters: these take a field.
pub fn impls(declaration: &Declaration) -> TokenStream {
    let TypeTokens { fields, impls } = tokens(declaration);
    if fields.is_none() {
        return impls;
    }
    let message = format!(
        "a mechanism with `parameters` has a field for them: declare it by `redysim! {{ struct {}(..); }}` in place of \
         the derive",
        declaration.name
    );
    let error = compile_error(&message, declaration.model.span());
    let TypeTokens { impls, .. } = stub(&PublicInterface::default(), &declaration.name, &runtime(), &error);
    quote!(const _: () = { #impls };)
}

/// The type, whose `impl`s come with the messages about its model.
fn tokens(declaration: &Declaration) -> TypeTokens {
    let Declaration { name, model, options, .. } = declaration;
    let runtime = runtime();
    let located = Located::new(model);
    let file = &located.path;
    let registered = file.to_str().filter(|_| file.is_file()).map(|path| {
        // So that the compiler tracks the file as a dependency.
        quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        )
    });
    // The stub has the first error; the others stand beside it.
    let mut others = Vec::new();
    let (diagnostics, warnings, TypeTokens { fields, impls }) =
        match Model::load_with(file, shown(file), options.text.as_str()) {
            Ok(loaded) => match implementation_with(&loaded.model, name, &runtime, &loaded.options, &Passes::default())
            {
                Ok(generated) => (loaded.warnings, generated.warnings, generated.tokens),
                Err(error) => {
                    let error = compile_error(&error.to_string(), model.span());
                    let interface = PublicInterface::new(&loaded.model, &loaded.options);
                    (loaded.warnings, Vec::new(), stub(&interface, name, &runtime, &error))
                }
            },
            Err(faults) => {
                let missing = located.missing().map(|message| compile_error(&message, model.span()));
                let errors = || {
                    let (shown, more) = Diagnostics::shown(faults.errors());
                    let shown = shown.into_iter().map(|error| (message(error), place(declaration, error)));
                    let all = shown.chain(more.into_iter().map(|more| (more, model.span())));
                    all.map(|(message, place)| compile_error(&message, place)).collect()
                };
                let mut errors: Vec<_> = missing.map_or_else(errors, |error| vec![error]);
                let first = errors.remove(0);
                others = errors;
                (faults.diagnostics.0, Vec::new(), stub(&faults.interface, name, &runtime, &first))
            }
        };
    let odd = diagnostics.iter().filter(|diagnostic| diagnostic.severity() != Severity::Error);
    let (odd, more) = Diagnostics::shown(odd);
    let odd =
        odd.into_iter().map(|warning| compile_warning(declaration, &message(warning), place(declaration, warning)));
    let warnings = more.iter().chain(&warnings).map(|warning| compile_warning(declaration, warning, model.span()));
    let cfgs = cfgs(declaration);
    let impls = quote! {
        #(#odd)*
        #(#warnings)*
        #(#cfgs)*
        const _: () = {
            #registered
            #impls
            #(#others;)*
        };
    };
    TypeTokens { fields, impls }
}

/// The path of the crate that generated code uses.
fn runtime() -> TokenStream {
    quote!(::redysim::runtime)
}

/// The `cfg` attributes of the struct, which its `impl`s and messages need as well.
fn cfgs(declaration: &Declaration) -> impl Iterator<Item = &Attribute> {
    declaration.attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

/// An expression, or an item before `;`, that is this error.
fn compile_error(message: &str, span: Span) -> TokenStream {
    quote_spanned!(span=> ::core::compile_error!(#message))
}

/// Where the compiler shows a diagnostic: at an option in the declaration, or at the path of the model.
fn place(declaration: &Declaration, diagnostic: &Diagnostic) -> Span {
    let option = diagnostic.span_beside().and_then(|range| declaration.options.span_of(&range));
    option.unwrap_or(declaration.model.span())
}

/// The compiler's message: with the line of the model file, unless the compiler shows that of the declaration.
fn message(diagnostic: &Diagnostic) -> String {
    if diagnostic.span_beside().is_some() {
        return format!("{}\n = help: {}", diagnostic.title(), diagnostic.help());
    }
    let picture = diagnostic.to_string();
    // The compiler shows the severity itself.
    picture.find(diagnostic.title()).map_or(picture.as_str(), |title| &picture[title..]).to_string()
}

/// A compiler warning: the use of a deprecated constant, with the warning as its note.
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
