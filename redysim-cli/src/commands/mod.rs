//! The subcommands, a file each: what they take, and what they do.

pub mod animate;
pub mod check;
pub mod completions;
pub mod generate;
pub mod plot;

use std::path::Path;

use crate::failure::Failure;
use redysim_model::{Loaded, Model};

/// Reads a model, prints its warnings unless `quiet`, and says every fault at once.
pub fn load(path: &Path, quiet: bool) -> Result<Loaded, Failure> {
    let loaded = Model::load(path)
        .map_err(|faults| if path.exists() { Failure::input(faults) } else { Failure::outside(faults) })?;
    if !quiet {
        for warning in &loaded.warnings {
            eprintln!("{warning}\n");
        }
    }
    Ok(loaded)
}
