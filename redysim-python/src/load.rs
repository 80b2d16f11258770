//! Reading models, and the errors of files.

use crate::mechanism::Mechanism;
use crate::source_file::SourceFile;
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyUserWarning, PyValueError};
use pyo3::prelude::*;
use redysim_cli::{Failure, ModelFile};
use std::ffi::CString;
use std::path::{Path, PathBuf};

create_exception!(
    redysim,
    RedysimError,
    PyException,
    "What is wrong and what to do, as the command `redysim` reports it."
);
create_exception!(redysim, ModelWarning, PyUserWarning, "What a model may have, but is rarely meant.");

/// The report of a failure as an exception.
pub fn error(failure: Failure) -> PyErr {
    let text = failure.to_string();
    let advice = failure.advice();
    let advised =
        ARGUMENTS.iter().fold(advice.to_owned(), |advice, (option, argument)| advice.replace(option, argument));
    // The advice stands last.
    let what = text.strip_suffix(advice).unwrap_or(&text);
    RedysimError::new_err(format!("{what}{advised}"))
}

/// Options of the command that its advice names, and the arguments that stand for them here.
const ARGUMENTS: [(&str, &str); 5] = [
    ("`--base free`", "base=\"free\""),
    ("--output results/trial", "folder=\"results/trial\""),
    ("--output", "folder="),
    ("--force", "force=True"),
    ("the same command", "the same call"),
];

/// The same of a message, and of what to do, if that is known.
pub fn fault(message: &str, help: &str) -> PyErr {
    let help = if help.is_empty() { String::new() } else { format!("\n  = help: {help}") };
    RedysimError::new_err(format!("error: {message}{help}"))
}

/// Has Python warn of each.
pub fn warn(py: Python<'_>, warnings: &[String]) -> PyResult<()> {
    warnings.iter().try_for_each(|warning| {
        PyErr::warn(py, &py.get_type::<ModelWarning>(), &CString::new(warning.replace('\0', ""))?, 1)
    })
}

/// Reads a model file (TOML) or a URDF.
///
/// Parameters
/// ----------
/// path : str or os.PathLike
///     The file; one whose name ends in `.urdf` is a URDF.
/// base : {"fixed", "free"}
///     What the root link of a URDF is: the ground, or a link on a free joint `base`.
/// parameters : sequence of str, optional
///     What `with_parameters` gives: "gravity", of a link "tool.mass", "tool.com" and "tool.inertia", of a joint
///     "joint2.armature", "damping", "friction", "friction_velocity", "stiffness" and "rest"; by default the key `parameters` of
///     the file.
///
/// Returns
/// -------
/// Mechanism
///     The model with its functions. What the command `redysim check` warns of is a ModelWarning.
///
/// Raises
/// ------
/// RedysimError
///     With every fault of a model file, each with its line, the rule and what to do.
#[pyfunction]
#[pyo3(signature = (path, *, base = "fixed", parameters = None))]
pub fn load(py: Python<'_>, path: PathBuf, base: &str, parameters: Option<Vec<String>>) -> PyResult<Mechanism> {
    let floating = match base {
        "fixed" => false,
        "free" => true,
        other => {
            let message = format!("base must be \"fixed\" or \"free\", not {other:?}");
            return Err(PyValueError::new_err(message));
        }
    };
    let source = match std::fs::read(&path) {
        Ok(bytes) => SourceFile::new(path, bytes, floating, parameters),
        // Reported as the command does.
        Err(_) => return Err(ModelFile::load(&path).err().map_or_else(|| unreadable(&path), error)),
    };
    let mechanism = py.detach(|| Mechanism::new(source))?;
    warn(py, &mechanism.file.warnings)?;
    Ok(mechanism)
}

fn unreadable(path: &Path) -> PyErr {
    fault(&format!("{} cannot be read", path.display()), "")
}

/// A mechanism that was pickled: what was in its file, how it was loaded, its parameters if they are other ones than the
/// model's, and whether it was compiled.
#[pyfunction]
pub fn restored(
    py: Python<'_>,
    source: (Vec<u8>, PathBuf, bool, Option<Vec<String>>),
    values: Option<Bound<'_, PyAny>>,
    compiled: Option<Vec<String>>,
) -> PyResult<Mechanism> {
    let (bytes, path, floating, names) = source;
    let mechanism = py.detach(|| Mechanism::new(SourceFile::new(path, bytes, floating, names)))?;
    if let Some(functions) = compiled {
        py.detach(|| mechanism.make_compiled(Some(&functions), None))?;
    }
    match values {
        Some(values) => mechanism.with_parameters(&values),
        None => Ok(mechanism),
    }
}
