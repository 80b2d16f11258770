//! Buffers of the recursions.

use super::articulated::ArticulatedInertia;
use super::forward::{BiasAcceleration, Pivot};
use super::frame::{Angle, JointFrame};
use super::inverse::BodyMotion;
use super::mass_matrix::Composite;
use crate::spatial::{Twist, Wrench};
use crate::tree::Tree;

/// The buffers of the recursions over a tree. One that is reused is large enough after the first call, so that later
/// calls allocate nothing: see
/// [`GenericMechanism::inverse_dynamics_in`](crate::GenericMechanism::inverse_dynamics_in).
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub(super) angles: Vec<Option<Angle<S>>>,
    pub(super) frames: Vec<JointFrame<S>>,
    pub(super) children: Children,
    pub(super) motions: Vec<BodyMotion<S>>,
    pub(super) wrenches: Vec<Wrench<S>>,
    pub(super) biases: Vec<BiasAcceleration<S>>,
    pub(super) inertias: Vec<ArticulatedInertia<S>>,
    pub(super) pivots: Vec<Pivot<S>>,
    pub(super) accelerations: Vec<Twist<S>>,
    pub(super) planar: Vec<bool>,
    pub(super) composites: Vec<Composite<S>>,
}

impl<S> Default for Workspace<S> {
    /// Empty buffers. The first call allocates those that it needs.
    fn default() -> Self {
        Workspace {
            angles: Vec::new(),
            frames: Vec::new(),
            children: Children::default(),
            motions: Vec::new(),
            wrenches: Vec::new(),
            biases: Vec::new(),
            inertias: Vec::new(),
            pivots: Vec::new(),
            accelerations: Vec::new(),
            planar: Vec::new(),
            composites: Vec::new(),
        }
    }
}

/// For each body its first child, and the next child of its parent: found in a time that grows with the number of
/// bodies.
#[derive(Clone, Debug, Default)]
pub(super) struct Children(Vec<[Option<usize>; 2]>);

impl Children {
    #[inline]
    pub fn find(&mut self, tree: &Tree<impl Copy>) {
        self.0.clear();
        self.0.resize(tree.bodies.len(), [None; 2]);
        for index in tree.inward() {
            if let Some(parent) = tree.bodies[index].parent {
                self.0[index][1] = self.0[parent][0].replace(index);
            }
        }
    }

    /// The bodies whose parent is `body`, in order.
    #[inline]
    pub fn of(&self, body: usize) -> impl Iterator<Item = usize> {
        let [first, _] = self.0[body];
        std::iter::successors(first, |&child| self.0[child][1])
    }
}
