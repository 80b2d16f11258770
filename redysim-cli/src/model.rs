//! Model files, and the failures of files that are not models.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::kind::Kind;
use crate::output::to_stderr;
use crate::urdf::{self, Base, Imported};
use redysim_model::{CodegenOptions, Diagnostic, Diagnostics, Faults, Loaded, Model};
use redysim_toml::words::shortened;

/// A model with the file that it is read from: a model file, or a URDF.
///
/// ```
/// use redysim_cli::ModelFile;
///
/// let kr5 = ModelFile::load(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/kr5.toml"))?;
/// assert_eq!((kr5.model.dof(), kr5.warnings.len()), (6, 0));
/// # Ok::<(), redysim_cli::Failure>(())
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ModelFile {
    /// The model.
    pub model: Model,
    /// The text of its model file; of a URDF, the text that `redysim import` makes.
    pub text: String,
    /// The URDF of which it was made, if it was, and has the same links: its root is the ground.
    pub urdf: Option<PathBuf>,
    /// What the command prints when it reads the file, without what is an error.
    pub warnings: Vec<String>,
    /// What the file asks of code that is made of it, such as its run-time parameters.
    pub options: CodegenOptions,
}

impl ModelFile {
    /// Reads a model file, or a URDF with its root link fixed to the ground.
    ///
    /// # Errors
    ///
    /// Every fault of a model file at once, as the command shows them, or the first of a URDF; or if the file cannot be
    /// read.
    pub fn load(path: impl AsRef<Path>) -> Result<ModelFile, Failure> {
        let path = path.as_ref();
        if is_urdf(path) {
            import(&urdf::read(path)?, path, Base::Fixed)
        } else {
            checked(path, Model::load(path)).map(ModelFile::from)
        }
    }

    /// Reads a URDF whose root link floats on a free joint `base`.
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load), and if the file is not a URDF.
    pub fn load_floating(path: impl AsRef<Path>) -> Result<ModelFile, Failure> {
        let path = path.as_ref();
        if is_urdf(path) { import(&urdf::read(path)?, path, Base::Free) } else { Err(not_floating(path)) }
    }

    /// Reads the bytes of a model file or a URDF, which are, or were, at `path`; the root link of a URDF is the ground, or
    /// `floating` on a free joint `base`.
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load) and [`load_floating`](Self::load_floating).
    pub fn from_bytes(bytes: Vec<u8>, path: impl AsRef<Path>, floating: bool) -> Result<ModelFile, Failure> {
        let path = path.as_ref();
        match (is_urdf(path), floating) {
            (true, _) => import(&urdf::text(bytes, path)?, path, if floating { Base::Free } else { Base::Fixed }),
            (false, false) => checked(path, Model::from_bytes(bytes, path.display().to_string())).map(ModelFile::from),
            (false, true) => Err(not_floating(path)),
        }
    }

    /// With the run-time parameters of these names, such as `gravity` or `tool.mass`, in place of those of the file.
    ///
    /// # Errors
    ///
    /// Every name that is not that of a parameter.
    pub fn with_run_time_parameters(self, names: &[String]) -> Result<ModelFile, Failure> {
        let names: toml::Table = [("parameters".to_owned(), names.to_vec().into())].into_iter().collect();
        let loaded = Model::from_toml_with(self.text.clone(), "the model", names.to_string());
        let options = loaded.map_err(Failure::input)?.options;
        Ok(ModelFile { options, ..self })
    }

    /// Prints the warnings unless `quiet`.
    fn shown(self, quiet: bool) -> Self {
        if !quiet {
            self.warnings.iter().for_each(|warning| to_stderr(warning));
        }
        self
    }
}

impl From<Loaded> for ModelFile {
    fn from(Loaded { model, text, warnings, options, .. }: Loaded) -> Self {
        ModelFile { model, text, urdf: None, warnings: shown(&warnings).into_iter().collect(), options }
    }
}

fn not_floating(path: &Path) -> Failure {
    let failure = Failure::command_line(format!("{} is not a URDF, whose root may float", path.display()));
    failure.help("in a model file, the root is a link with joint = \"free\"")
}

