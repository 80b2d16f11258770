//! Which line of a study is at fault where its first sample cannot be read.

use super::{Sample, Study};
use crate::failure::Failure;

/// The failure of the first sample as a person looks for it: that of the scenario `alone`, which names its file, if it has the
/// fault without the study; otherwise with the line of the study whose value brings it about.
pub fn explained(failure: Failure, study: &Study, origins: &[String], alone: Option<Failure>) -> Failure {
    let has_it = |other: &Failure| other.message().lines().any(|line| line == failure.title());
    if let Some(own) = alone.filter(has_it) {
        return own;
    }
    let fails_with = |count: usize| {
        let mut sampler = study.sampler.clone();
        sampler.paths.truncate(count);
        let Sample { index, mut values } = study.sample(0);
        values.truncate(count);
        sampler.scenario(&Sample { index, values }).err().is_some_and(|other| has_it(&other))
    };
    let paths = &study.sampler.paths;
    match (0..=paths.len()).find(|&count| fails_with(count)) {
        Some(count @ 1..) => {
            let (path, origin) = (&paths[count - 1], &origins[count - 1]);
            failure.and(&format!("\n  = note: the value of `{path}` is given at {origin}"))
        }
        _ => failure,
    }
}
