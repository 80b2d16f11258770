//! Laws of coordinate differences, on mechanisms whose joints may have several coordinates.

use redysim_model::GenericMechanism;
use redysim_runtime::{ConfigurationSpace, LengthMismatch, Motion, TorqueLaw, Trajectory};

/// A law that subtracts coordinates from coordinates, with a set point of zeros in the place of `target`. What it takes
/// for coordinates are the differences q ⊟ target, which are as many as velocities: of orientations, rotation vectors
/// in the link's frame.
pub struct OnTangent<'a, T, L> {
    pub mechanism: &'a GenericMechanism,
    /// Where the joints should be.
    pub target: T,
    pub law: L,
}

type Pair<'a> = (&'a Vec<f64>, &'a Vec<f64>);

impl<T: Trajectory<f64, Vec<f64>, Vec<f64>>, L> OnTangent<'_, T, L> {
    fn displacement(&self, t: f64, q: &Vec<f64>) -> Vec<f64> {
        let Motion { q: target, .. } = self.target.at(t);
        self.mechanism.difference(&target, q)
    }
}

impl<T, L> TorqueLaw<f64, GenericMechanism> for OnTangent<'_, T, L>
where
    T: Trajectory<f64, Vec<f64>, Vec<f64>>,
    L: TorqueLaw<f64, GenericMechanism>,
{
    fn torque(&mut self, t: f64, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        let displacement = self.displacement(t, q);
        self.law.torque(t, &displacement, v)
    }

    /// The lengths of the law are those of velocities: a scenario gives no others.
    fn check_lengths(&self, _t: f64, _mechanism: &GenericMechanism) -> Result<(), LengthMismatch> {
        Ok(())
    }

    fn state_count(&self, mechanism: &GenericMechanism) -> usize {
        self.law.state_count(mechanism)
    }

    fn initial_state(&self, index: usize) -> f64 {
        self.law.initial_state(index)
    }

    fn torque_with_state(&mut self, t: f64, (q, v): Pair<'_>, state: &[f64], rates: &mut [f64]) -> Vec<f64> {
        let displacement = self.displacement(t, q);
        self.law.torque_with_state(t, (&displacement, v), state, rates)
    }

    fn track(&self, saturation_error: &Vec<f64>, rates: &mut [f64]) {
        self.law.track(saturation_error, rates);
    }
}
