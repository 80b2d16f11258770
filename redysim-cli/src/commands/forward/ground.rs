//! A torque law on the ground, with an account of what the ground takes.

use redysim_model::GenericMechanism;
use redysim_runtime::{LengthMismatch, TorqueLaw};

use crate::scenario::{Ground, Law};

/// A law on a mechanism with contacts. Its last state, if there are contacts, is the energy that damping and friction of
/// the ground have taken, J.
pub struct OnGround<'a> {
    pub law: Law<'a>,
    ground: &'a Ground<'a>,
}

type Pair<'a> = (&'a Vec<f64>, &'a Vec<f64>);

impl<'a> OnGround<'a> {
    pub fn new(law: Law<'a>, ground: &'a Ground<'a>) -> Self {
        OnGround { law, ground }
    }

    fn mechanism(&self) -> &'a GenericMechanism {
        self.ground.mechanism()
    }

    /// How many states it has beside those of the law.
    fn own(&self) -> usize {
        usize::from(!self.ground.contacts().is_empty())
    }
}

impl TorqueLaw<f64, Ground<'_>> for OnGround<'_> {
    fn torque(&mut self, ground: &Ground<'_>, t: f64, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        self.law.torque(ground.mechanism(), t, q, v)
    }

    fn check_lengths(&self, t: f64, _ground: &Ground<'_>) -> Result<(), LengthMismatch> {
        self.law.check_lengths(t, self.mechanism())
    }

    fn torque_tangent(&mut self, ground: &Ground<'_>, t: f64, at: Pair<'_>, slopes: Pair<'_>) -> Option<Vec<f64>> {
        self.law.torque_tangent(ground.mechanism(), t, at, slopes)
    }

    fn state_count(&self, _ground: &Ground<'_>) -> usize {
        self.law.state_count(self.mechanism()) + self.own()
    }

    fn initial_state(&self, index: usize) -> f64 {
        if index < self.law.state_count(self.mechanism()) { self.law.initial_state(index) } else { 0.0 }
    }

    fn torque_with_state(
        &mut self,
        ground: &Ground<'_>,
        t: f64,
        (q, v): Pair<'_>,
        state: &[f64],
        rates: &mut [f64],
    ) -> Vec<f64> {
        let of_law = self.law.state_count(ground.mechanism());
        if let Some(rate) = rates.get_mut(of_law) {
            *rate = ground.ground_power(q, v);
        }
        let (state, rates) = (state.get(..of_law), rates.get_mut(..of_law));
        self.law.torque_with_state(ground.mechanism(), t, (q, v), state.unwrap_or_default(), rates.unwrap_or_default())
    }
}
