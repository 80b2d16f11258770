//! Studies: a scenario that is run for many samples of its values.

mod cause;
mod columns;
mod draw;
mod keys;
mod outcomes;
mod parts;
mod place;
mod read;
mod rows;
mod sampler;
mod table;

use std::path::Path;

use serde::{Deserialize, Serialize};
use toml::Value;

use crate::failure::Failure;
use crate::output::visible;
pub use rows::{Rows, is_of_rows};
use sampler::COMPLETE;
pub use sampler::{Sample, Sampler};

/// A study: a scenario, paths into it and its model, the values there of each sample, and what is kept of each run.
///
/// ```
/// use redysim_cli::{Study, SweepRows};
///
/// let folder = tempfile::tempdir().unwrap();
/// let study = "scenario = 'two_link.toml'\nrun = 'forward'\n[over]\nforward.end = [0.1, 0.2]\n";
/// let scenarios = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios");
/// let study = Study::from_toml(study, "the study", scenarios, "ends")?;
/// let (sampler, mut rows) = (study.sampler(), SweepRows::open(folder.path().join("ends"), &study, false)?);
/// for index in rows.missing() {
///     let row = sampler.row(&study.sample(index)).expect("it is not interrupted");
///     rows.add(index, &row)?;
/// }
/// rows.finish()?;
/// assert_eq!((rows.count(), &study.headers()[..2]), (2, &["sample".to_owned(), "forward.end".to_owned()][..]));
/// # Ok::<(), redysim_cli::Failure>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Study {
    name: String,
    sampler: Sampler,
    /// The values of each sample, one for each path.
    samples: Vec<Vec<Value>>,
    #[serde(skip)]
    warnings: Vec<String>,
}

impl Study {
    /// Reads a study file with all that it names.
    ///
    /// # Errors
    /// Every fault of the file at once, or the first of what it names.
    pub fn load(path: impl AsRef<Path>) -> Result<Study, Failure> {
        let path = path.as_ref();
        let text = crate::scenario::read_text(path)?;
        let stem = path.file_stem().map_or("study".into(), |stem| stem.to_string_lossy().into_owned());
        let folder = path.parent().unwrap_or(Path::new(""));
        Study::from_toml(text, &path.display().to_string(), folder, &stem)
    }

    /// The same of the text of a study, whose messages name it `shown`. The files that it names are in `folder`, and
    /// without a name it has the name `usual`.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn from_toml(
        text: impl Into<String>,
        shown: &str,
        folder: impl AsRef<Path>,
        usual: &str,
    ) -> Result<Study, Failure> {
        read::study(text.into(), shown, folder.as_ref(), usual)
    }

    /// What the results are called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many samples there are.
    pub fn count(&self) -> usize {
        self.samples.len()
    }

    /// What all samples have in common, with which each is computed.
    pub fn sampler(&self) -> &Sampler {
        &self.sampler
    }

    /// A sample, counted from 0.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn sample(&self, index: usize) -> Sample {
        Sample { index, values: self.samples[index].clone() }
    }

    /// The warnings about the models, and about the scenario of the first sample.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// What is above the columns of its rows.
    pub fn headers(&self) -> Vec<String> {
        let Sampler { paths, outcomes, account, .. } = &self.sampler;
        let first = self.samples.first().map_or(&[][..], Vec::as_slice);
        let values = paths.iter().zip(first).flat_map(|(path, value)| sampler::headers(path, value));
        let kept = outcomes.iter().map(outcomes::Outcome::header).chain(account.iter().cloned());
        let mut headers = vec!["sample".to_owned()];
        headers.extend(values);
        headers.extend(kept);
        headers.extend(["status".to_owned(), "reason".to_owned()]);
        headers
    }

    /// For each column of its rows whether there are numbers below it.
    pub fn numeric(&self) -> Vec<bool> {
        let Sampler { outcomes, account, paths, .. } = &self.sampler;
        let is_numeric = |column: usize| self.samples.iter().all(|values| sampler::is_numeric(&values[column]));
        let mut numeric = vec![true];
        for (column, path) in paths.iter().enumerate() {
            let cells = self.samples.first().map_or(0, |values| sampler::headers(path, &values[column]).len());
            numeric.resize(numeric.len() + cells, is_numeric(column));
        }
        numeric.resize(numeric.len() + outcomes.len() + account.len(), true);
        numeric.extend([false, false]);
        numeric
    }

    /// The study as JSON, which reads back to the same bits.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("JSON has tables, strings and finite numbers")
    }

    /// Reads what [`to_json`](Self::to_json) has written.
    ///
    /// # Errors
    /// If it is something else.
    pub fn from_json(text: &str) -> Result<Study, Failure> {
        serde_json::from_str(text)
            .map_err(|error| Failure::input(format!("not a study: {}", visible(&error.to_string()))))
    }

    /// What of another study is not as here; nothing if it only has fewer samples, or more.
    pub(crate) fn difference(&self, other: &Study) -> Option<String> {
        let (here, there) = (&self.sampler, &other.sampler);
        let parts = [
            (here.redysim == there.redysim, "the version of redysim"),
            (here.run == there.run, "what is computed"),
            (here.scenario == there.scenario, "the scenario"),
            (here.models == there.models, "the model"),
            (here.tables == there.tables, "a table of the scenario"),
            (here.paths == there.paths, "the paths"),
            (here.outcomes == there.outcomes, "the outcomes"),
            (here == there, "the account"),
            (self.samples.iter().zip(&other.samples).all(|(one, other)| one == other), "the samples"),
        ];
        parts.iter().find(|(is_same, _)| !is_same).map(|(_, what)| (*what).to_owned())
    }
}
