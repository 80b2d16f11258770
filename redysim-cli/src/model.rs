//! Model files, and the failures of files that are not models.

use std::path::Path;

use crate::failure::Failure;
use crate::output::to_stderr;
use redysim_model::{Faults, Loaded, Model};

/// Reads a model, prints its warnings unless `quiet`, and reports every fault at once.
pub fn load(path: &Path, quiet: bool) -> Result<Loaded, Failure> {
    loaded(path, Model::load(path), quiet)
}

/// The same of a model that is read already.
pub fn loaded(path: &Path, read: Result<Loaded, Faults>, quiet: bool) -> Result<Loaded, Failure> {
    let loaded = read.map_err(|faults| {
        not_a_model(path)
            .unwrap_or_else(|| if faults.unread { Failure::outside(faults) } else { Failure::input(faults) })
    })?;
    if !quiet {
        for warning in &loaded.warnings {
            to_stderr(&format!("{warning}\n"));
        }
    }
    Ok(loaded)
}

/// The failure of a file that is a scenario where a model is wanted.
pub fn not_a_model(path: &Path) -> Option<Failure> {
    let table: toml::Table = std::fs::read_to_string(path).ok()?.parse().ok()?;
    let model = table.get("model").filter(|_| !table.contains_key("link"))?.as_str()?;
    let model = path.with_file_name("").join(model);
    let failure = Failure::input(format!("{} is a scenario, not a model", path.display()));
    Some(failure.help(format!("name its model: {}", model.display())))
}

/// The failure of a file that is a model where a scenario is wanted.
pub fn not_a_scenario(path: &Path, text: &str) -> Option<Failure> {
    let table: toml::Table = text.parse().ok()?;
    (table.contains_key("link") && !table.contains_key("model")).then(|| {
        let failure = Failure::input(format!("{} is a model, not a scenario", path.display()));
        failure.help(format!("a scenario names it, as in: model = \"{}\"", path.display()))
    })
}
