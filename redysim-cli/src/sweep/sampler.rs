//! One sample after another: the scenario with its values, run, and the row that it leaves.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use redysim_toml::Diagnostic;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::outcomes::{Outcome, Reducer};
use super::place::Place;
use crate::commands::{forward, inverse};
use crate::failure::Failure;
use crate::scenario::{Dynamics, Held, Scenario, keys};
use crate::text::to_toml;

/// All that the samples of a [`Study`](crate::Study) have in common: it computes the row of any sample, in any process, for
/// it serialises and deserialises by serde. The files that the scenario names are in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sampler {
    /// The version of redysim.
    pub(super) redysim: String,
    /// What is computed.
    pub(crate) run: Dynamics,
    /// The scenario, whose values are replaced.
    pub(super) scenario: Table,
    /// Every model that a sample may name, by its path.
    pub(super) models: BTreeMap<String, Table>,
    /// The tables that the scenario may name, by their paths.
    pub(super) tables: BTreeMap<String, String>,
    /// The paths of the values.
    pub(super) paths: Vec<String>,
    /// What is kept of each run.
    pub(super) outcomes: Vec<Outcome>,
    /// What else is kept: how it went.
    pub(super) account: Vec<String>,
}

/// A sample of a [`Study`](crate::Study): its number and its values, which serialise and deserialise by serde.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sample {
    /// Its number, counted from 0.
    pub index: usize,
    /// Its values, one for each path.
    pub(super) values: Vec<Value>,
}

/// The cells of a run, and its warnings.
type Computed = (Vec<String>, Vec<String>);

/// The files of a sample.
struct Files {
    scenario: Table,
    model: Table,
    /// The path of the model, as the scenario has it.
    model_path: String,
}

impl Sampler {
    /// Scenario and model with the values of a sample.
    ///
    /// # Errors
    /// If a path leads nowhere.
    fn files(&self, sample: &Sample) -> Result<Files, Failure> {
        let places = self.paths.iter().map(|path| Place::parse(path).map_err(Failure::input));
        let places = places.collect::<Result<Vec<_>, _>>()?;
        let valued = || places.iter().zip(&sample.values);
        let mut scenario = self.scenario.clone();
        for (place, value) in valued().filter(|(place, _)| !place.is_in_model()) {
            place.set(&mut scenario, value)?;
        }
        let path = scenario.get(keys::MODEL.name).and_then(Value::as_str).unwrap_or_default().to_owned();
        let missing = || Failure::input(format!("the study does not have the model `{path}`"));
        let mut model = self.models.get(&path).ok_or_else(missing)?.clone();
        for (place, value) in valued().filter(|(place, _)| place.is_in_model()) {
            place.set(&mut model, value)?;
        }
        Ok(Files { scenario, model, model_path: path })
    }

    /// Names and texts of the files with which a sample is run alone: its scenario, model, and tables.
    ///
    /// # Errors
    /// If a path leads nowhere.
    pub(crate) fn to_run_alone(&self, sample: &Sample) -> Result<Vec<(String, String)>, Failure> {
        let Files { mut scenario, model, .. } = self.files(sample)?;
        scenario.insert(keys::NAME.name.into(), Value::String(format!("sample_{}", sample.index)));
        scenario.insert(keys::MODEL.name.into(), Value::String(MODEL.into()));
        let mut files = vec![];
        for (k, (path, text)) in self.tables.iter().enumerate() {
            let name = format!("table_{k}.csv");
            let rename = &mut |file: &mut String| {
                if file == path {
                    file.clone_from(&name);
                }
            };
            visit_files(&mut scenario, rename);
            files.push((name, text.clone()));
        }
        files.push((SCENARIO.to_owned(), to_toml(&scenario)));
        files.push((MODEL.to_owned(), to_toml(&model)));
        Ok(files)
    }

    /// The scenario of a sample with its warnings.
    ///
    /// # Errors
    /// Its faults.
    pub(super) fn scenario(&self, sample: &Sample) -> Result<(Scenario, Vec<Diagnostic>), Failure> {
        let Files { scenario, model, model_path } = self.files(sample)?;
        let name = format!("sample {}", sample.index);
        let (scenario, model) = (to_toml(&scenario), to_toml(&model));
        let model_name = format!("{name}, {model_path}");
        let held = Held { model: &model, model_name: &model_name, tables: &self.tables };
        let shown = format!("{name}, scenario");
        Scenario::of_text(scenario, Path::new("scenario.toml"), &shown, self.run, (Some(held), true))
    }

    /// Runs a sample: its row, a line of CSV without its end, with the reason if it failed; `None` if it was interrupted.
    pub fn row(&self, sample: &Sample) -> Option<String> {
        // A panic is a fault of this program, but the other samples need not suffer for it.
        let outcome = catch_unwind(AssertUnwindSafe(|| self.outcome(sample)));
        let outcome = outcome.unwrap_or_else(|_| {
            Some(Err(Failure::outside("the computation has panicked").help("this is a fault of redysim: report it")))
        })?;
        Some(match outcome {
            Ok((outcomes, warnings)) => {
                let warnings: Vec<_> = warnings.iter().map(|text| in_a_line(text)).collect();
                self.line(sample, &outcomes, [COMPLETE, &warnings.join("; ")])
            }
            Err(failure) => self.failed_row(sample, &failure.to_string()),
        })
    }

