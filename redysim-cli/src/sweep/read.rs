//! Reading studies.

use std::collections::btree_map::{BTreeMap, Entry};
use std::path::Path;

use redysim_toml::{Diagnostic, Field, Key, Message, Reader, Spanned, why_missing};
use toml::{Table, Value};

use super::cause::explained;
use super::columns::{self, Column, MOST, Values};
use super::outcomes::{Outcome, Reduction, account};
use super::place::Place;
use super::sampler::{Sampler, visit_files};
use super::{Study, keys, table};
use crate::failure::Failure;
use crate::kind::Kind;
use crate::model::ModelFile;
use crate::scenario::{self, Dynamics, keys as scenario_keys, read_text, shorthand};

/// A study as its file has it.
struct Written {
    name: String,
    scenario: String,
    run: Option<Dynamics>,
    over: Option<Vec<Column>>,
    samples: Option<Drawn>,
    outcomes: Vec<(Reduction, String)>,
}

/// The samples that are not a grid.
struct Drawn {
    columns: Vec<Column>,
    count: Option<usize>,
    seed: u64,
    file: Option<String>,
}

impl Written {
    /// The columns of its table of samples, if it names one.
    fn table(&self, folder: &Path) -> Result<Vec<(Place, Vec<Value>)>, Failure> {
        let Some(file) = self.samples.as_ref().and_then(|drawn| drawn.file.as_ref()) else { return Ok(vec![]) };
        let path = folder.join(file);
        table::of_text(&named(&path, crate::table::read_text(&path))?, &path)
    }

    /// Where the values of each of the `count` paths are given: in the table of samples, whose paths come first, or on a line of
    /// the study in `folder`, which has the `text` and is called `shown`.
    fn origins(&self, count: usize, (text, shown): (&str, &str), folder: &Path) -> Vec<String> {
        let (columns, file) = match (&self.over, &self.samples) {
            (Some(columns), _) => (&columns[..], None),
            (None, Some(Drawn { columns, file, .. })) => (&columns[..], file.as_deref()),
            (None, None) => (&[][..], None),
        };
        let line = |column: &Column| text[..column.span.start].matches('\n').count() + 1;
        let own = columns.iter().map(|column| format!("{shown}:{}", line(column)));
        let file = file.map(|file| folder.join(file).display().to_string()).unwrap_or_default();
        vec![file; count - columns.len()].into_iter().chain(own).collect()
    }
}

