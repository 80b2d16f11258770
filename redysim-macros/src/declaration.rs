//! What the macros are given: a unit struct and the path of a model.

use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Data, DeriveInput, Error, Fields, Ident, LitStr, Result, Token, Visibility, parenthesized};

/// A struct that is to be the mechanism of a model.
pub struct Declaration {
    pub attributes: Vec<Attribute>,
    pub visibility: Visibility,
    pub name: Ident,
    pub model: LitStr,
}

/// The input of `redysim!`: `pub struct Kr5("models/kr5.toml");`.
pub struct Macro(pub Declaration);

/// The input of the derive: a unit struct with the attribute `#[mechanism("models/kr5.toml")]`.
pub struct Derive(pub Declaration);

impl Parse for Macro {
    fn parse(input: ParseStream) -> Result<Self> {
        let attributes = input.call(Attribute::parse_outer)?;
        let visibility = input.parse()?;
        input.parse::<Token![struct]>()?;
        let name = input.parse()?;
        let content;
        parenthesized!(content in input);
        let model = content.parse()?;
        content.parse::<Option<Token![,]>>()?;
        input.parse::<Option<Token![;]>>()?;
        if !content.is_empty() || !input.is_empty() {
            let rest = if content.is_empty() { input.span() } else { content.span() };
            return Err(Error::new(rest, "expected `struct Name(\"path/of/model.toml\");` and nothing else"));
        }
        Ok(Macro(Declaration { attributes, visibility, name: usable(name)?, model }))
    }
}

impl Parse for Derive {
    fn parse(input: ParseStream) -> Result<Self> {
        let DeriveInput { attrs, vis, ident, generics, data } = input.parse()?;
        let is_unit = matches!(&data, Data::Struct(data) if matches!(data.fields, Fields::Unit));
        if !is_unit || !generics.params.is_empty() {
            return Err(Error::new(ident.span(), "a mechanism is a unit struct without generics: `struct Name;`"));
        }
        let mut models = attrs.iter().filter(|attribute| attribute.path().is_ident("mechanism"));
        let (model, more) = (models.next(), models.next());
        let Some(model) = model else {
            return Err(Error::new(ident.span(), "missing `#[mechanism(\"path/of/model.toml\")]`"));
        };
        if let Some(more) = more {
            return Err(Error::new_spanned(more, "a mechanism has one model; remove this attribute"));
        }
        let model = model.parse_args()?;
        Ok(Derive(Declaration { attributes: attrs, visibility: vis, name: usable(ident)?, model }))
    }
}

/// A name for a mechanism. Generated functions are over a scalar type `S`, which would hide a struct of that name.
fn usable(name: Ident) -> Result<Ident> {
    if name == "S" {
        return Err(Error::new(name.span(), "a mechanism cannot be called `S`: generated code means the scalar by it"));
    }
    Ok(name)
}
