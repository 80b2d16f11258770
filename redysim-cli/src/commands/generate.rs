//! `redysim generate MODEL`.

use std::path::PathBuf;

use super::load;
use crate::failure::Failure;

/// Print the Rust source that `redysim!` would make of a model.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim generate models/kr5.toml -o kr5.rs")]
pub struct Arguments {
    /// The model file.
    model: PathBuf,
}

/// Generates the source.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let loaded = load(&arguments.model, quiet)?;
    print!("{}", redysim_codegen::source_file(&loaded.model, "Mechanism").map_err(Failure::input)?);
    Ok(())
}
