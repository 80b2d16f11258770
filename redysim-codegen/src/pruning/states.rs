//! Sampled states within the ranges of the joints, the same in every run.

use super::columns::{Columns, evaluate, live, sign};
use crate::expressions::Expressions;
use crate::random::Random;
use redysim_model::JointRange;

/// The states in which a function is sampled.
pub struct States<'a> {
    /// The ranges of the joints, in the model's order.
    pub ranges: &'a [JointRange],
    /// Inverse dynamics, where the third argument of the function is joint forces.
    pub forces: Option<&'a Expressions>,
}

impl States<'_> {
    /// The arguments in `states` states: coordinates, velocities, and accelerations or the forces that cause them.
    ///
    /// In half of the states velocities, in half accelerations are at their limits, in every eighth so are coordinates:
    /// joint forces are linear in accelerations and quadratic in velocities, so that this is where terms are largest.
    pub fn arguments(&self, states: usize, seed: u64) -> Vec<Columns> {
        let [q, v, a] = self.motion(states, seed);
        let Some(forces) = self.forces else { return vec![q, v, a] };
        let motion = vec![q, v, a];
        let mut values = Columns::new(forces.graph.len(), states);
        evaluate(forces, &live(forces), &motion, &mut values);
        let mut tau = Columns::new(self.ranges.len(), states);
        for (joint, &output) in forces.outputs.iter().enumerate() {
            let given = values.column(output.node());
            tau.column_mut(joint).iter_mut().zip(given).for_each(|(tau, value)| *tau = sign(output) * value);
        }
        let [q, v, _] = <[Columns; 3]>::try_from(motion).expect("three arguments");
        vec![q, v, tau]
    }

    /// Coordinates, velocities and accelerations in the same states.
    pub fn motion(&self, states: usize, seed: u64) -> [Columns; 3] {
        let mut random = Random::new(seed);
        let joints = self.ranges.len();
        let [mut q, mut v, mut a] = [0; 3].map(|_| Columns::new(joints, states));
        for state in 0..states {
            let corners = random.bits();
            for (joint, JointRange { position: [least, largest], velocity, acceleration, .. }) in
                self.ranges.iter().enumerate()
            {
                let middle = 0.5 * (least + largest);
                q.column_mut(joint)[state] = middle + (largest - middle) * random.share(corners & 7 == 0);
                v.column_mut(joint)[state] = velocity * random.share(corners & 8 == 0);
                a.column_mut(joint)[state] = acceleration * random.share(corners & 16 == 0);
            }
        }
        [q, v, a]
    }
}
