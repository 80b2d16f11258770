//! One joint at one position: how vectors, forces and inertias pass between a body and its parent.

use crate::inertia::{RigidInertia, Sym3};
use crate::spatial::{Mat3, Vec3};
use crate::tree::{Body, Joint, Tree};
use redysim_runtime::Scalar;

/// A body's frame in its parent's: a fixed rotation, then the joint's own.
///
/// The two rotations are kept apart, since the fixed one is mostly made of zeros and ones.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointFrame<S> {
    fixed: Mat3<S>,
    /// Cosine and sine of the joint's angle; `None` where the joint does not turn.
    turn: Option<(S, S)>,
    /// The body's origin in the parent's frame.
    pub position: Vec3<S>,
}

/// The frames of all bodies at the coordinates `q`.
pub(super) fn joint_frames<S: Scalar>(tree: &Tree, q: &[S]) -> Vec<JointFrame<S>> {
    tree.bodies.iter().enumerate().map(|(index, body)| JointFrame::new(body, index, q[body.coordinate])).collect()
}

impl<S: Scalar> JointFrame<S> {
    fn new(body: &Body, index: usize, q: S) -> Self {
        q.step("frames", index);
        let fixed = Mat3::constant(body.placement.rotation);
        let position = Vec3::constant(body.placement.position);
        match body.joint {
            Joint::Revolute => {
                let angle = if body.offset == 0.0 { q } else { q + S::from_f64(body.offset) };
                let (sin, cos) = angle.sin_cos();
                let turn = Some((cos.named("cos", index, ""), sin.named("sin", index, "")));
                JointFrame { fixed, turn, position }
            }
            Joint::Prismatic => JointFrame { fixed, turn: None, position: position + fixed.column(2).scale(q) },
        }
    }

    /// A vector of the body's frame, in the parent's.
    pub fn to_parent(self, v: Vec3<S>) -> Vec3<S> {
        self.fixed * self.turned(v)
    }

    /// A vector of the parent's frame, in the body's.
    pub fn to_body(self, v: Vec3<S>) -> Vec3<S> {
        let v = self.fixed.transpose() * v;
        match self.turn {
            Some((cos, sin)) => Vec3([cos * v[0] + sin * v[1], cos * v[1] - sin * v[0], v[2]]),
            None => v,
        }
    }

    /// A force on the body and its moment about the body's origin, in the parent's frame and about the parent's origin.
    pub fn wrench_to_parent(self, force: Vec3<S>, moment: Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let force = self.to_parent(force);
        (force, self.to_parent(moment) + self.position.cross(force))
    }

    /// A symmetric tensor of the body's frame, in the parent's axes.
    pub fn tensor_to_parent(self, tensor: Sym3<S>) -> Sym3<S> {
        match self.turn {
            Some((cos, sin)) => tensor.rotated_about_z(cos, sin),
            None => tensor,
        }
        .rotated(self.fixed)
    }

    /// A general tensor of the body's frame, in the parent's axes.
    pub fn matrix_to_parent(self, matrix: Mat3<S>) -> Mat3<S> {
        let rows = Mat3(matrix.0.map(|row| self.to_parent(Vec3(row)).0)).transpose();
        Mat3(rows.0.map(|column| self.to_parent(Vec3(column)).0)).transpose()
    }

    /// A body's inertia about its origin, in the parent's frame and about the parent's origin.
    pub fn inertia_to_parent(self, inertia: RigidInertia<S>) -> RigidInertia<S> {
        RigidInertia {
            mass: inertia.mass,
            moment: self.to_parent(inertia.moment),
            tensor: self.tensor_to_parent(inertia.tensor),
        }
        .translated(self.position)
    }

    fn turned(self, v: Vec3<S>) -> Vec3<S> {
        match self.turn {
            Some((cos, sin)) => Vec3([cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]]),
            None => v,
        }
    }
}

/// The component of a wrench that a joint's motion meets: the moment about z, or the force along it.
pub(super) fn along_joint<S: Scalar>(joint: Joint, force: Vec3<S>, moment: Vec3<S>) -> S {
    match joint {
        Joint::Revolute => moment[2],
        Joint::Prismatic => force[2],
    }
}
