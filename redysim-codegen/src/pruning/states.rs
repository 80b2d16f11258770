//! Sampled states within the ranges of the joints, the same in every run.

use super::columns::{Columns, evaluate, live, sign};
use crate::expressions::Expressions;
use crate::random::Random;
use redysim_model::{JointRange, Tree, denoc};

/// Within what a velocity and what it moves are sampled: as [`JointRange`], with an acceleration.
#[derive(Clone, Copy, Debug)]
pub struct StateRange {
    /// The least and the largest displacement.
    pub position: [f64; 2],
    /// The largest speed in either direction.
    pub velocity: f64,
    /// The largest acceleration in either direction.
    pub acceleration: f64,
    /// The force of which the tolerance is a share, if it is stated.
    pub force: Option<f64>,
}

impl StateRange {
    /// The range of a joint; `None` if it has no acceleration.
    pub fn of(range: &JointRange) -> Option<StateRange> {
        let JointRange { position, velocity, acceleration, force } = *range;
        Some(StateRange { position, velocity, acceleration: acceleration?, force })
    }
}

/// The states in which a function is sampled.
pub struct States<'a> {
    /// The bodies whose joints map displacements to coordinates.
    pub tree: &'a Tree,
    /// The ranges of displacement, velocity and acceleration, in the order of the velocities.
    pub ranges: &'a [StateRange],
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

    /// Coordinates, velocities and accelerations in the same states. A position is a displacement from the zero
    /// position, one number for each velocity.
    pub fn motion(&self, states: usize, seed: u64) -> [Columns; 3] {
        let mut random = Random::new(seed);
        let [mut v, mut a] = [0; 2].map(|_| Columns::new(self.ranges.len(), states));
        let mut q = Columns::new(self.tree.nq(), states);
        let neutral: Vec<f64> = denoc::neutral(self.tree);
        let mut displacement = vec![0.0; self.ranges.len()];
        for state in 0..states {
            let corners = random.bits();
            for (index, StateRange { position: [least, largest], velocity, acceleration, .. }) in
                self.ranges.iter().enumerate()
            {
                let middle = 0.5 * (least + largest);
                displacement[index] = middle + (largest - middle) * random.share(corners & 7 == 0);
                v.column_mut(index)[state] = velocity * random.share(corners & 8 == 0);
                a.column_mut(index)[state] = acceleration * random.share(corners & 16 == 0);
            }
            let moved = denoc::integrate(self.tree, &neutral, &displacement);
            for (index, moved) in moved.into_iter().enumerate() {
                q.column_mut(index)[state] = moved;
            }
        }
        [q, v, a]
    }
}
