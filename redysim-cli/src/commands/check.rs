//! `redysim check MODEL`.

use std::path::PathBuf;

use super::load;
use crate::failure::Failure;

/// Show every fault and warning of a model, then what it is.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim check models/kr5.toml")]
pub struct Arguments {
    /// The model file.
    model: PathBuf,
}

/// Checks the model.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let loaded = load(&arguments.model, quiet)?;
    println!("{}: {} links", loaded.model.name, loaded.model.links.len());
    Ok(())
}
