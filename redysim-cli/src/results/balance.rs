//! The balance of energy: what has come from nowhere, and how much there was to balance.

use redysim_runtime::Energy;

/// Of the shipped scenarios none drifts by a hundredth of what it exchanges, at tolerances for pictures.
const MUCH: f64 = 0.1;

/// How the energy of a motion and the work of its actuators agree, state by state.
#[derive(Default)]
pub struct Balance {
    /// Energy and work at the start, J.
    start: Option<(Energy<f64>, f64)>,
    /// The largest drift so far, J.
    pub drift: f64,
    /// The most that was exchanged so far, J: as kinetic energy, as a change of the potential energy, or as work.
    pub exchanged: f64,
    /// The largest potential energy so far, J.
    potential: f64,
}

impl Balance {
    /// Looks at a state, and returns the energy that has come from nowhere since the start, J.
    pub fn see(&mut self, energy: Energy<f64>, work: f64) -> f64 {
        let (first, work_before) = *self.start.get_or_insert((energy, work));
        let drift = (energy.total() - work) - (first.total() - work_before);
        self.drift = self.drift.max(drift.abs());
        let exchanged = [energy.kinetic, energy.potential - first.potential, work - work_before];
        self.exchanged = exchanged.iter().fold(self.exchanged, |most, value| most.max(value.abs()));
        self.potential = self.potential.max(energy.potential.abs());
        drift
    }

    /// The largest drift as a part of what was exchanged, if it is so large that the result is wrong.
    pub fn wrong_part(&self) -> Option<f64> {
        Some(self.part()).filter(|part| *part > MUCH)
    }

    /// The largest drift as a part of what was exchanged.
    fn part(&self) -> f64 {
        // Where nothing moves, the rounding of the potential energy is not drift.
        let scale = self.exchanged.max(f64::EPSILON.sqrt() * self.potential);
        if self.drift > 0.0 { self.drift / scale } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(states: [(f64, f64, f64); 2]) -> f64 {
        let mut balance = Balance::default();
        for (kinetic, potential, work) in states {
            balance.see(Energy { kinetic, potential }, work);
        }
        balance.part()
    }

    #[test]
    fn drift_is_measured_by_what_is_exchanged_however_much_there_is() {
        assert_eq!(part([(0.0, 1000.0, 0.0), (3.0, 998.0, 2.0)]), 1.0 / 3.0);
    }

    #[test]
    fn rounding_where_nothing_moves_is_not_drift() {
        assert!(part([(0.0, 100.0, 0.0), (0.0, 100.0 + 2e-14, 0.0)]) < 1e-6);
        assert_eq!(part([(0.0, 0.0, 0.0); 2]), 0.0);
    }
}