/// Whether a file is a URDF, by its name.
pub fn is_urdf(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// Reads a model file or a URDF, and prints warnings unless `quiet`.
///
/// # Errors
/// As [`ModelFile::load`].
pub fn read(path: &Path, quiet: bool) -> Result<ModelFile, Failure> {
    ModelFile::load(path).map(|read| read.shown(quiet))
}

/// The model that `redysim import` makes of a URDF. Its warnings name what moves otherwise.
///
/// # Errors
/// The first fault of the URDF.
fn import(text: &str, path: &Path, base: Base) -> Result<ModelFile, Failure> {
    let options = urdf::Options { base, ..urdf::Options::default() };
    let imported = urdf::import(text, path, options)?;
    let changes = imported.changes.iter().map(|change| format!("warning: {change}"));
    let warnings = imported.shown_warnings("a model file by `redysim import --quarter-turns`");
    let warnings = changes.chain(warnings).collect();
    let Imported { text, model, .. } = imported;
    let urdf = (base == Base::Fixed).then(|| path.to_owned());
    Ok(ModelFile { model, text, urdf, warnings, options: CodegenOptions::default() })
}

/// Reads a model with `options` beside it, in TOML: a model file, or a URDF on the ground as the model file that it becomes,
/// whose faults and warnings stand in what `redysim import` prints.
///
/// # Errors
/// The first fault of a URDF.
pub fn with_options(path: &Path, options: &str, quiet: bool) -> Result<Result<Loaded, Faults>, Failure> {
    let name = path.display().to_string();
    if !is_urdf(path) {
        return Ok(Model::load_with(path, name, options));
    }
    let imported = urdf::import(&urdf::read(path)?, path, urdf::Options::default())?;
    if !quiet {
        imported.changes.iter().for_each(|change| to_stderr(&format!("warning: {change}")));
    }
    Ok(Model::from_toml_with(imported.text, format!("redysim import {name}"), options))
}

/// Reads a model, prints its warnings unless `quiet`, and reports every fault at once.
///
/// # Errors
/// The faults.
pub fn load(path: &Path, options: &str, quiet: bool) -> Result<Loaded, Failure> {
    loaded(path, with_options(path, options, quiet)?, quiet)
}

/// The same of a model that is read already.
pub fn loaded(path: &Path, read: Result<Loaded, Faults>, quiet: bool) -> Result<Loaded, Failure> {
    let loaded = checked(path, read)?;
    if !quiet {
        show(&loaded.warnings);
    }
    Ok(loaded)
}

/// The same without a warning.
fn checked(path: &Path, read: Result<Loaded, Faults>) -> Result<Loaded, Failure> {
    read.map_err(|faults| {
        not_a_model(path)
            .unwrap_or_else(|| if faults.unread { Failure::outside(faults) } else { Failure::input(faults) })
    })
}

/// Prints findings about a file.
pub fn show(found: &[Diagnostic]) {
    shown(found).iter().for_each(|text| to_stderr(text));
}

/// Findings about a file as they are printed, if there are any.
fn shown(found: &[Diagnostic]) -> Option<String> {
    (!found.is_empty()).then(|| format!("{}\n", Diagnostics(found.to_vec())))
}

/// The failure of a file that is of another kind, or something else, where a model is wanted.
pub fn not_a_model(path: &Path) -> Option<Failure> {
    let text = std::fs::read_to_string(path).ok()?;
    if let Some(failure) = Kind::Model.mistaken(path, &text) {
        return Some(failure);
    }
    let table: toml::Table = text.parse().ok()?;
    let has = |key: &str| table.contains_key(key);
    if table.is_empty() || ["name", "gravity", "link", "loop", "frame", "spring", "model"].into_iter().any(has) {
        return None;
    }
    let failure = Failure::input(format!("{} is not a model: it has none of a model's keys", path.display()));
    let found: Vec<_> = table.keys().map(String::as_str).collect();
    Some(failure.help(format!(
        "a model file has `name`, `gravity` and a [[link]] for each link; this file has {}",
        shortened(&found)
    )))
}
