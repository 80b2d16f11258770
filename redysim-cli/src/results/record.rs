//! What is computed, instant by instant.

use redysim_model::GenericMechanism;
use redysim_runtime::{Energy, MechanicalEnergy};

/// A value for every joint or row at every instant: `rows[instant][joint]`.
pub type Rows = Vec<Vec<f64>>;

/// A run.
#[derive(Default)]
pub struct Record {
    /// The instants, s.
    pub t: Vec<f64>,
    pub q: Rows,
    pub v: Rows,
    /// Accelerations: of inverse dynamics alone.
    pub a: Rows,
    /// Joint forces.
    pub tau: Rows,
    /// Multipliers of the loops' rows.
    pub lambda: Rows,
    pub energy: Vec<Energy<f64>>,
    /// The work that the actuators have done since the start, J.
    pub work: Vec<f64>,
}

impl Record {
    /// Adds position and velocity at an instant, and what follows from them.
    pub fn state(&mut self, mechanism: &GenericMechanism, t: f64, q: Vec<f64>, v: Vec<f64>, work: f64) {
        self.t.push(t);
        self.energy.push(mechanism.energy(&q, &v));
        self.work.push(work);
        self.q.push(q);
        self.v.push(v);
    }

    /// The last instant, s.
    pub fn until(&self) -> f64 {
        self.t.last().copied().unwrap_or_default()
    }

    /// The energy that has come from nowhere since the start, at each instant, J.
    pub fn drift(&self) -> Vec<f64> {
        let own = |k: usize| self.energy[k].total() - self.work[k];
        (0..self.t.len()).map(|k| own(k) - own(0)).collect()
    }

    /// The largest of these, J.
    pub fn worst_drift(&self) -> f64 {
        self.drift().into_iter().fold(0.0, |most, drift| f64::max(most, drift.abs()))
    }
}
