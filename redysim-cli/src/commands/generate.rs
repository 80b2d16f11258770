//! `redysim generate MODEL`: the source that `redysim!` makes, for those who must review or ship it.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;

use crate::failure::Failure;
use crate::model;
use crate::output::{print, to_stderr, write_beside};
use redysim_codegen::{SourceError, source_file_with};
use redysim_model::{Function, Loaded, Model};

/// Print the Rust source that `redysim!` would make of a model.
///
/// The source stands by itself: it needs the crate redysim-runtime and nothing else. Its head states how many
/// operations each function takes. The same model gives the same bytes.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  redysim generate models/kr5.toml -o src/kr5.rs
  redysim generate models/kr5.toml --name Robot --functions inverse_dynamics,mass_matrix

In your Cargo.toml: redysim-runtime = { path = \"..\", default-features = false }")]
pub struct Arguments {
    /// The model file.
    model: PathBuf,
    /// Write to this file instead of printing.
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// The name of the Rust type [default: the model's name, as Rust writes types].
    #[arg(long)]
    name: Option<String>,
    /// Only these functions, beside those that every mechanism has [default: those that the model file asks for, or
    /// all].
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(names_of_functions()))]
    functions: Vec<String>,
    /// Overwrite a file that is there already.
    #[arg(long)]
    force: bool,
}

fn names_of_functions() -> impl Iterator<Item = &'static str> {
    Function::ALL.iter().map(|function| function.name())
}

/// Generates the source.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let loaded = load(arguments, quiet)?;
    let name = arguments.name.clone().unwrap_or_else(|| type_name(&loaded.model.name));
    let source = source_file_with(&loaded.model, &name, &loaded.options).map_err(|error| match error {
        SourceError::InvalidName(_) => Failure::input(error).help("give another name with --name"),
        _ => Failure::input(error),
    })?;
    let Some(path) = &arguments.output else { return print(&source) };
    write_beside(&arguments.model, path, source.as_bytes(), arguments.force)?;
    if !quiet {
        // The head of the source is the report; behind `// ` it reads as text.
        let head = source.lines().take_while(|line| line.starts_with("//"));
        head.for_each(|line| to_stderr(line.trim_start_matches("//").trim_start()));
        to_stderr(&format!("\n{name} is in {}", path.display()));
    }
    Ok(())
}

/// The model with the functions that are asked for here, checked as those of a declaration are.
fn load(arguments: &Arguments, quiet: bool) -> Result<Loaded, Failure> {
    if arguments.functions.is_empty() {
        return model::load(&arguments.model, quiet);
    }
    let names: Vec<String> = arguments.functions.iter().map(|name| format!("\"{name}\"")).collect();
    let options = format!("functions = [{}]", names.join(", "));
    let path = &arguments.model;
    model::loaded(path, Model::load_with(path, path.display().to_string(), options), quiet)
}

/// `kr5` is `Kr5`, `n-fourbar 2` is `NFourbar2`; a name that still is not one of a type, such as `3rrr`, is
/// `Mechanism3rrr`.
pub fn type_name(model: &str) -> String {
    let words = model.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let name: String = words
        .map(|word| {
            let mut letters = word.chars();
            letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
        })
        .collect();
    let begins_well = name.starts_with(|c: char| c.is_alphabetic());
    if begins_well && name != "Self" { name } else { format!("Mechanism{name}") }
}

#[cfg(test)]
mod tests {
    use super::type_name;

    #[test]
    fn every_model_has_a_name_for_a_type() {
        let names = [("kr5", "Kr5"), ("n-fourbar 2", "NFourbar2"), ("3-RRR", "Mechanism3RRR"), ("…", "Mechanism")];
        for (model, name) in names.into_iter().chain([("self", "MechanismSelf"), ("größe", "Größe")]) {
            assert_eq!(type_name(model), name);
        }
    }
}
