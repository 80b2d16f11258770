//! From a declaration to code: the mechanism, warnings and errors.

use crate::declaration::Declaration;
use crate::locate::{model_file, shown};
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use redysim_codegen::passes::Passes;
use redysim_codegen::{implementation_with, stub, stub_declaration};
use redysim_model::{Diagnostic, Model, PublicInterface, Severity};
use syn::Attribute;

/// The struct and its `impl`s.
pub fn struct_and_impls(declaration: &Declaration) -> TokenStream {
    let Declaration { attributes, visibility, name, .. } = declaration;
    let Expanded { declaration: body, derives, implementation, .. } = expanded(declaration);
    let derive = if attributes.iter().any(|attribute| attribute.path().is_ident("derive")) {
        None
    } else {
        Some(quote!(#[derive(#derives)]))
    };
    quote! {
        #(#attributes)*
        #derive
        #visibility struct #name #body
        #implementation
    }
}

/// The `impl`s of a struct in the caller's code, which cannot have parameters: these take a field.
pub fn impls(declaration: &Declaration) -> TokenStream {
    let Expanded { is_parametric, implementation, .. } = expanded(declaration);
    if is_parametric {
        let message = format!(
            "a mechanism with `parameters` has a field for them: declare it by `redysim! {{ struct {}(..); }}` in place of \
             the derive",
            declaration.name
        );
        return compile_error(declaration, &message, declaration.model.span());
    }
    implementation
}

/// What a declaration becomes.
struct Expanded {
    /// What follows the name of the struct.
    declaration: TokenStream,
    /// The traits that the struct derives by default.
    derives: TokenStream,
    is_parametric: bool,
    /// Messages and `impl`s.
    implementation: TokenStream,
}

fn expanded(declaration: &Declaration) -> Expanded {
    let Declaration { name, model, options, .. } = declaration;
    let runtime = quote!(::redysim::runtime);
    let file = model_file(model);
    let registered = file.to_str().filter(|_| file.is_file()).map(|path| {
        // So that the compiler tracks the file as a dependency.
        quote!(
            const _: &[u8] = ::core::include_bytes!(#path);
        )
    });
    let stubbed = |interface: &PublicInterface| {
        let is_parametric = !interface.parameters.is_empty();
        (stub_declaration(interface), is_parametric, stub(interface, name, &runtime))
    };
    let (diagnostics, warnings, (struct_body, is_parametric, implementation)) =
        match Model::load_with(&file, shown(&file), options.text.as_str()) {
            Ok(loaded) => match implementation_with(&loaded.model, name, &runtime, &loaded.options, &Passes::default())
            {
                Ok(generated) => {
                    let struct_body = (generated.declaration, generated.derives);
                    let is_parametric = !loaded.options.parameters.is_empty();
                    (loaded.warnings, generated.warnings, (struct_body, is_parametric, generated.tokens))
                }
                Err(error) => {
                    let error = compile_error(declaration, &error.to_string(), model.span());
                    let interface = PublicInterface::new(&loaded.model, &loaded.options);
                    let (struct_body, is_parametric, stub) = stubbed(&interface);
                    (loaded.warnings, Vec::new(), (struct_body, is_parametric, quote!(#error #stub)))
                }
            },
            Err(faults) => (faults.diagnostics.0, Vec::new(), stubbed(&faults.interface)),
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
    let implementation = quote! {
        #(#messages)*
        #(#warnings)*
        #(#cfgs)*
        const _: () = {
            #registered
            #implementation
        };
    };
    let (declaration, derives) = struct_body;
    Expanded { declaration, derives, is_parametric, implementation }
}

/// The `cfg` attributes of the struct, which its `impl`s and messages need as well.
fn cfgs(declaration: &Declaration) -> impl Iterator<Item = &Attribute> {
    declaration.attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

fn compile_error(declaration: &Declaration, message: &str, span: Span) -> TokenStream {
    let cfgs = cfgs(declaration);
    quote_spanned!(span=> #(#cfgs)* ::core::compile_error!(#message);)
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
