//! One joint at one position: how vectors, forces and inertias pass between a body and its parent.

use crate::inertia::Sym3;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::tree::{Joint, Tree};
use redysim_runtime::Scalar;

/// Cosine and sine of an angle about z.
type Turn<S> = (S, S);

/// The axes in which a body's quantities are computed, in its parent's: a fixed rotation, then the joint's own.
///
/// The two rotations are kept apart, since the fixed one is mostly made of zeros and ones. The axes of a still body
/// ([`Body::still`](crate::tree::Body::still)) do not turn with its joint; then what is fixed to the body turns against
/// them.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointFrame<S> {
    /// The parent against its axes, where these are still and the joint's axis turns against them.
    before: Option<Turn<S>>,
    fixed: Mat3<S>,
    /// The body's axes against the fixed rotation; `None` where they do not turn.
    turn: Option<Turn<S>>,
    /// The body against its axes; `None` where they are its own.
    attitude: Option<Turn<S>>,
    /// Whether the joint's axis is one of the parent's axes.
    along_axis: bool,
    /// The body's origin in the parent's axes.
    pub position: Vec3<S>,
}

/// The frames of all bodies at the coordinates `q`.
pub(super) fn joint_frames<S: Scalar>(tree: &Tree, q: &[S]) -> Vec<JointFrame<S>> {
    // By which angle each still body has turned against its axes.
    let mut left: Vec<Option<S>> = Vec::with_capacity(tree.bodies.len());
    let mut frames: Vec<JointFrame<S>> = Vec::with_capacity(tree.bodies.len());
    for (index, body) in tree.bodies.iter().enumerate() {
        let (of_parent, parent) = body.parent.map_or((None, None), |parent| (left[parent], frames[parent].attitude));
        let Pose { rotation, position } = body.placement;
        let (fixed, q) = (Mat3::constant(rotation), q[body.coordinate]);
        let cosine = rotation.0[2][2];
        let parallel = cosine.abs() == 1.0;
        let own = match body.joint {
            Joint::Revolute if body.offset == 0.0 => Some(q),
            Joint::Revolute => Some(q + S::from_f64(body.offset)),
            Joint::Prismatic => None,
        };
        let carried = of_parent.filter(|_| parallel).map(|angle| if cosine < 0.0 { -angle } else { angle });
        let angle = match (carried, own) {
            (Some(carried), Some(own)) => Some(carried + own),
            (carried, own) => carried.or(own),
        };
        let turn = angle.map(|angle| {
            let (sin, cos) = angle.sin_cos();
            let [cosine, sine] = if carried.is_some() { ["cos_sum", "sin_sum"] } else { ["cos", "sin"] };
            (cos.named(cosine, index, ""), sin.named(sine, index, ""))
        });
        let mut position = turned(parent, Vec3::constant(position));
        let before = parent.filter(|_| !parallel);
        if body.joint == Joint::Prismatic {
            position = position + turned(before, fixed.column(2)).scale(q);
        }
        let along_axis = before.is_none() && rotation.column(2).0.iter().filter(|x| **x != 0.0).count() == 1;
        let (turn, attitude) = if body.still { (None, turn) } else { (turn, None) };
        left.push(angle.filter(|_| body.still));
        frames.push(JointFrame { before, fixed, turn, attitude, along_axis, position });
    }
    frames
}

impl<S: Scalar> JointFrame<S> {
    /// A vector in the body's axes, in the parent's.
    pub fn to_parent(self, v: Vec3<S>) -> Vec3<S> {
        turned(self.before, self.fixed * turned(self.turn, v))
    }

    /// A vector in the parent's axes, in the body's.
    pub fn to_body(self, v: Vec3<S>) -> Vec3<S> {
        turned_back(self.turn, self.fixed.transpose() * turned_back(self.before, v))
    }

    /// What the matrix of the parent's axes makes of the joint's axis, in the body's axes; `None` where the joint's
    /// axis is none of the parent's axes and the product would cost.
    pub fn axis_image(self, matrix: Mat3<S>) -> Option<Vec3<S>> {
        self.along_axis.then(|| self.to_body(matrix * self.fixed.column(2)))
    }

    /// A vector fixed to the body, in its axes.
    pub fn fixed_vector(self, v: Vec3<S>) -> Vec3<S> {
        turned(self.attitude, v)
    }

    /// A pose fixed to the body, in its axes.
    pub fn fixed_pose(self, pose: Pose<S>) -> Pose<S> {
        let columns = pose.rotation.transpose().0.map(|column| self.fixed_vector(Vec3(column)).0);
        Pose { rotation: Mat3(columns).transpose(), position: self.fixed_vector(pose.position) }
    }

    /// The moments of the body's own mass, in its axes.
    pub fn own_inertia(self, inertia: PseudoInertia<f64>) -> PseudoInertia<S> {
        let PseudoInertia { mass, moment, second } = PseudoInertia::constant(inertia);
        PseudoInertia { mass, moment: self.fixed_vector(moment), second: turned_tensor(self.attitude, second) }
    }

    /// Whether what is fixed to the body turns against its axes.
    pub fn is_still(self) -> bool {
        self.attitude.is_some()
    }

    /// A force on the body and its moment about the body's origin, in the parent's axes and about the parent's origin.
    pub fn wrench_to_parent(self, force: Vec3<S>, moment: Vec3<S>) -> (Vec3<S>, Vec3<S>) {
        let force = self.to_parent(force);
        (force, self.to_parent(moment) + self.position.cross(force))
    }

    /// A symmetric tensor of the body's axes, in the parent's.
    pub fn tensor_to_parent(self, tensor: Sym3<S>) -> Sym3<S> {
        turned_tensor(self.before, turned_tensor(self.turn, tensor).rotated(self.fixed))
    }

    /// A general tensor of the body's axes, in the parent's.
    pub fn matrix_to_parent(self, matrix: Mat3<S>) -> Mat3<S> {
        let rows = Mat3(matrix.0.map(|row| self.to_parent(Vec3(row)).0)).transpose();
        Mat3(rows.0.map(|column| self.to_parent(Vec3(column)).0)).transpose()
    }

    /// Moments of mass about the body's origin, in the parent's axes and about the parent's origin.
    pub fn inertia_to_parent(self, inertia: PseudoInertia<S>) -> PseudoInertia<S> {
        PseudoInertia {
            mass: inertia.mass,
            moment: self.to_parent(inertia.moment),
            second: self.tensor_to_parent(inertia.second),
        }
        .translated(self.position)
    }
}

fn turned<S: Scalar>(turn: Option<Turn<S>>, v: Vec3<S>) -> Vec3<S> {
    match turn {
        Some((cos, sin)) => Vec3([cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]]),
        None => v,
    }
}

fn turned_back<S: Scalar>(turn: Option<Turn<S>>, v: Vec3<S>) -> Vec3<S> {
    turned(turn.map(|(cos, sin)| (cos, -sin)), v)
}

fn turned_tensor<S: Scalar>(turn: Option<Turn<S>>, tensor: Sym3<S>) -> Sym3<S> {
    turn.map_or(tensor, |(cos, sin)| tensor.rotated_about_z(cos, sin))
}

/// The component of a wrench that a joint's motion meets: the moment about z, or the force along it.
pub(super) fn along_joint<S: Scalar>(joint: Joint, force: Vec3<S>, moment: Vec3<S>) -> S {
    match joint {
        Joint::Revolute => moment[2],
        Joint::Prismatic => force[2],
    }
}