    /// Reads what serde has written of one, in another process perhaps.
    ///
    /// # Errors
    /// If another version of redysim has written it, which may compute other bits.
    pub fn from_json(text: &str) -> Result<Sampler, Failure> {
        let sampler: Sampler =
            serde_json::from_str(text).map_err(|error| Failure::input(format!("not a sampler: {error}")))?;
        let (here, there) = (env!("CARGO_PKG_VERSION"), &sampler.redysim);
        if here == there {
            return Ok(sampler);
        }
        let failure = Failure::outside(format!("the study is of redysim {there}, and this process has {here}"));
        Err(failure.help("install the same version on all machines"))
    }

    /// The row of a sample that was not computed, for a `reason`.
    pub fn failed_row(&self, sample: &Sample, reason: &str) -> String {
        self.line(sample, &[], [FAILED, &in_a_line(reason)])
    }

    /// A row; without outcomes their cells are empty.
    fn line(&self, sample: &Sample, outcomes: &[String], ends: [&str; 2]) -> String {
        let mut cells = vec![sample.index.to_string()];
        sample.values.iter().for_each(|value| write_cells(value, &mut cells));
        let kept = self.outcomes.len() + self.account.len();
        cells.extend((0..kept).map(|k| outcomes.get(k).cloned().unwrap_or_default()));
        cells.extend(ends.map(str::to_owned));
        line(&cells)
    }

    /// What is computed of a sample, unless it is interrupted.
    fn outcome(&self, sample: &Sample) -> Option<Result<Computed, Failure>> {
        let computed = || -> Result<_, Failure> {
            let (scenario, _) = self.scenario(sample)?;
            let mut reducer = Reducer::new(&self.outcomes, &scenario, self.run)?;
            let path = Path::new("the scenario");
            let (summary, warnings) = match self.run {
                Dynamics::Forward => {
                    let wanted = forward::wanted(&scenario, path)?;
                    forward::compute_into(&mut reducer, &scenario, wanted, true)?
                }
                Dynamics::Inverse => {
                    let wanted = inverse::wanted(&scenario, path)?;
                    inverse::compute_into(&mut reducer, &scenario, wanted, true)?
                }
            };
            Ok((reducer, summary, warnings))
        };
        match computed() {
            Ok((reducer, summary, warnings)) => Some(reducer.finish(summary)?.map(|cells| (cells, warnings))),
            Err(failure) if failure.is_interruption() => None,
            Err(failure) => Some(Err(failure)),
        }
    }
}

/// Looks at the path of each file that a scenario names beside its model.
pub fn visit_files(table: &mut Table, visit: &mut dyn FnMut(&mut String)) {
    for (key, value) in table.iter_mut() {
        match value {
            Value::String(file) if key == keys::MOTION_FILE.name => visit(file),
            Value::Table(table) => visit_files(table, visit),
            _ => {}
        }
    }
}

/// What the files of a sample that is run alone are called.
const SCENARIO: &str = "scenario.toml";
const MODEL: &str = "model.toml";

/// A run that came to its end.
pub const COMPLETE: &str = "complete";
/// One that did not.
pub const FAILED: &str = "failed";

/// A message as one line: its first error, and the help.
fn in_a_line(message: &str) -> String {
    const STARTS: [&str; 2] = ["error: ", "warning: "];
    let begins = |line: &&str| line.starts_with(STARTS[0]);
    let first = message.lines().position(|line| begins(&line)).unwrap_or_default();
    let mut lines = message.lines().skip(first).take_while(|line| !line.is_empty());
    let title = lines.next().unwrap_or_default();
    let title = STARTS.iter().find_map(|start| title.strip_prefix(start)).unwrap_or(title);
    match lines.find_map(|line| line.trim().strip_prefix("= help: ")) {
        Some(help) => format!("{title}: {help}"),
        None => title.to_owned(),
    }
}

/// The cells of a value: of an array, one for each of its elements.
fn write_cells(value: &Value, cells: &mut Vec<String>) {
    match value {
        Value::Array(array) => array.iter().for_each(|value| write_cells(value, cells)),
        Value::Float(number) => cells.push(format!("{number:?}")),
        Value::String(text) => cells.push(text.clone()),
        other => cells.push(other.to_string()),
    }
}

/// Whether all cells of a value are numbers.
pub fn is_numeric(value: &Value) -> bool {
    match value {
        Value::Array(array) => array.iter().all(is_numeric),
        _ => value.is_float(),
    }
}

/// What is above the cells of a value at `path`.
pub fn headers(path: &str, value: &Value) -> Vec<String> {
    match value {
        Value::Array(array) => {
            array.iter().enumerate().flat_map(|(k, value)| headers(&format!("{path}.{k}"), value)).collect()
        }
        _ => vec![path.to_owned()],
    }
}

/// A line of CSV without its end.
pub fn line(cells: &[String]) -> String {
    // A row is one line, so that one that is cut off is recognised.
    let cells = cells.iter().map(|cell| cell.replace(['\n', '\r'], " "));
    let mut line = csv::WriterBuilder::new().from_writer(vec![]);
    line.write_record(cells.map(String::into_bytes)).expect("a vector takes any bytes");
    let bytes = line.into_inner().expect("a vector takes any bytes");
    String::from_utf8_lossy(&bytes).trim_end_matches('\n').to_owned()
}

#[cfg(test)]
mod tests {
    use super::in_a_line;

    #[test]
    fn a_message_in_a_line_has_its_title_and_its_help() {
        let message = "warning: it is small\n --> model.toml:1:1\n  = help: leave it out\n\nerror: link `a`: `mass` is -1\n --> model.toml:3:8\n  |\n3 | mass = -1\n  |        ^^ not above 0\n  \
                       = help: give another\n\nerror: the next\n";
        assert_eq!(in_a_line(message), "link `a`: `mass` is -1: give another");
        assert_eq!(in_a_line("error: it is stiff\n  = help: take steps"), "it is stiff: take steps");
    }
}
