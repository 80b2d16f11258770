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
    /// What the third argument of the function is.
    pub given: Given<'a>,
}

/// What the third argument of a function is, if it has one.
#[derive(Clone, Copy)]
pub enum Given<'a> {
    /// Accelerations.
    Accelerations,
    /// Joint forces, which this inverse dynamics has; the function finds the accelerations.
    Forces(&'a Expressions),
    /// The accelerations of the velocities with an actuator and the joint forces of the others, by inverse dynamics and
    /// whether each velocity has an actuator; the function finds the accelerations and the joint forces of all.
    Hybrid(&'a Expressions, &'a [bool]),
}

/// A function's arguments in a number of states.
pub struct Sampled {
    /// The arguments.
    pub arguments: Vec<Columns>,
    /// What the function finds there, as far as the motion has it: vectors of a number for each velocity.
    pub exact: Option<Vec<Columns>>,
}

impl States<'_> {
    /// The arguments in `states` states: coordinates, velocities, and what is [given](Given) in the same motion.
    ///
    /// In half of the states velocities, in half accelerations are at their limits, in every eighth so are coordinates:
    /// joint forces are linear in accelerations and quadratic in velocities, so that this is where terms are largest.
    pub fn sampled(&self, states: usize, seed: u64) -> Sampled {
        let motion = Vec::from(self.motion(states, seed));
        let (inverse_dynamics, actuated) = match self.given {
            Given::Accelerations => return Sampled { arguments: motion, exact: None },
            Given::Forces(inverse_dynamics) => (inverse_dynamics, None),
            Given::Hybrid(inverse_dynamics, actuated) => (inverse_dynamics, Some(actuated)),
        };
        let tau = self.forces(inverse_dynamics, &motion, states);
        let [q, v, a] = <[Columns; 3]>::try_from(motion).expect("three arguments");
        let Some(actuated) = actuated else {
            return Sampled { arguments: vec![q, v, tau], exact: Some(vec![a]) };
        };
        let mut given = tau.clone();
        for velocity in (0..actuated.len()).filter(|&velocity| actuated[velocity]) {
            given.column_mut(velocity).copy_from_slice(a.column(velocity));
        }
        Sampled { arguments: vec![q, v, given], exact: Some(vec![a, tau]) }
    }

    /// The joint forces of a motion.
    fn forces(&self, inverse_dynamics: &Expressions, motion: &[Columns], states: usize) -> Columns {
        let mut values = Columns::new(inverse_dynamics.graph.len(), states);
        evaluate(inverse_dynamics, &live(inverse_dynamics), motion, &mut values);
        let mut tau = Columns::new(self.ranges.len(), states);
        for (joint, &output) in inverse_dynamics.outputs.iter().enumerate() {
            let given = values.column(output.node());
            tau.column_mut(joint).iter_mut().zip(given).for_each(|(tau, value)| *tau = sign(output) * value);
        }
        tau
    }

    /// Coordinates, velocities and accelerations in the same states. A position is a displacement from the zero
    /// position, one number for each velocity.
    fn motion(&self, states: usize, seed: u64) -> [Columns; 3] {
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
