//! What a run leaves behind: a folder of tables, with all that is needed to do it again.

mod folder;
mod record;
mod replaceable;
mod run_file;
mod summary;
mod tables;

use std::path::PathBuf;

use crate::failure::Failure;
use crate::output::say;
use crate::scenario::Scenario;
pub use folder::Folder;
pub use record::{Record, Rows};
pub use summary::{Ended, Summary};
pub use tables::Format;

/// Where results go, and how.
#[derive(clap::Args)]
#[group(skip)]
pub struct Arguments {
    /// The scenario file.
    pub scenario: PathBuf,
    /// The folder that is written; results/<scenario's name>/forward or …/inverse unless told.
    #[arg(long, short, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// How numbers are written: tables with names and units, or ReDySim's own columns.
    #[arg(long, value_enum, default_value = "csv")]
    pub format: Format,
    /// Overwrite a result that is there.
    #[arg(long)]
    pub force: bool,
}

impl Arguments {
    /// The folder for the results of `scenario`, as a draft. It is made before anything is computed, so that what
    /// cannot be written is said at once.
    pub fn folder(&self, scenario: &Scenario, command: &str) -> Result<Folder, Failure> {
        let usual = || PathBuf::from("results").join(&scenario.name).join(command);
        let target = self.output.clone().unwrap_or_else(usual);
        Folder::draft(target, self.force)
    }
}

/// Writes a run, says how it went, and fails if it did not come to its end.
pub fn finish(
    folder: Folder,
    format: Format,
    scenario: &Scenario,
    record: &Record,
    summary: &Summary,
    quiet: bool,
) -> Result<(), Failure> {
    if record.t.len() < 2
        && let Ended::Failed(reason) = &summary.ended
    {
        return Err(reason.clone());
    }
    tables::write(&folder, format, scenario, record)?;
    run_file::write(&folder, scenario, summary)?;
    let target = folder.finish()?;
    if !quiet {
        say(&format!("{summary}\n  written to {}", target.display()));
    }
    let kept = format!("{} instants, until {:?} s, are in {}", record.t.len(), record.until(), target.display());
    match &summary.ended {
        Ended::Complete => Ok(()),
        Ended::Interrupted => Err(Failure::interrupted(kept)),
        Ended::Failed(reason) => Err(reason.clone().and(&format!("; what was computed before is kept: {kept}"))),
    }
}
