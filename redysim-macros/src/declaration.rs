//! The input of the macros: a unit struct, the path of a model, and options.

use crate::options::OptionsText;
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, Data, DeriveInput, Error, Fields, Ident, LitStr, Result, Token, Visibility, parenthesized};

/// A struct that becomes the mechanism of a model.
pub struct Declaration {
    pub attributes: Vec<Attribute>,
    pub visibility: Visibility,
    pub name: Ident,
    pub model: LitStr,
    pub options: OptionsText,
}

/// A model and options: `"models/kr5.toml", functions = [mass_matrix]`.
struct Robot {
    model: LitStr,
    options: OptionsText,
}

impl Parse for Robot {
    fn parse(input: ParseStream) -> Result<Self> {
        let model = input.parse()?;
        if !input.is_empty() {
            input.parse::<Token![,]>()?;
        }
        Ok(Robot { model, options: input.parse()? })
    }
}

/// The input of `redysim!`: `pub struct Kr5("models/kr5.toml");`, with options after the path.
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
        let Robot { model, options } = content.parse()?;
        input.parse::<Option<Token![;]>>()?;
        if !input.is_empty() {
            return Err(Error::new(input.span(), "expected `struct Name(\"path/of/model.toml\");` and nothing else"));
        }
        Ok(Macro(Declaration { attributes, visibility, name: checked_name(name)?, model, options }))
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
        let Robot { model, options } = model.parse_args()?;
        Ok(Derive(Declaration { attributes: attrs, visibility: vis, name: checked_name(ident)?, model, options }))
    }
}

/// The name of a mechanism, which cannot be `S`: generated functions have a scalar type `S`.
fn checked_name(name: Ident) -> Result<Ident> {
    if name == "S" {
        return Err(Error::new(name.span(), "a mechanism cannot be called `S`: generated code means the scalar by it"));
    }
    Ok(name)
}
