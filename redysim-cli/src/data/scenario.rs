//! Scenarios.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use toml_edit::DocumentMut;

use super::file;
use super::{Contact, Ground, Integrator, Torque, Trajectory, nothing_else};
use crate::failure::Failure;
use crate::scenario::{Dynamics, keys, read_text};
use crate::text::to_toml;

/// What is to be computed of a model: a scenario file as data, with its keys as fields.
///
/// Numbers are in SI units, angles in rad. `None` stands for a key that the file does not have, and so for its default
/// (`docs/scenario_keys.md` lists all keys and defaults).
///
/// # Example
///
/// ```
/// use redysim_cli::{Forward, Initial, Integrator, Scenario, Tolerances, Torque};
///
/// let mut swing = Scenario {
///     initial: Some(Initial { q: Some([0.0, 1.0].into()), ..Initial::default() }),
///     forward: Some(Forward {
///         integrator: Some(Integrator::Ode45(Tolerances { rtol: Some(1e-6), ..Tolerances::default() })),
///         torque: Some(Torque::Pd {
///             joints: None,
///             target: [0.5, 0.5].into(),
///             kp: 49.0.into(),
///             kd: 14.0.into(),
///             limits: None,
///         }),
///         ..Forward::new(1.0, 0.01)
///     }),
///     ..Scenario::new("two_link.toml")
/// };
/// let models = concat!(env!("CARGO_MANIFEST_DIR"), "/../models");
/// assert!(swing.check(models)?.is_empty(), "no warnings");
/// let text = swing.to_toml();
/// let read = Scenario::from_toml(text, format!("{models}/swing.toml"))?; // its name is that of the file
/// assert_eq!(read, Scenario { name: Some("swing".into()), ..swing.clone() });
///
/// swing.initial = Some(Initial { v: Some([0.0].into()), ..Initial::default() });
/// println!("{}", swing.check(models).unwrap_err()); // `initial.v` must have 2 values, one for each of joint1, joint2
/// # Ok::<(), redysim_cli::Failure>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// What the results are called; by default the name of the file.
    pub name: Option<String>,
    /// The path of a model file or URDF, from the folder of the scenario.
    pub model: String,
    /// Where the mechanism starts, or which branch of closed loops is meant.
    pub initial: Option<Initial>,
    /// The motion that is prescribed or followed.
    pub trajectory: Option<Trajectory>,
    /// The instants at which inverse dynamics is computed.
    pub inverse: Option<Span>,
    /// The motion that forward dynamics computes.
    pub forward: Option<Forward>,
    /// The ground that frames may touch in that motion; by default the plane z = 0.
    pub ground: Option<Ground>,
    /// The frames that may touch it; by default none.
    pub contact: Option<Vec<Contact>>,
}

/// Where a mechanism starts.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// Coordinates, rad, m or components of quaternions; by default the neutral position.
    pub q: Option<Values>,
    /// Velocities, rad/s or m/s; by default zero.
    pub v: Option<Values>,
    /// Whether loops are closed from there; by default they are.
    pub assemble: Option<bool>,
    /// The joints, or velocities of them, that stay where they are while loops are closed; by default the actuated ones.
    pub held: Option<Vec<String>>,
}

/// The instants of a run: `start`, `start + step`, … up to `end`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// The first instant, s; by default 0.
    pub start: Option<f64>,
    /// No instant is later, s.
    pub end: f64,
    /// From one instant to the next, s.
    pub step: f64,
}

/// The motion that forward dynamics computes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Forward {
    /// The first instant, s; by default 0.
    pub start: Option<f64>,
    /// No instant is later, s.
    pub end: f64,
    /// From one row of the results to the next, s.
    pub step: f64,
    /// The integrator; by default `Ode45`.
    pub integrator: Option<Integrator>,
    /// The joints, or velocities of them, that follow the trajectory whatever force it takes, while the others are free or
    /// driven; by default none.
    pub prescribed: Option<Vec<String>>,
    /// What the actuators do; by default nothing.
    pub torque: Option<Torque>,
    /// What keeps loops closed; by default projection.
    pub stabilisation: Option<Stabilisation>,
}

/// What keeps closed loops closed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Stabilisation {
    /// The state is projected back onto the constraints after each step.
    #[serde(deserialize_with = "nothing_else")]
    Projection,
    /// Nothing.
    #[serde(deserialize_with = "nothing_else")]
    None,
    /// Baumgarte's feedback.
    Baumgarte {
        /// Its rate, 1/s.
        alpha: f64,
    },
}

