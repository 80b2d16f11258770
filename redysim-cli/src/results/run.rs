//! How a run went.

use std::path::Path;

use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::scenario::{Dynamics, keys};
use crate::text::to_toml;

/// How a run went: the table `[run]` of `run.toml`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// What was computed.
    pub command: Dynamics,
    /// The version of redysim.
    pub redysim: String,
    /// How it ended.
    pub ended: Ending,
    /// Why it failed, if it did.
    pub reason: Option<String>,
    /// The first instant, s.
    pub from: f64,
    /// The last instant, s.
    pub until: f64,
    /// How many instants there are.
    pub instants: u64,
    /// Wall time of computing and writing, s.
    pub seconds: f64,
    /// Accepted steps of the integration, if there was one.
    pub steps: Option<u64>,
    /// Rejected steps. Of an integration that fails, this and the following are not known.
    pub rejected: Option<u64>,
    /// Evaluations of the right-hand side.
    pub evaluations: Option<u64>,
    /// Accepted steps whose end was corrected.
    pub corrections: Option<u64>,
    /// Evaluations of the Jacobian.
    pub jacobians: Option<u64>,
    /// Decompositions of a matrix.
    pub decompositions: Option<u64>,
    /// How often a contact touched down, if there are contacts.
    pub touch_downs: Option<u64>,
    /// The largest drift of the energy at an instant or the end of a step, J.
    pub energy_drift: f64,
    /// What to compare it with: the most that was there as kinetic energy, as a change of the potential energy, or as
    /// work, J.
    pub energy_exchanged: f64,
    /// The largest drift of the linear momentum, N s, of a motion on which nothing outside acts: without gravity, on free
    /// joints without forces.
    pub linear_momentum_drift: Option<f64>,
    /// The same of the angular momentum about the origin of the base frame, N m s.
    pub angular_momentum_drift: Option<f64>,
    /// The largest position residual of a loop, m (or a sine), if there are loops.
    pub worst_position_residual: Option<f64>,
    /// Coordinates at the first instant, rad or m.
    pub start_q: Vec<f64>,
    /// Velocities at the first instant, rad/s or m/s.
    pub start_v: Vec<f64>,
    /// The URDF of which the model was made, if it was.
    pub urdf: Option<String>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ending {
    /// At its last instant.
    Complete,
    /// Before it, by Ctrl-C.
    Interrupted,
    /// Before it, because it could not go on.
    Failed,
}

impl Run {
    /// How the run of the `run.toml` at `path` went.
    pub(crate) fn of_file(text: &str, path: &Path) -> Result<Run, Failure> {
        let fault = |what: String| {
            let message = format!("{}: {what}", path.display());
            Failure::input(message).help("results are read as a run has written them: run the scenario again")
        };
        let mut table: toml::Table = text.parse().map_err(|error: toml::de::Error| fault(error.to_string()))?;
        let name = keys::RUN.name;
        let run = table.remove(name).ok_or_else(|| fault(format!("it has no table `[{name}]`, which a run writes")))?;
        run.try_into().map_err(|error| fault(format!("the table `[{name}]`: {}", error.message())))
    }

    /// The table of `run.toml`, with its header.
    pub(crate) fn to_toml(&self) -> String {
        format!("# How it went.\n[{}]\n{}", keys::RUN.name, to_toml(self))
    }
}
