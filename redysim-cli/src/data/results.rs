//! What a run leaves.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use redysim_model::Model;
use serde::{Deserialize, Serialize};

use super::{Scenario, Torque, Trajectory, file};
use crate::failure::Failure;
use crate::recorded::Recorded;
use crate::results::{Folder, Run, names};
use crate::scenario::read_text;
use crate::table::{self, Column};

/// A folder of results as data: what was run, how it went, and the tables.
///
/// # Example
///
/// ```no_run
/// use redysim_cli::{Failure, Results};
///
/// let fall = Results::load("results/kuka/forward")?;
/// let energy = &fall.tables["energy"];
/// let drift = energy.columns.iter().find(|column| column.symbol == "drift").expect("a run writes it");
/// println!("{} J after {} s", drift.values.last().unwrap(), energy.t.last().unwrap());
/// # Ok::<(), Failure>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Results {
    /// The model, of which links and joints have the names in the tables.
    pub model: Model,
    /// The scenario with every setting that it left open, and nothing of the other run that it may be for.
    pub scenario: Scenario,
    /// How it went.
    pub run: Run,
    /// The tables by the names of their files without ending, such as `statevar`, `tor`, `energy`; also those that the
    /// scenario names.
    pub tables: BTreeMap<String, Table>,
}

/// Quantities over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// The instants, s.
    pub t: Vec<f64>,
    /// The quantities, with a value for each instant.
    pub columns: Vec<Column>,
}

impl Results {
    /// Reads the folder of results that `redysim inverse` or `redysim forward` has written.
    ///
    /// # Errors
    ///
    /// If the folder or one of its files does not exist, cannot be read, or is invalid. The tables of `--format dat` do
    /// not name their columns: they are not read.
    pub fn load(folder: impl AsRef<Path>) -> Result<Results, Failure> {
        let recorded = Recorded::open(folder.as_ref())?;
        let path = folder.as_ref().join(names::RUN_FILE);
        let text = read_text(&path)?;
        let run = Run::of_file(&text, &path)?;
        let scenario = file::read(&text, &path, &[run.command])?;
        let mut tables = BTreeMap::new();
        for name in names::TABLES.into_iter().chain(names::INPUTS) {
            if let Some(table::Table { t, columns, .. }) = recorded.table(name)? {
                tables.insert(name.to_owned(), Table { t, columns });
            }
        }
        if !has_results(&tables) {
            return Err(recorded.lacks("no tables of results"));
        }
        Ok(Results { model: recorded.model()?, scenario, run, tables })
    }

    /// Writes a folder that [`load`](Self::load) reads to the same bits, and from which the commands plot, animate and
    /// run again. Returns its path. With `force`, results that are there are replaced.
    ///
    /// The model is written as `redysim_model::Model::check` returns it. Whatever files the scenario names, it names
    /// those of the folder there: the model and the tables `trajectory` and `torque`.
    ///
    /// # Errors
    ///
    /// Faults of the model, the scenario or a table, as those of files; a scenario without a name, or without the run
    /// that [`run`](Self::run) is about; or if the folder cannot be written, or is there already. It is there whole or
    /// not at all.
    pub fn write(&self, folder: impl Into<PathBuf>, force: bool) -> Result<PathBuf, Failure> {
        let model = self.model.check().map_err(Failure::input)?.model;
        let scenario = self.scenario_of_folder()?;
        let draft = Folder::draft(folder.into(), force)?;
        draft.write(names::MODEL, model.to_toml().as_bytes())?;
        for (name, table) in &self.tables {
            draft.write(&names::csv(name), &table.to_csv(name)?)?;
        }
        let text = format!("{}\n{}", scenario.to_toml(), self.run.to_toml());
        let path = draft.path().join(names::RUN_FILE);
        file::check(&text, &path, "the scenario of the results, written as TOML", &[self.run.command])?;
        Run::of_file(&text, &path)?;
        draft.write(names::RUN_FILE, text.as_bytes())?;
        draft.finish(true)
    }

    /// The scenario for its run alone, as it names the files of a folder of results.
    fn scenario_of_folder(&self) -> Result<Scenario, Failure> {
        let fault = |what: &str, help: String| Err(Failure::input(format!("the results: {what}")).help(help));
        let run = self.run.command;
        let mut scenario = Scenario { model: names::MODEL.into(), ..self.scenario.clone() }.only(run);
        if scenario.name.is_none() {
            return fault("their scenario has no name", "give it one: the results of a run are called by it".into());
        }
        if scenario.inverse.is_none() && scenario.forward.is_none() {
            let what = format!("they are those of {run} dynamics, which their scenario does not have");
            return fault(&what, format!("give the scenario its `{run}`, or `run.command` what was computed"));
        }
        if !has_results(&self.tables) {
            return fault("they have no table", format!("give at least one of {}", names::TABLES.join(", ")));
        }
        let trajectory = match &mut scenario.trajectory {
            Some(Trajectory::Csv { file, .. }) => Some((file, names::TRAJECTORY)),
            _ => None,
        };
        let torque = match scenario.forward.as_mut().and_then(|forward| forward.torque.as_mut()) {
            Some(Torque::Csv { file, .. }) => Some((file, names::TORQUE)),
            _ => None,
        };
        for (file, table) in trajectory.into_iter().chain(torque) {
            if !self.tables.contains_key(table) {
                let what = format!("their scenario names a table, {file}, and they have no table `{table}`");
                return fault(&what, format!("add its columns as the table `{table}`"));
            }
            *file = names::csv(table);
        }
        Ok(scenario)
    }
}

/// Whether there is a table that a run writes.
fn has_results(tables: &BTreeMap<String, Table>) -> bool {
    names::TABLES.iter().any(|name| tables.contains_key(*name))
}

impl Table {
    /// The text of the table `name`.
    ///
    /// # Errors
    /// If it is not one that results have, or not one that reads back.
    fn to_csv(&self, name: &str) -> Result<Vec<u8>, Failure> {
        let known: Vec<_> = names::TABLES.into_iter().chain(names::INPUTS).collect();
        if !known.contains(&name) {
            let message = format!("results have no table `{name}`");
            return Err(Failure::input(message).help(format!("its name is one of {}", known.join(", "))));
        }
        table::to_csv(name, &self.t, &self.columns)
    }
}
