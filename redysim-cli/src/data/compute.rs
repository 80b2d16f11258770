//! What the commands do with scenarios and results, for programs.

use std::path::Path;

use super::Results;
use crate::commands::{forward, inverse};
use crate::failure::Failure;
use crate::interrupt;
use crate::model::ModelFile;
use crate::page::Page;
use crate::recorded::Recorded;
use crate::results::{Arguments, Format};
use crate::scenario::{self, Dynamics, read_text};

impl Results {
    /// Computes a run of the scenario file at `path` as `redysim forward` and `redysim inverse` do, and writes `folder`,
    /// over results that are there if `force` is true. Returns the results and the warnings; nothing is printed.
    ///
    /// # Errors
    ///
    /// What the commands report.
    ///
    /// ```
    /// use redysim_cli::{Dynamics, Results};
    ///
    /// let folder = tempfile::tempdir().unwrap();
    /// let scenario = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/rp.toml");
    /// let (results, warnings) = Results::compute(scenario, Dynamics::Forward, folder.path().join("rp"), false)?;
    /// assert!(results.tables.contains_key("energy") && warnings.is_empty());
    /// # Ok::<(), redysim_cli::Failure>(())
    /// ```
    pub fn compute(
        path: impl AsRef<Path>,
        run: Dynamics,
        folder: impl AsRef<Path>,
        force: bool,
    ) -> Result<(Results, Vec<String>), Failure> {
        let (path, folder) = (path.as_ref(), folder.as_ref());
        interrupt::begin();
        let text = read_text(path)?;
        let (scenario, found) =
            scenario::Scenario::of_text(text, path, &path.display().to_string(), run, (None, true))?;
        let arguments = Arguments { scenario: path.into(), output: Some(folder.into()), format: Format::Csv, force };
        let compute = match run {
            Dynamics::Forward => forward::compute,
            Dynamics::Inverse => inverse::compute,
        };
        let warnings = compute(&arguments, &scenario, true)?;
        let found = found.iter().map(ToString::to_string);
        Ok((Results::load(folder)?, found.chain(warnings).collect()))
    }
}

/// Ends the computations of [`Results::compute`] that are under way in this process, as Ctrl-C ends the command: what was
/// computed is written, and they fail.
pub fn interrupt_computation() {
    interrupt::ask();
}

/// The page of HTML that `redysim animate` makes of the results in `folder`.
///
/// # Errors
///
/// What the command reports.
pub fn page_of_results(folder: impl AsRef<Path>) -> Result<String, Failure> {
    let recorded = Recorded::open(folder.as_ref())?;
    Page::of_run(&recorded, None).map(|page| page.html)
}

impl ModelFile {
    /// The page of HTML that `redysim show` makes of the model.
    ///
    /// # Errors
    ///
    /// What the command reports.
    pub fn page(&self) -> Result<String, Failure> {
        Page::of_model(&self.model, self.urdf.as_deref()).map(|page| page.html)
    }
}
