//! Runs of scenario files, and what they leave.

use crate::load::{error, warn};
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use redysim_cli::{Dynamics, Failure, Results, Scenario, Table, interrupt_computation, page_of_results};
use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

/// How often Python may ask for an end of a computation.
pub const PATIENCE: Duration = Duration::from_millis(50);

/// The dynamics that a scenario file is for: "inverse", "forward" or both.
#[pyfunction]
pub fn runs_of_scenario(path: PathBuf) -> PyResult<Vec<&'static str>> {
    let scenario = Scenario::load(path).map_err(error)?;
    let runs = [(scenario.inverse.is_some(), "inverse"), (scenario.forward.is_some(), "forward")];
    Ok(runs.into_iter().filter(|(is_there, _)| *is_there).map(|(_, run)| run).collect())
}

/// Computes a run of a scenario file into a folder of results, which is returned as `read_results` does.
#[pyfunction]
pub fn compute<'py>(
    py: Python<'py>,
    path: PathBuf,
    dynamics: &str,
    folder: PathBuf,
    force: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let dynamics = if dynamics == "inverse" { Dynamics::Inverse } else { Dynamics::Forward };
    let (results, warnings) = interruptible(py, move || Results::compute(path, dynamics, folder, force))?;
    warn(py, &warnings)?;
    of_results(py, &results)
}

/// What is in a folder of results: how the run went, as JSON, and for each table its instants, the symbol, name and unit of
/// each column, and the values.
#[pyfunction]
pub fn read_results(py: Python<'_>, folder: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    of_results(py, &py.detach(|| Results::load(folder)).map_err(error)?)
}

/// The page of HTML that plays the run in a folder of results.
#[pyfunction]
pub fn page(py: Python<'_>, folder: PathBuf) -> PyResult<String> {
    py.detach(|| page_of_results(folder)).map_err(error)
}

fn of_results<'py>(py: Python<'py>, results: &Results) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    let run = serde_json::to_string(&results.run).map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
    found.set_item("run", run)?;
    found.set_item("scenario", results.scenario.to_toml())?;
    let tables = PyDict::new(py);
    for (name, Table { t, columns }) in &results.tables {
        let headers: Vec<_> = columns.iter().map(|of| (&of.symbol, &of.name, &of.unit)).collect();
        let rows: Vec<Vec<f64>> =
            (0..t.len()).map(|row| columns.iter().map(|column| column.values[row]).collect()).collect();
        let values =
            if columns.is_empty() { PyArray2::zeros(py, [t.len(), 0], false) } else { PyArray2::from_vec2(py, &rows)? };
        tables.set_item(name, (PyArray1::from_slice(py, t), headers, values))?;
    }
    found.set_item("tables", tables)?;
    Ok(found)
}

/// What a thread computes, until Python has a signal, such as that of Ctrl-C.
fn interruptible<T: Send>(py: Python<'_>, compute: impl FnOnce() -> Result<T, Failure> + Send) -> PyResult<T> {
    thread::scope(|scope| {
        let (done, result) = mpsc::channel();
        let result = Mutex::new(result);
        scope.spawn(move || done.send(compute()));
        let mut interrupted = Ok(());
        loop {
            let waited = py.detach(|| result.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(PATIENCE));
            match waited {
                Ok(computed) => {
                    interrupted?;
                    return computed.map_err(error);
                }
                Err(RecvTimeoutError::Timeout) => {
                    if let Err(signal) = py.check_signals() {
                        interrupt_computation();
                        interrupted = Err(signal);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the computation has panicked: this is a fault of redysim"));
                }
            }
        }
    })
}