/// Numbers for the joints of a mechanism.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "expected a number, an array of numbers, or numbers by the names of joints; angles are in rad"
)]
pub enum Values {
    /// One number for all of them, as gains and limits allow.
    Uniform(f64),
    /// One number for each, in the order of the model.
    Each(Vec<f64>),
    /// Numbers by the names of the joints; the others are neutral, zero, or without limit.
    Named(BTreeMap<String, f64>),
}

impl From<f64> for Values {
    fn from(value: f64) -> Self {
        Values::Uniform(value)
    }
}

impl From<Vec<f64>> for Values {
    fn from(values: Vec<f64>) -> Self {
        Values::Each(values)
    }
}

impl<const N: usize> From<[f64; N]> for Values {
    fn from(values: [f64; N]) -> Self {
        Values::Each(values.into())
    }
}

impl Forward {
    /// A motion from 0 to `end`, s, with a row of results every `step`, s, and defaults for everything else.
    pub fn new(end: f64, step: f64) -> Self {
        Forward { start: None, end, step, integrator: None, prescribed: None, torque: None, stabilisation: None }
    }
}

impl Scenario {
    /// A scenario of the model file or URDF at the path `model`, from the folder of the scenario, without a run.
    pub fn new(model: impl Into<String>) -> Self {
        Scenario {
            name: None,
            model: model.into(),
            initial: None,
            trajectory: None,
            inverse: None,
            forward: None,
            ground: None,
            contact: None,
        }
    }

    /// Reads a scenario file and checks it for each run that it has. A scenario without a name gets that of the file.
    /// [`check`](Self::check) has the warnings.
    ///
    /// # Errors
    ///
    /// The faults that `redysim inverse` and `redysim forward` report. A run may need a table that the other one has
    /// yet to write: [`load_for`](Self::load_for) reads what there is for one of them.
    pub fn load(path: impl AsRef<Path>) -> Result<Scenario, Failure> {
        let path = path.as_ref();
        Scenario::from_toml(read_text(path)?, path)
    }

    /// Reads what a scenario file has for one run, as the command does.
    ///
    /// # Errors
    ///
    /// The faults that the command reports.
    pub fn load_for(path: impl AsRef<Path>, run: Dynamics) -> Result<Scenario, Failure> {
        let path = path.as_ref();
        file::read(&read_text(path)?, path, &[run])
    }

    /// The same as [`load`](Self::load) of the text of a scenario file at `path`: the files that it names are in its
    /// folder.
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load).
    pub fn from_toml(text: impl Into<String>, path: impl AsRef<Path>) -> Result<Scenario, Failure> {
        let text = text.into();
        let document: DocumentMut = text.parse().unwrap_or_default();
        let [inverse, forward] = [keys::INVERSE, keys::FORWARD].map(|key| document.contains_key(key.name));
        file::read(&text, path.as_ref(), &runs(inverse, forward))
    }

    /// The text of a scenario file that reads back to this scenario, to the same bits; without a name, to that of the
    /// file.
    ///
    /// A scenario with a fault, such as a number that is not finite, is written as well, so that
    /// [`check`](Self::check) shows where the fault is.
    pub fn to_toml(&self) -> String {
        to_toml(self)
    }

    /// Checks a scenario that was built in Rust by the rules for files; the files that it names are in `folder`.
    /// Returns the warnings of the scenario; those of its model are `redysim_model::Model::load`'s. Since all angles
    /// are plain numbers, one that a file has with a unit may be doubted here, such as `"450 deg"`.
    ///
    /// # Errors
    ///
    /// As [`load`](Self::load); faults of the scenario are shown in [its text](Self::to_toml).
    pub fn check(&self, folder: impl AsRef<Path>) -> Result<Vec<String>, Failure> {
        let runs = runs(self.inverse.is_some(), self.forward.is_some());
        let path = folder.as_ref().join("scenario.toml");
        Ok(file::check(&self.to_toml(), &path, "the scenario, written as TOML", &runs)?.warnings)
    }

    /// The scenario with nothing but what it has for one of its runs.
    pub(super) fn only(self, run: Dynamics) -> Self {
        match run {
            Dynamics::Inverse => Scenario { forward: None, ground: None, contact: None, ..self },
            Dynamics::Forward => Scenario { inverse: None, ..self },
        }
    }
}

/// The runs that a scenario is for; forward dynamics if it is for none, so that what it has is checked.
fn runs(inverse: bool, forward: bool) -> Vec<Dynamics> {
    match (inverse, forward) {
        (true, true) => vec![Dynamics::Inverse, Dynamics::Forward],
        (true, false) => vec![Dynamics::Inverse],
        (false, _) => vec![Dynamics::Forward],
    }
}
