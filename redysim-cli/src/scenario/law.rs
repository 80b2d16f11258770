//! Torque laws as they act on a mechanism.

use redysim_model::GenericMechanism;
use redysim_runtime::{ClosedLoopComputedTorque, LengthMismatch, Limited, LoopError, TorqueLaw};

use super::trajectory::Prescribed;

/// A law on a mechanism.
pub enum Law<'a> {
    /// A law that is defined in every state.
    Total(Box<dyn TorqueLaw<f64, GenericMechanism> + 'a>),
    /// A law that is undefined where the loops do not permit the prescribed motion.
    OfLoops(ClosedLoopComputedTorque<'a, f64, GenericMechanism, &'a Prescribed, Vec<f64>>),
    /// A law within the limits of the actuators.
    Limited(Box<Limited<Law<'a>, Vec<f64>>>),
}

type Pair<'a> = (&'a Vec<f64>, &'a Vec<f64>);

impl<'a> Law<'a> {
    /// A law that is defined in every state.
    pub fn total(law: impl TorqueLaw<f64, GenericMechanism> + 'a) -> Self {
        Law::Total(Box::new(law))
    }

    /// Why the forces asked for last are not numbers, if the law knows.
    pub fn last_error(&self) -> Option<LoopError<f64>> {
        match self {
            Law::Total(_) => None,
            Law::OfLoops(law) => law.last_error(),
            Law::Limited(limited) => limited.law.last_error(),
        }
    }

    /// A law whose forces are at most `limits`, one for each velocity.
    pub fn limited(law: Law<'a>, limits: Vec<f64>) -> Self {
        Law::Limited(Box::new(Limited { law, limits }))
    }

    fn chosen(&self) -> &(dyn TorqueLaw<f64, GenericMechanism> + 'a) {
        match self {
            Law::Total(law) => law.as_ref(),
            Law::OfLoops(law) => law,
            Law::Limited(law) => law.as_ref(),
        }
    }

    fn chosen_mut(&mut self) -> &mut (dyn TorqueLaw<f64, GenericMechanism> + 'a) {
        match self {
            Law::Total(law) => law.as_mut(),
            Law::OfLoops(law) => law,
            Law::Limited(law) => law.as_mut(),
        }
    }
}

impl TorqueLaw<f64, GenericMechanism> for Law<'_> {
    fn torque(&mut self, mechanism: &GenericMechanism, t: f64, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        self.chosen_mut().torque(mechanism, t, q, v)
    }

    fn check_lengths(&self, t: f64, mechanism: &GenericMechanism) -> Result<(), LengthMismatch> {
        self.chosen().check_lengths(t, mechanism)
    }

    fn torque_tangent(
        &mut self,
        mechanism: &GenericMechanism,
        t: f64,
        at: Pair<'_>,
        slopes: Pair<'_>,
    ) -> Option<Vec<f64>> {
        self.chosen_mut().torque_tangent(mechanism, t, at, slopes)
    }

    fn state_count(&self, mechanism: &GenericMechanism) -> usize {
        self.chosen().state_count(mechanism)
    }

    fn initial_state(&self, index: usize) -> f64 {
        self.chosen().initial_state(index)
    }

    fn torque_with_state(
        &mut self,
        mechanism: &GenericMechanism,
        t: f64,
        at: Pair<'_>,
        state: &[f64],
        rates: &mut [f64],
    ) -> Vec<f64> {
        self.chosen_mut().torque_with_state(mechanism, t, at, state, rates)
    }

    fn track(&self, saturation_error: &Vec<f64>, rates: &mut [f64]) {
        self.chosen().track(saturation_error, rates);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use redysim_model::Model;
    use redysim_runtime::{Proportional, ZeroTorque};

    #[test]
    fn the_lengths_of_a_law_are_checked_through_the_choice_between_laws() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/simple_pendulum.toml");
        let model = Model::load(path).expect("a good model").model;
        let mechanism = GenericMechanism::new(model);
        assert_eq!(Law::total(ZeroTorque).check_lengths(0.0, &mechanism), Ok(()));
        let law = Law::total(Proportional { target: vec![0.0; 2], kp: vec![1.0] });
        let mismatch = LengthMismatch { vector: "target", length: 2, expected: 1 };
        assert_eq!(law.check_lengths(0.0, &mechanism), Err(mismatch));
    }
}
