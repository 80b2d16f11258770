//! Rest at one position.

use super::{Motion, Trajectory};
use crate::{ConfigurationSpace, Scalar, Vector};

/// A position at rest, as a motion for laws that follow one.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SetPoint<Q, V> {
    motion: Motion<Q, V>,
}

impl<Q, V> SetPoint<Q, V> {
    /// `mechanism` at rest at `q`.
    pub fn new<S: Scalar, M>(mechanism: &M, q: Q) -> Self
    where
        M: ConfigurationSpace<S, Coordinates = Q, Velocities = V>,
        V: Vector<S>,
    {
        let rest = V::from_fn(mechanism.nv(), |_| S::zero());
        SetPoint { motion: Motion { q, v: rest.clone(), a: rest } }
    }
}

impl<S, Q: Clone, V: Clone> Trajectory<S, Q, V> for SetPoint<Q, V> {
    fn at(&self, _t: S) -> Motion<Q, V> {
        self.motion.clone()
    }
}
