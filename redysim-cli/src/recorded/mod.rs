//! What a run has left behind: the tables of a results folder, and the model that they are about.

mod charts;
mod groups;
mod thin;

use std::path::{Path, PathBuf};

use redysim_model::Model;

pub use charts::{Chart, Curve};
pub use thin::evenly;

use crate::failure::Failure;
use crate::model;
use crate::results::names;
use crate::table::Table;

/// A results folder.
pub struct Recorded {
    folder: PathBuf,
}

impl Recorded {
    /// The results in `folder`, of which nothing is read yet.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn open(folder: &Path) -> Result<Self, Failure> {
        if folder.is_dir() {
            return Ok(Recorded { folder: folder.to_owned() });
        }
        let what = if folder.exists() { "is not a folder" } else { "is not there" };
        Err(Failure::outside(format!("{} {what}", folder.display()))
            .help("give the folder of results that a run has written, such as the one after its -o"))
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// One of its tables; `None` if the run has not written it.
    ///
    /// # Errors
    /// If it cannot be read, or is not such a table.
    pub fn table(&self, name: &str) -> Result<Option<Table>, Failure> {
        let path = self.folder.join(names::csv(name));
        if path.exists() { Table::read(&path).map(Some) } else { Ok(None) }
    }

    /// The coordinates and velocities of the joints: the state of a forward run; of an inverse one the given motion,
    /// with its accelerations.
    ///
    /// # Errors
    /// If they cannot be read.
    pub fn motion(&self) -> Result<Option<Table>, Failure> {
        match self.table(names::TRAJ)? {
            Some(table) => Ok(Some(table)),
            None => self.table(names::STATEVAR),
        }
    }

    /// That nothing of what is wanted is there, and what to do.
    pub fn lacks(&self, what: &str) -> Failure {
        let redysims = |entry: std::io::Result<std::fs::DirEntry>| {
            entry.is_ok_and(|entry| entry.path().extension().is_some_and(|extension| extension == "dat"))
        };
        let names_nothing = std::fs::read_dir(&self.folder).is_ok_and(|mut entries| entries.any(redysims));
        Failure::input(format!("{} holds {what}", self.folder.display())).help(if names_nothing {
            "its tables are ReDySim's (*.dat), which do not name their columns: run the scenario with --format csv"
        } else {
            "a run writes statevar.csv or traj.csv, kinematics.csv, momentum.csv, tor.csv, energy.csv and lambda.csv; \
             is this its folder?"
        })
    }

    /// The URDF of which the model was made, if the run says so.
    pub fn urdf(&self) -> Option<PathBuf> {
        let run: toml::Table = std::fs::read_to_string(self.folder.join(names::RUN_FILE)).ok()?.parse().ok()?;
        run.get("run")?.get(names::URDF)?.as_str().map(PathBuf::from)
    }

    /// The model whose motion it is.
    ///
    /// # Errors
    /// If it is not there or has faults.
    pub fn model(&self) -> Result<Model, Failure> {
        let path = self.folder.join(names::MODEL);
        if !path.exists() {
            return Err(Failure::outside(format!("{} holds no {}", self.folder.display(), names::MODEL))
                .help("a run writes a copy of its model beside its tables; put it back there"));
        }
        // The run has shown the warnings.
        model::load(&path, "", true).map(|loaded| loaded.model)
    }
}
