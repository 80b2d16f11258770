//! How a run went.

use std::fmt;

use redysim_runtime::{ContactEvent, Statistics};

use super::Balance;
use super::momentum::MomentumDrift;
use crate::failure::Failure;
use crate::number::{all_digits, counted, size};
use crate::scenario::Dynamics;

/// How a computation went, of which the [`Record`](super::Record) knows but the rows.
pub struct Outcome {
    pub ended: Ended,
    /// By which integrator, if it was integrated.
    pub integrator: Option<String>,
    /// Accepted steps of the integration, if there was one.
    pub steps: Option<u64>,
    /// What else it took: an integration that fails does not report it.
    pub statistics: Option<Statistics>,
    /// The largest position residual of a loop, m (or a sine), if there are loops.
    pub position_residual: Option<f64>,
    /// How many contacts there are, and their touch-downs, if there are contacts.
    pub contacts: Option<(usize, Vec<ContactEvent<f64>>)>,
}

/// How a run ended.
pub enum Ended {
    /// At its end.
    Complete,
    /// By Ctrl-C.
    Interrupted,
    /// Because it could not go on.
    Failed(Failure),
}

/// How a run went.
pub struct Summary {
    /// The scenario's name.
    pub name: String,
    pub dynamics: Dynamics,
    /// First and last instant, s, and how many there are.
    pub instants: (f64, f64, usize),
    /// Wall time, s, of computing and writing the rows.
    pub seconds: f64,
    pub balance: Balance,
    /// Of a motion on which nothing outside acts.
    pub momentum: Option<MomentumDrift>,
    /// Position and velocity at the first instant.
    pub start: [Vec<f64>; 2],
    pub outcome: Outcome,
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Outcome { integrator, steps, statistics, position_residual, contacts, .. } = &self.outcome;
        let (from, to, count) = self.instants;
        write!(f, "{}: {} dynamics", self.name, self.dynamics)?;
        integrator.as_ref().map_or(Ok(()), |name| write!(f, " by {name}"))?;
        write!(f, ", {count} instants from {} s to {} s", all_digits(from), all_digits(to))?;
        if let Some(steps) = steps {
            write!(f, "\n  {}", counted(*steps, "step"))?;
        }
        if let Some(Statistics { rejected, evaluations, .. }) = statistics {
            write!(f, ", {rejected} rejected, {}", counted(*evaluations, "evaluation"))?;
        }
        if let Some((contacts, touch_downs)) = contacts {
            write!(f, "\n  {}, {}", counted(*contacts, "contact"), counted(touch_downs.len(), "touch-down"))?;
        }
        write!(f, "\n  {:.3} s of computing and writing", self.seconds)?;
        let Balance { drift, exchanged, .. } = self.balance;
        let [drift, exchanged] = [drift, exchanged].map(size);
        write!(f, "\n  energy drift {drift} J, while up to {exchanged} J were exchanged")?;
        if let Some(MomentumDrift { linear, angular, .. }) = self.momentum {
            let [linear, angular] = [linear, angular].map(size);
            write!(f, "\n  momentum drift {linear} N s and {angular} N m s")?;
        }
        position_residual.map_or(Ok(()), |residual| write!(f, "\n  worst position residual {} m", size(residual)))
    }
}
