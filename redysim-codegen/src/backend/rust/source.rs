//! The generated code as a formatted source file, to be reviewed or shipped.

use crate::backend::head;
use crate::backend::lines::{WIDTH, wrap};
use crate::generate::{Generated, implementation_with};
use crate::passes::{PassError, Passes};
use quote::{format_ident, quote};
use redysim_model::{CodegenOptions, Model};

/// A Rust module that declares the struct `name` and makes it the mechanism of `model`, as `redysim!` does.
///
/// It needs the crate `redysim_runtime` and nothing else. The same model gives the same bytes.
///
/// # Errors
///
/// If `name` is not an identifier; in debug builds, if a pass over expressions is wrong.
pub fn source_file(model: &Model, name: &str) -> Result<String, SourceError> {
    source_file_with(model, name, &CodegenOptions::default())
}

/// The same with options.
///
/// # Errors
///
/// As [`source_file`].
pub fn source_file_with(model: &Model, name: &str, options: &CodegenOptions) -> Result<String, SourceError> {
    if syn::parse_str::<syn::Ident>(name).is_err() {
        return Err(SourceError::InvalidName(name.to_string()));
    }
    let name = format_ident!("{name}");
    let Generated { tokens, operations, warnings } =
        implementation_with(model, &name, &quote!(::redysim_runtime), options, &Passes::default())?;
    let (declaration, derives, impls) = (tokens.declaration(), tokens.derives(), &tokens.impls);
    let doc = format!(" The mechanism `{}`.", model.name);
    let file = quote! {
        #[doc = #doc]
        #[derive(#derives)]
        pub struct #name #declaration
        #impls
    };
    let file = syn::parse2(file).expect("generated code is Rust");
    let lines = head::lines(model, &operations, &warnings);
    let wrapped = lines.iter().flat_map(|line| wrap(line, WIDTH - "// ".len()));
    let header: String = wrapped.map(|line| format!("// {line}").trim_end().to_string() + "\n").collect();
    Ok(header + "\n" + &prettyplease::unparse(&file))
}

/// Why a source file cannot be generated.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SourceError {
    /// A name that cannot be a Rust type.
    InvalidName(String),
    /// A name that cannot be the prefix of names in C.
    InvalidPrefix(String),
    /// A model with closed loops, of which the first has this name, where the coordinates must be independent states.
    ClosedLoop(String),
    /// A pass over expressions is wrong.
    Pass(PassError),
}

impl From<PassError> for SourceError {
    fn from(error: PassError) -> Self {
        SourceError::Pass(error)
    }
}

impl std::fmt::Display for SourceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SourceError::InvalidName(name) => {
                write!(f, "`{name}` is not a valid name for a Rust type; write for example `Robot`")
            }
            SourceError::InvalidPrefix(name) => write!(
                f,
                "`{name}` cannot begin the names of C: it must have ASCII letters, digits and underscores, a letter first, \
                 and not be a name of the standard library or, for C++, a keyword; write for example `robot`"
            ),
            SourceError::ClosedLoop(name) => write!(
                f,
                "an FMU has the coordinates as independent states, but the loop `{name}` makes them depend on each other"
            ),
            SourceError::Pass(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SourceError {}