/// Reads the text of a study.
///
/// # Errors
/// Every fault of the text at once, or the first of what it names.
pub fn study(text: String, shown: &str, folder: &Path, usual: &str) -> Result<Study, Failure> {
    if let Some(failure) = Kind::Study.mistaken(Path::new(shown), &text) {
        return Err(failure);
    }
    let read =
        redysim_toml::read(text.clone(), shown, &keys::STUDY, "the study", |reader| written(reader, usual, folder));
    let (written, _) = read.map_err(Failure::input)?;
    let in_study = |failure: Failure| failure.in_file(shown);
    let of_file = written.table(folder)?;
    let (places, samples) = samples(&written, of_file).map_err(in_study)?;
    let origins = written.origins(places.len(), (&text, shown), folder);
    let path = folder.join(&written.scenario);
    let text = named(&path, read_text(&path))?;
    if let Some(failure) = Kind::Scenario.mistaken(&path, &text) {
        return Err(failure);
    }
    let alone = |run| {
        let shown = path.display().to_string();
        scenario::Scenario::of_text(text.clone(), &path, &shown, run, (None, true)).err()
    };
    // A text that is not TOML is reported by the reader of scenarios.
    let Ok(mut table) = text.parse::<Table>() else {
        let failure = alone(written.run.unwrap_or(Dynamics::Forward));
        return Err(failure.unwrap_or_else(|| Failure::input(format!("{} is not TOML", path.display()))));
    };
    let run = written.run.map_or_else(|| usual_run(&table, &path), Ok)?;
    check_effect(&places, run).map_err(in_study)?;
    spell_out(&mut table);
    // It may name files that are yet to be written.
    table.remove(&other(run).to_string());
    // What a run has written into it is not a part of the scenario.
    table.remove(scenario_keys::RUN.name);
    let from = path.parent().unwrap_or(Path::new(""));
    let values = |last: &str| {
        let last = last.to_owned();
        let columns = places.iter().enumerate().filter(move |(_, place)| place.last() == last);
        columns.flat_map(|(k, _)| samples.iter().filter_map(move |sample| sample[k].as_str().map(str::to_owned)))
    };
    let (mut models, mut warnings) = (BTreeMap::new(), vec![]);
    let named = table.get(scenario_keys::MODEL.name).and_then(Value::as_str).map(str::to_owned);
    for name in named.into_iter().chain(values(scenario_keys::MODEL.name)) {
        if let Entry::Vacant(model) = models.entry(name) {
            let read = ModelFile::load(from.join(model.key()))?;
            warnings.extend(read.warnings.iter().map(|warning| warning.trim_end().to_owned()));
            model.insert(read.text.parse::<Table>().map_err(|error| Failure::input(error.message()))?);
        }
    }
    let mut tables = BTreeMap::new();
    let mut named = Vec::new();
    visit_files(&mut table, &mut |file| named.push(file.clone()));
    for name in named.into_iter().chain(values(scenario_keys::MOTION_FILE.name)) {
        if let Entry::Vacant(table) = tables.entry(name) {
            let text = crate::table::read_text(&from.join(table.key()));
            let help = "the path of a table is taken from the folder of the scenario";
            table.insert(text.map_err(|fault| fault.help(help))?);
        }
    }
    let sampler = Sampler {
        redysim: env!("CARGO_PKG_VERSION").to_owned(),
        run,
        scenario: table,
        models,
        tables,
        paths: places.iter().map(Place::to_string).collect(),
        outcomes: vec![],
        account: vec![],
    };
    let study = Study { name: written.name, sampler, samples, warnings };
    let read = study.sampler.scenario(&study.sample(0));
    let first = read.map_err(|failure| in_study(explained(failure, &study, &origins, alone(run))))?;
    completed(study, first, &written.outcomes).map_err(in_study)
}

/// The study with what is kept of each run, which the first sample tells: that it can be read is known then.
fn completed(
    mut study: Study,
    (scenario, warnings): (scenario::Scenario, Vec<Diagnostic>),
    wanted: &[(Reduction, String)],
) -> Result<Study, Failure> {
    let run = study.sampler.run;
    // Whether there is something to run.
    let name = Path::new("the scenario");
    match run {
        Dynamics::Forward => drop(crate::commands::forward::wanted(&scenario, name)?),
        Dynamics::Inverse => drop(crate::commands::inverse::wanted(&scenario, name)?),
    }
    study.sampler.outcomes = Outcome::of(wanted, &scenario, run)?;
    study.sampler.account = account(&scenario, run).into_iter().map(str::to_owned).collect();
    study.warnings.extend(warnings.iter().map(ToString::to_string));
    Ok(study)
}

/// `samples` with any keys: paths stand among them.
const SETTINGS: Key = Key::new(keys::SAMPLES.name, "{ count = 1000 }", "");

fn written(mut reader: Reader<'_, '_>, usual: &str, folder: &Path) -> Option<Written> {
    let name = scenario::name(&mut reader).value_or(usual.to_owned());
    let scenario = reader.required(&keys::SCENARIO, Reader::text);
    let is_there = scenario.spanned().map(|named| find(&mut reader, named, folder));
    let run = reader.choice(&keys::RUN, &[("forward", Dynamics::Forward), ("inverse", Dynamics::Inverse)]);
    let over = columns::read(&mut reader, &keys::OVER, &[], (&keys::STEPS, columns::steps));
    let others = keys::SAMPLES_KEYS.keys;
    let listed = columns::read(&mut reader, &keys::SAMPLES, others, (&keys::DRAWN, columns::drawn));
    let settings = reader.table(&SETTINGS, |mut reader| {
        let count = columns::whole(&mut reader, &keys::SAMPLE_COUNT, 1..=MOST as u64);
        let seed = columns::whole(&mut reader, &keys::SEED, 0..=9_000_000_000_000_000);
        let file = reader.text(&keys::FILE);
        Some((optional(count)?.map(|count| count as usize), optional(seed)?, optional(file)?))
    });
    let outcomes = outcomes(&mut reader);
    let over = optional(over)?;
    let samples = match (optional(listed)?, optional(settings)?) {
        (Some(columns), Some(settings)) => {
            let (count, seed, file) = settings?;
            Some(Drawn { columns, count, seed: seed.unwrap_or_default(), file })
        }
        _ => None,
    };
    if over.is_some() == samples.is_some() {
        let message = Message {
            title: "the study: it must have `over` or `samples`, and not both".into(),
            label: "this study".into(),
            help: format!("write for example {}", keys::OVER.example()),
        };
        return reader.error_of_table(message);
    }
    Some(Written {
        name: name?,
        scenario: is_there?.and(scenario.value())?.clone(),
        run: optional(run)?,
        over,
        samples,
        outcomes: outcomes?,
    })
}

