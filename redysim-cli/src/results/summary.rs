//! How a run went.

use std::fmt;

use redysim_runtime::Statistics;

use crate::failure::Failure;

/// How a run went.
pub struct Summary {
    /// The scenario's name.
    pub name: String,
    /// "forward" or "inverse".
    pub command: &'static str,
    /// By which method.
    pub method: String,
    /// First and last instant, s, and how many there are.
    pub instants: (f64, f64, usize),
    /// What the integration took, if there was one.
    pub statistics: Option<Statistics>,
    /// Wall time, s.
    pub seconds: f64,
    /// The largest drift of the energy, J.
    pub drift: f64,
    /// The largest gap of a loop, m (or a sine), if there are loops.
    pub gap: Option<f64>,
    /// Position and velocity at the start.
    pub start: [Vec<f64>; 2],
    pub ended: Ended,
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

impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Ended::Complete => "complete",
            Ended::Interrupted => "interrupted",
            Ended::Failed(_) => "failed",
        })
    }
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (from, to, count) = self.instants;
        write!(
            f,
            "{}: {} dynamics by {}, {count} instants from {from} s to {to} s",
            self.name, self.command, self.method
        )?;
        if let Some(Statistics { steps, rejected, evaluations, .. }) = self.statistics {
            write!(f, "\n  {steps} steps, {rejected} rejected, {evaluations} evaluations")?;
        }
        write!(f, "\n  {:.3} s of computing\n  energy drift {:.1e} J", self.seconds, self.drift)?;
        self.gap.map_or(Ok(()), |gap| write!(f, "\n  worst gap {gap:.1e} m"))
    }
}
