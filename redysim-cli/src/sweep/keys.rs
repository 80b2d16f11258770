//! The keys of a study. All that is known of a key stands here, as of the keys of a scenario.

use redysim_toml::{Key, Keys};

pub const STUDY: Keys = Keys::new("A study", &[NAME, SCENARIO, RUN, OVER, SAMPLES, OUTCOMES]);
pub const NAME: Key = Key::new("name", "\"gains\"", "what the results are called").with_default("the name of the file");
pub const SCENARIO: Key =
    Key::new("scenario", "\"fall.toml\"", "the scenario file, from the folder of the study").with_default("required");
pub const RUN: Key = Key::new("run", "\"forward\"", "or inverse: what is computed of each sample")
    .with_default("the one that the scenario is for");
pub const OVER: Key = Key::of_table(
    "over",
    "{ \"forward.torque.kp\" = [10, 20, 40], \"initial.q.0\" = { from = -1.0, to = 1.0, count = 5 } }",
    "values at paths into the scenario, or after `model.` into its model: every combination is a sample, the last path \
     varies fastest",
    &[&STEPS],
)
.with_default("required, unless there are `samples`");
pub const STEPS: Keys = Keys::new("A list of values at equal distances", &[FROM, TO, COUNT]);
pub const FROM: Key = Key::new("from", "-1.0", "the first value").with_default("required");
pub const TO: Key = Key::new("to", "1.0", "the last value").with_default("required");
pub const COUNT: Key = Key::new("count", "5", "how many there are").with_default("required");

pub const SAMPLES: Key = Key::of_table(
    "samples",
    "{ count = 1000, seed = 1, \"model.link.crank.mass\" = { normal = [1.5, 0.01] } }",
    "values at paths, sample by sample: a list with a value for each sample, or a distribution; beside the paths stand the keys below",
    &[&SAMPLES_KEYS, &DRAWN],
)
.with_default("required, unless there is `over`");
pub const SAMPLES_KEYS: Keys = Keys::new("`samples`", &[SAMPLE_COUNT, SEED, FILE]);
pub const SAMPLE_COUNT: Key = Key::new("count", "1000", "how many samples are drawn")
    .with_default("the length of the lists; required without lists");
pub const SEED: Key = Key::new("seed", "1", "whole and not negative; other samples with another one").with_default("0");
pub const FILE: Key = Key::new(
    "file",
    "\"samples.csv\"",
    "a table from the folder of the study, with a row for each sample and a path above each column",
)
.with_default("none");
pub const DRAWN: Keys = Keys::new("A distribution", &[NORMAL, UNIFORM]);
pub const NORMAL: Key =
    Key::new("normal", "[1.5, 0.01]", "mean and standard deviation").with_default("required, or `uniform`");
pub const UNIFORM: Key =
    Key::new("uniform", "[0.9, 1.1]", "the least and the largest value").with_default("required, or `normal`");

pub const OUTCOMES: Key = Key::of_table(
    "outcomes",
    "{ peak = [\"tau\"], last = [\"q\", \"v joint1\"] }",
    "what is kept of each run: columns of its tables, by symbol, or by symbol and name",
    &[&OUTCOMES_KEYS],
)
.with_default("`peak = [\"tau\"]`; of a motion also `last = [\"q\", \"v\"]`, of inverse dynamics `rms = [\"tau\"]`");
pub const OUTCOMES_KEYS: Keys = Keys::new("`outcomes`", &[LAST, PEAK, LARGEST, LEAST, MEAN, RMS]);
pub const LAST: Key = Key::new("last", "[\"q\"]", "the values at the last instant").with_default("none");
pub const PEAK: Key = Key::new("peak", "[\"tau\"]", "the largest sizes").with_default("none");
pub const LARGEST: Key = Key::new("largest", "[\"normal\"]", "the largest values").with_default("none");
pub const LEAST: Key = Key::new("least", "[\"z foot\"]", "the least values").with_default("none");
pub const MEAN: Key = Key::new("mean", "[\"total\"]", "the means over the instants").with_default("none");
pub const RMS: Key =
    Key::new("rms", "[\"tau crank\"]", "the roots of the means of the squares over the instants").with_default("none");

#[cfg(test)]
mod tests {
    #[test]
    fn the_guide_lists_every_key_of_a_study_with_its_example_and_meaning() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/study_keys.md");
        let documentation = format!("# Keys of a study\n\n{}", super::STUDY.documentation());
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(path, &documentation).unwrap();
        }
        assert!(std::fs::read_to_string(path).unwrap() == documentation, "BLESS=1 writes docs/study_keys.md anew");
    }
}