/// Reports a scenario that does not exist, at the place that names it.
fn find(reader: &mut Reader<'_, '_>, named: &Spanned<String>, folder: &Path) -> Option<()> {
    let path = folder.join(named.get_ref());
    if path.exists() {
        return Some(());
    }
    let why = why_missing(path.parent().unwrap_or(folder));
    let title = format!("{}: cannot read the scenario {}: {why}", reader.item(), path.display());
    let meant = scenario::meant_from(folder, &path);
    let help = format!("{meant}the path of the scenario is taken from the folder of the study");
    reader.error_at(named.span(), Message { title, label: "named here".into(), help })
}

fn outcomes(reader: &mut Reader<'_, '_>) -> Option<Vec<(Reduction, String)>> {
    let read = reader.table(&keys::OUTCOMES, |mut reader| {
        let mut wanted = Vec::new();
        for (reduction, key) in Reduction::ALL {
            let names = reader.field(&key, |reader, path, value| {
                let array = reader.array(path, value, "an array of symbols")?;
                reader.elements(path, array, |reader, path, value| match value.get_ref() {
                    redysim_toml::DeValue::String(name) => Some(name.to_string()),
                    _ => reader.wrong_type(path, value, "a symbol, such as \"tau\""),
                })
            });
            wanted.extend(names.value().into_iter().flatten().map(|name| (reduction, name.clone())));
        }
        wanted
    });
    optional(read).map(Option::unwrap_or_default)
}

/// A value that may be missing; `None` if it is invalid.
fn optional<T>(field: Field<T>) -> Option<Option<T>> {
    match field {
        Field::Missing => Some(None),
        Field::Invalid => None,
        Field::Value(value) => Some(Some(value.into_inner())),
    }
}

/// Paths, and the values of each sample there.
fn samples(written: &Written, of_file: Vec<(Place, Vec<Value>)>) -> Result<(Vec<Place>, Vec<Vec<Value>>), Failure> {
    let (places, samples) = match (&written.over, &written.samples) {
        (Some(over), _) => grid(over)?,
        (None, Some(drawn)) => sampled(drawn, of_file)?,
        (None, None) => (vec![], vec![]),
    };
    if places.is_empty() || samples.is_empty() {
        let failure = Failure::input("the study varies nothing");
        return Err(failure.help(format!("give values at paths, as in {}", keys::OVER.example())));
    }
    Ok((places, samples))
}

fn too_many(count: impl std::fmt::Display) -> Failure {
    Failure::input(format!("the study has {count} samples, more than {MOST}"))
        .help("take fewer values, or several studies")
}

fn grid(over: &[Column]) -> Result<(Vec<Place>, Vec<Vec<Value>>), Failure> {
    let lists = over.iter().filter_map(|column| match &column.values {
        Values::Listed(values) => Some(values),
        Values::Drawn(_) => None,
    });
    let lists: Vec<&Vec<Value>> = lists.collect();
    let count = lists.iter().try_fold(1_usize, |count, values| count.checked_mul(values.len()));
    let count = count
        .filter(|count| *count <= MOST)
        .ok_or_else(|| too_many(lists.iter().map(|values| values.len().to_string()).collect::<Vec<_>>().join(" · ")))?;
    let sample = |index: usize| {
        let mut rest = index;
        let mut values: Vec<Value> = Vec::with_capacity(lists.len());
        for list in lists.iter().rev() {
            values.push(list[rest % list.len()].clone());
            rest /= list.len();
        }
        values.reverse();
        values
    };
    let samples = if lists.is_empty() { vec![] } else { (0..count).map(sample).collect() };
    Ok((over.iter().map(|column| column.place.clone()).collect(), samples))
}

