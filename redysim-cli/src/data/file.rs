//! Scenario files: checked by the commands' reader, which knows all rules, then read as data.

use std::path::Path;

use redysim_toml::radians;
use toml_edit::visit_mut::{self, VisitMut};
use toml_edit::{DocumentMut, Item, KeyMut, TableLike, Value};

use super::Scenario;
use super::in_space::InSpace;
use crate::failure::Failure;
use crate::layout::Layout;
use crate::scenario::{self, Dynamics, keys, shorthand};

/// A scenario that the commands accept.
pub struct Checked {
    pub document: DocumentMut,
    pub warnings: Vec<String>,
    layout: Layout,
}

/// Checks the text of the scenario at `path`, whose messages name it `shown`, for each of `runs`.
///
/// # Errors
/// The faults for the first run that has any.
pub fn check(text: &str, path: &Path, shown: &str, runs: &[Dynamics]) -> Result<Checked, Failure> {
    let mut checked = Checked { document: DocumentMut::new(), warnings: vec![], layout: Layout::default() };
    for &run in runs {
        let (scenario, found) = scenario::Scenario::of_text(text.to_owned(), path, shown, run, (None, true))?;
        checked.document = scenario.document;
        checked.layout = scenario.layout;
        for warning in found.iter().map(ToString::to_string) {
            // What both runs read has its warnings twice.
            if !checked.warnings.contains(&warning) {
                checked.warnings.push(warning);
            }
        }
    }
    Ok(checked)
}

/// The scenario at `path` with what it has for `runs`.
///
/// # Errors
/// As [`check`].
pub fn read(text: &str, path: &Path, runs: &[Dynamics]) -> Result<Scenario, Failure> {
    let Checked { mut document, layout, .. } = check(text, path, &path.display().to_string(), runs)?;
    document.remove(keys::RUN.name);
    for run in [Dynamics::Inverse, Dynamics::Forward] {
        if !runs.contains(&run) {
            document.remove(&run.to_string());
        }
    }
    if !runs.contains(&Dynamics::Forward) {
        for key in [keys::GROUND, keys::CONTACT] {
            document.remove(key.name);
        }
    }
    spell_out(&mut document, &layout);
    let scenario: Scenario = toml::from_str(&document.to_string())
        .map_err(|error| Failure::input(format!("{}: {}", path.display(), error.message())))?;
    let stem = || path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    Ok(Scenario { name: scenario.name.or_else(stem), ..scenario })
}

/// Replaces what stands for something longer: names of kinds for tables, other names of integrators, kinds by default,
/// angles with a unit, and joints of several coordinates by one name.
fn spell_out(scenario: &mut DocumentMut, layout: &Layout) {
    if let Some(trajectory) = scenario.get_mut(keys::TRAJECTORY.name) {
        shorthand::TRAJECTORY.expand(trajectory);
    }
    let forward = scenario.get_mut(keys::FORWARD.name).and_then(Item::as_table_like_mut);
    if let Some(forward) = forward {
        for shorthand in shorthand::IN_FORWARD {
            forward.get_mut(shorthand.key).into_iter().for_each(|item| shorthand.expand(item));
        }
        usual_method(forward);
    }
    Radians { within: false }.visit_document_mut(scenario);
    InSpace { layout, of: None }.visit_document_mut(scenario);
}

/// Gives the integrator of `forward` its usual name.
fn usual_method(forward: &mut dyn TableLike) {
    let Some(integrator) = forward.get_mut(keys::INTEGRATOR.name) else { return };
    let method = &mut integrator[keys::METHOD.name];
    if let Some(name) = shorthand::name(method) {
        *method = toml_edit::value(scenario::usual_method(&name));
    }
}

/// Converts angles with a unit under the keys that may have them.
struct Radians {
    /// Whether the place is under such a key.
    within: bool,
}

impl VisitMut for Radians {
    fn visit_table_like_kv_mut(&mut self, key: KeyMut<'_>, item: &mut Item) {
        const KEYS: [&str; 9] = [
            keys::Q.name,
            keys::V.name,
            keys::FROM.name,
            keys::TO.name,
            keys::SPEED.name,
            keys::POINTS.name,
            keys::TARGET.name,
            keys::RPY.name,
            keys::ANGLE.name,
        ];
        let within = self.within || KEYS.contains(&key.get());
        visit_mut::visit_table_like_kv_mut(&mut Radians { within }, key, item);
    }

    fn visit_value_mut(&mut self, value: &mut Value) {
        match value.as_str().filter(|_| self.within).and_then(|text| radians(text, "/s")) {
            Some(angle) => *value = angle.into(),
            None => visit_mut::visit_value_mut(self, value),
        }
    }
}
