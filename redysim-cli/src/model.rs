//! Model files, and the failures of files that are not models.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::output::to_stderr;
use crate::urdf::{self, Imported};
use redysim_model::{Diagnostic, Diagnostics, Faults, Loaded, Model};

/// The model of a model file or of a URDF.
pub struct Read {
    /// The model.
    pub model: Model,
    /// The text of its model file.
    pub text: String,
    /// The URDF of which it was made, if it was.
    pub urdf: Option<PathBuf>,
}

impl From<Loaded> for Read {
    fn from(Loaded { model, text, .. }: Loaded) -> Self {
        Read { model, text, urdf: None }
    }
}

/// Whether a file is a URDF, by its name.
pub fn is_urdf(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Reads a model file or a URDF, and prints warnings unless `quiet`.
///
/// # Errors
/// As [`load`] and [`of_urdf`].
pub fn read(path: &Path, quiet: bool) -> Result<Read, Failure> {
    if is_urdf(path) { of_urdf(path, quiet) } else { load(path, quiet).map(Read::from) }
}

/// The model that `redysim import` makes of a URDF; prints what moves otherwise, and warnings, unless `quiet`.
///
/// # Errors
/// If the file cannot be read, or its first fault.
pub fn of_urdf(path: &Path, quiet: bool) -> Result<Read, Failure> {
    let imported = urdf::import(&urdf::read(path)?, path, urdf::Options::default())?;
    if !quiet {
        imported.changes.iter().for_each(|change| to_stderr(&format!("warning: {change}")));
        let warnings = imported.shown_warnings("a model file by `redysim import --quarter-turns`");
        warnings.iter().for_each(|line| to_stderr(line));
    }
    let Imported { text, model, .. } = imported;
    Ok(Read { model, text, urdf: Some(path.to_owned()) })
}

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
        show(&loaded.warnings);
    }
    Ok(loaded)
}

/// Prints findings about a file.
pub fn show(found: &[Diagnostic]) {
    if !found.is_empty() {
        to_stderr(&format!("{}\n", Diagnostics(found.to_vec())));
    }
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