fn sampled(drawn: &Drawn, of_file: Vec<(Place, Vec<Value>)>) -> Result<(Vec<Place>, Vec<Vec<Value>>), Failure> {
    let mut lists: Vec<(String, usize)> = drawn
        .columns
        .iter()
        .filter_map(|column| match &column.values {
            Values::Listed(values) => Some((format!("`{}`", column.place), values.len())),
            Values::Drawn(_) => None,
        })
        .collect();
    lists.extend(drawn.file.iter().zip(of_file.first()).map(|(file, (_, values))| (file.clone(), values.len())));
    lists.extend(drawn.count.map(|count| ("`samples.count`".to_owned(), count)));
    let Some((what, count)) = lists.first() else {
        let failure = Failure::input("the study does not state how many samples are drawn");
        return Err(failure.help(format!("add to [samples]: {}", keys::SAMPLE_COUNT.example())));
    };
    if let Some((other, length)) = lists.iter().find(|(_, length)| length != count) {
        let message = format!("{what} has {count} samples, but {other} has {length}");
        return Err(Failure::input(message).help("give every path as many values"));
    }
    if *count > MOST {
        return Err(too_many(count));
    }
    let mut places: Vec<Place> = of_file.iter().map(|(place, _)| place.clone()).collect();
    places.extend(drawn.columns.iter().map(|column| column.place.clone()));
    for (k, place) in places.iter().enumerate() {
        if let Some(before) = places[..k].iter().find(|before| before.overlaps(place)) {
            return Err(
                Failure::input(format!("`{place}` is a part of `{before}`, or the same")).help("vary each value once")
            );
        }
    }
    let sample = |index: usize| {
        let of_file = of_file.iter().map(|(_, values)| values[index].clone());
        let others = drawn.columns.iter().enumerate().map(|(column, of)| match &of.values {
            Values::Listed(values) => values[index].clone(),
            Values::Drawn(distribution) => Value::Float(distribution.draw(drawn.seed, column, index)),
        });
        of_file.chain(others).collect()
    };
    Ok((places, (0..*count).map(sample).collect()))
}

/// The run that a scenario is for.
fn usual_run(scenario: &Table, path: &Path) -> Result<Dynamics, Failure> {
    let has = [scenario_keys::INVERSE, scenario_keys::FORWARD].map(|key| scenario.contains_key(key.name));
    match has {
        [true, true] => {
            let failure = Failure::input(format!("{} is for inverse and forward dynamics", path.display()));
            Err(failure.help("specify which is meant: run = \"inverse\" or run = \"forward\""))
        }
        [true, false] => Ok(Dynamics::Inverse),
        [false, _] => Ok(Dynamics::Forward),
    }
}

/// Replaces names of kinds by the tables that they stand for, so that paths lead into these.
fn spell_out(scenario: &mut Table) {
    shorthand::TRAJECTORY.spell_out(scenario);
    if let Some(forward) = scenario.get_mut(scenario_keys::FORWARD.name).and_then(Value::as_table_mut) {
        shorthand::IN_FORWARD.iter().for_each(|shorthand| shorthand.spell_out(forward));
    }
}

/// What was read of a file that a study names.
fn named(path: &Path, read: Result<String, Failure>) -> Result<String, Failure> {
    read.map_err(|failure| match path.exists() {
        true => failure,
        false => failure.help("the path is taken from the folder of the study"),
    })
}

/// The run that is not computed.
fn other(run: Dynamics) -> Dynamics {
    match run {
        Dynamics::Forward => Dynamics::Inverse,
        Dynamics::Inverse => Dynamics::Forward,
    }
}

/// Fails if a path leads to what has no effect on the run.
fn check_effect(places: &[Place], run: Dynamics) -> Result<(), Failure> {
    let other = other(run).to_string();
    let without = [scenario_keys::NAME.name, scenario_keys::RUN.name, other.as_str()];
    match places.iter().find(|place| without.contains(&place.first())) {
        Some(place) => {
            let failure = Failure::input(format!("`{place}` has no effect on {run} dynamics"));
            Err(failure.help("leave it out, or take another `run`"))
        }
        None => Ok(()),
    }
}
