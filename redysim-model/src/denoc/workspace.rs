//! Buffers of the recursions.

use super::articulated::ArticulatedInertia;
use super::frame::{AxisPosition, JointFrame};
use super::mimic::AllJoints;
use super::springs::Springs;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Twist, Vec3, Wrench};
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The buffers of the recursions over a tree.
///
/// With a workspace [for the tree](Workspace::for_tree),
/// [`GenericMechanism::inverse_dynamics_in`](crate::GenericMechanism::inverse_dynamics_in) and the other methods that
/// take a workspace do not allocate.
#[derive(Clone, Debug)]
pub struct Workspace<S> {
    pub(super) positions: Vec<AxisPosition<S>>,
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
    pub(super) springs: Springs<S>,
    pub(super) all_joints: AllJoints<S>,
}

impl<S> Default for Workspace<S> {
    /// Empty buffers. A call allocates if its tree or its method needs more than those before.
    fn default() -> Self {
        Workspace::for_bodies(0)
    }
}

impl<S> Workspace<S> {
    /// Buffers of the size that the recursions over `tree` need.
    pub fn for_tree<P>(tree: &Tree<P>) -> Self {
        Workspace {
            springs: Springs::for_tree(tree),
            pivots: Vec::with_capacity(tree.nv_of_all()),
            all_joints: AllJoints::for_tree(tree),
            ..Workspace::for_bodies(tree.bodies.len())
        }
    }

    fn for_bodies(count: usize) -> Self {
        Workspace {
            positions: Vec::with_capacity(count),
            frames: Vec::with_capacity(count),
            children: Children(Vec::with_capacity(count)),
            motions: Vec::with_capacity(count),
            wrenches: Vec::with_capacity(count),
            biases: Vec::with_capacity(count),
            inertias: Vec::with_capacity(count),
            pivots: Vec::with_capacity(count),
            accelerations: Vec::with_capacity(count),
            planar: Vec::with_capacity(count),
            composites: Vec::with_capacity(count),
            springs: Springs::default(),
            all_joints: AllJoints::default(),
        }
    }
}

/// Motion of a body in its own frame. Gravity is an acceleration of the ground, so it needs no forces of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyMotion<S> {
    /// Angular velocity ω.
    pub angular: Vec3<S>,
    /// Angular acceleration ω̇.
    pub angular_acceleration: Vec3<S>,
    /// U = ω̇× + (ω×)², which takes a point fixed to the body to its acceleration against the origin.
    pub angular_acceleration_tensor: Mat3<S>,
    /// Acceleration of the origin, less gravity.
    pub acceleration: Vec3<S>,
}

/// The motion of a body that its velocities determine.
#[derive(Clone, Copy, Debug)]
pub(super) struct BiasAcceleration<S> {
    /// Angular velocity ω, in the body's frame.
    pub angular: Vec3<S>,
    /// Acceleration against the parent at zero joint acceleration.
    pub acceleration: Twist<S>,
}

/// One step of the elimination: 1/D, U/D and the force left to accelerate the joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pivot<S> {
    pub inverse: S,
    pub ratio: Wrench<S>,
    pub drive: S,
}

impl<S: Scalar> Default for Pivot<S> {
    fn default() -> Self {
        Pivot { inverse: S::zero(), ratio: Wrench::zero(), drive: S::zero() }
    }
}

/// A body and all it carries, as one rigid body.
#[derive(Clone, Debug)]
pub(super) struct Composite<S> {
    pub inertia: PseudoInertia<S>,
    /// The moment of inertia about z, Σ_xx + Σ_yy. A body that turns about z only has no other use for these two.
    pub polar: S,
}

/// For each body its first child, and the next child of its parent: found in a time that grows with the number of
/// bodies.
#[derive(Clone, Debug)]
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
