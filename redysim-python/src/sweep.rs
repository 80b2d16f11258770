//! Studies: their samples, each computed apart, in whatever process, and the rows that they leave.

use crate::load::error;
use pyo3::exceptions::{PyIndexError, PyValueError};
use pyo3::prelude::*;
use redysim_cli::SweepRows;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A study: a scenario, and the values of each sample at paths into it.
#[pyclass(module = "redysim._core", frozen)]
pub struct Study(redysim_cli::Study);

#[pymethods]
impl Study {
    /// Reads a study file.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Study> {
        py.detach(|| redysim_cli::Study::load(path)).map(Study).map_err(error)
    }

    /// Reads the text of a study, whose files are in `folder`.
    #[staticmethod]
    fn from_toml(py: Python<'_>, text: String, folder: PathBuf, name: &str) -> PyResult<Study> {
        let read = || redysim_cli::Study::from_toml(text, "the study, written as TOML", folder, name);
        py.detach(read).map(Study).map_err(error)
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    fn __len__(&self) -> usize {
        self.0.count()
    }

    #[getter]
    fn headers(&self) -> Vec<String> {
        self.0.headers()
    }

    #[getter]
    fn numeric(&self) -> Vec<bool> {
        self.0.numeric()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.0.warnings().to_vec()
    }

    /// What all samples have in common, as JSON.
    fn sampler(&self) -> PyResult<String> {
        json(self.0.sampler())
    }

    /// A sample, as JSON.
    fn sample(&self, index: usize) -> PyResult<String> {
        if index >= self.0.count() {
            return Err(PyIndexError::new_err(format!("there are {} samples", self.0.count())));
        }
        json(&self.0.sample(index))
    }
}

/// Computes the rows of samples.
#[pyclass(module = "redysim._core", frozen)]
pub struct Sampler(redysim_cli::Sampler);

#[pymethods]
impl Sampler {
    #[new]
    fn new(text: &str) -> PyResult<Sampler> {
        redysim_cli::Sampler::from_json(text).map(Sampler).map_err(error)
    }

    /// The row of a sample: its number, and a line of CSV.
    fn row(&self, py: Python<'_>, sample: &str) -> PyResult<Option<(usize, String)>> {
        let sample = read_sample(sample)?;
        Ok(py.detach(|| self.0.row(&sample)).map(|row| (sample.index, row)))
    }

    /// The row of a sample that was not computed, for a reason.
    fn failed_row(&self, sample: &str, reason: &str) -> PyResult<String> {
        Ok(self.0.failed_row(&read_sample(sample)?, reason))
    }
}

/// The rows of a study in its folder.
#[pyclass(module = "redysim._core", frozen)]
pub struct Rows(Mutex<Option<SweepRows>>);

#[pymethods]
impl Rows {
    /// With the number of rows of a part in Parquet, where these are wanted.
    #[new]
    fn open(folder: PathBuf, study: &Study, force: bool, part: Option<NonZeroUsize>) -> PyResult<Rows> {
        let mut rows = SweepRows::open(folder, &study.0, force).map_err(error)?;
        if let Some(part) = part {
            rows = rows.with_parts(&study.0, part).map_err(error)?;
        }
        Ok(Rows(Mutex::new(Some(rows))))
    }

    #[getter]
    fn path(&self) -> PyResult<PathBuf> {
        self.with(|rows| Ok(rows.path().to_owned()))
    }

    fn missing(&self) -> PyResult<Vec<usize>> {
        self.with(|rows| Ok(rows.missing()))
    }

    fn __len__(&self) -> PyResult<usize> {
        self.with(|rows| Ok(rows.count()))
    }

    fn add(&self, index: usize, row: &str) -> PyResult<()> {
        self.with(|rows| rows.add(index, row).map_err(error))
    }

    fn finish(&self) -> PyResult<()> {
        self.with(|rows| rows.finish().map_err(error))
    }

    /// Lets another process have them.
    fn close(&self) {
        *self.lock() = None;
    }
}

impl Rows {
    fn lock(&self) -> MutexGuard<'_, Option<SweepRows>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn with<T>(&self, of: impl FnOnce(&mut SweepRows) -> PyResult<T>) -> PyResult<T> {
        of(self.lock().as_mut().ok_or_else(|| PyValueError::new_err("the rows are closed"))?)
    }
}

fn read_sample(text: &str) -> PyResult<redysim_cli::Sample> {
    serde_json::from_str(text).map_err(|error| PyValueError::new_err(format!("not a sample: {error}")))
}

fn json(of: &impl serde::Serialize) -> PyResult<String> {
    serde_json::to_string(of).map_err(|error| PyValueError::new_err(error.to_string()))
}
