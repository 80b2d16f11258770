//! What a run leaves behind: a folder of tables, with all that is needed to do it again.

mod balance;
mod files;
mod folder;
mod leftover;
mod momentum;
pub mod names;
mod record;
mod replaceable;
mod run;
mod run_file;
mod summary;
mod tables;
pub mod touch_down;

use std::path::PathBuf;

use crate::scenario::{Dynamics, Scenario};
pub use balance::Balance;
pub use files::Files;
pub use folder::Folder;
pub use record::{GroundSample, Record, Sample, Sink};
pub use run::{Ending, Run};
pub use summary::{Ended, Outcome, Summary};
pub use tables::{Format, Quantities, Row};

/// Where results go, and how.
#[derive(clap::Args)]
#[group(skip)]
pub struct Arguments {
    /// The scenario file.
    pub scenario: PathBuf,
    /// The folder of results [default: results/<scenario's name>/forward or …/inverse].
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
    fn folder(&self, scenario: &Scenario, dynamics: Dynamics) -> PathBuf {
        let usual = || PathBuf::from("results").join(&scenario.name).join(dynamics.to_string());
        self.output.clone().unwrap_or_else(usual)
    }
}
