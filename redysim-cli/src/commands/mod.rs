//! The subcommands, a file each: what they take, and what they do.

pub mod animate;
pub mod check;
pub mod completions;
pub mod forward;
pub mod generate;
pub mod import;
pub mod inverse;
pub mod plot;

use std::path::Path;

use crate::failure::Failure;
use crate::output::tell;
use redysim_model::{Faults, Loaded, Model};

/// Reads a model, prints its warnings unless `quiet`, and says every fault at once.
pub fn load(path: &Path, quiet: bool) -> Result<Loaded, Failure> {
    loaded(path, Model::load(path), quiet)
}

/// The same of a model that is read already.
pub fn loaded(path: &Path, read: Result<Loaded, Faults>, quiet: bool) -> Result<Loaded, Failure> {
    let loaded =
        read.map_err(|faults| if path.exists() { Failure::input(faults) } else { Failure::outside(faults) })?;
    if !quiet {
        for warning in &loaded.warnings {
            tell(&format!("{warning}\n"));
        }
    }
    Ok(loaded)
}
