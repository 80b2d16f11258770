//! Scenario files: checked by the commands' reader, which knows all rules, then read as data.

use std::path::Path;

use redysim_toml::radians;
use toml::{Table, Value};

use super::Scenario;
use crate::failure::Failure;
use crate::scenario::{self, Dynamics, keys};

/// The runs that a scenario is for; forward dynamics if it is for none, so that what it has is checked.
pub fn runs(text: &str) -> Vec<Dynamics> {
    let table: Table = text.parse().unwrap_or_default();
    let has = |run: &Dynamics| table.contains_key(&run.to_string());
    let runs: Vec<_> = [Dynamics::Inverse, Dynamics::Forward].into_iter().filter(has).collect();
    if runs.is_empty() { vec![Dynamics::Forward] } else { runs }
}

/// The warnings of a scenario at `path`, whose messages name it `shown`, for `runs`.
///
/// # Errors
/// The faults for the first run that has any.
pub fn check(text: &str, path: &Path, shown: &str, runs: &[Dynamics]) -> Result<Vec<String>, Failure> {
    let mut warnings = Vec::new();
    for &run in runs {
        let (_, found) = scenario::Scenario::of_text(text.to_owned(), path, shown, run, true)?;
        warnings.extend(found.iter().map(ToString::to_string));
    }
    // What both runs read has its warnings twice.
    let mut seen = std::collections::HashSet::new();
    warnings.retain(|warning| seen.insert(warning.clone()));
    Ok(warnings)
}

/// The scenario at `path` with what it has for `runs`.
///
/// # Errors
/// As [`check`].
pub fn read(text: String, path: &Path, runs: &[Dynamics]) -> Result<Scenario, Failure> {
    check(&text, path, &path.display().to_string(), runs)?;
    let mut table: Table = text.parse().map_err(|error| unread(path, &error))?;
    table.remove(keys::RUN.name);
    for run in [Dynamics::Inverse, Dynamics::Forward] {
        if !runs.contains(&run) {
            table.remove(&run.to_string());
        }
    }
    spell_out(&mut table);
    let scenario: Scenario = table.try_into().map_err(|error| unread(path, &error))?;
    let stem = || path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    Ok(Scenario { name: scenario.name.or_else(stem), ..scenario })
}

fn unread(path: &Path, error: &toml::de::Error) -> Failure {
    Failure::input(format!("{}: {}", path.display(), error.message()))
}

/// Replaces what stands for something longer: names of kinds for tables, other names of integrators, kinds by default,
/// and angles with a unit.
fn spell_out(scenario: &mut Table) {
    kind(scenario, keys::TRAJECTORY.name, keys::MOTION_KIND.name, "cycloid");
    if let Some(Value::Table(forward)) = scenario.get_mut(keys::FORWARD.name) {
        kind(forward, keys::TORQUE.name, keys::LAW.name, "free");
        kind(forward, keys::STABILISATION.name, keys::STABILISATION_KIND.name, "projection");
        kind(forward, keys::INTEGRATOR.name, keys::METHOD.name, "Ode45");
        if let Some(Value::Table(integrator)) = forward.get_mut(keys::INTEGRATOR.name)
            && let Some(method) = integrator.get_mut(keys::METHOD.name)
        {
            *method = scenario::usual_method(&named(method)).into();
        }
    }
    scenario.iter_mut().for_each(|(_, value)| angles(value));
}

/// Makes a table of the kind whose name stands under `key`; without a name it is of the kind `default`.
fn kind(table: &mut Table, key: &str, tag: &str, default: &str) {
    match table.get_mut(key) {
        Some(Value::Table(table)) if table.contains_key(tag) => {}
        Some(Value::Table(table)) => drop(table.insert(tag.into(), default.into())),
        Some(name) => {
            let name = named(name);
            *table.get_mut(key).expect("it is there") = Value::Table(Table::from_iter([(tag.to_owned(), name.into())]));
        }
        None => {}
    }
}

/// The name of a kind, which may be a number.
fn named(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Converts angles with a unit under the keys that may have them.
fn angles(value: &mut Value) {
    const KEYS: [&str; 8] = [
        keys::Q.name,
        keys::V.name,
        keys::FROM.name,
        keys::TO.name,
        keys::SPEED.name,
        keys::POINTS.name,
        keys::TARGET.name,
        keys::RPY.name,
    ];
    let Value::Table(table) = value else { return };
    for (key, value) in table {
        if KEYS.contains(&key.as_str()) { in_radians(value) } else { angles(value) }
    }
}

fn in_radians(value: &mut Value) {
    match value {
        Value::String(text) => {
            if let Some(angle) = radians(text, "/s") {
                *value = Value::Float(angle);
            }
        }
        Value::Array(values) => values.iter_mut().for_each(in_radians),
        Value::Table(table) => table.iter_mut().for_each(|(_, value)| in_radians(value)),
        _ => {}
    }
}
