//! One joint at one position: how vectors, wrenches and inertias pass between a body and its parent.

use super::rotation::{FrameRotation, RotationAboutZ, RotationFactors, rotated, rotated_back, rotated_tensor};
use super::trace::Trace;
use crate::joint::JointPosition;
use crate::joint::quaternion::{self, Quaternion};
use crate::parameter::ParameterIn;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Pose, Twist, Vec3, Wrench};
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The frame in which a body's quantities are computed, in its parent's.
///
/// Its axes may not rotate with its joint ([`Body::merged_parallel`](crate::tree::Body::merged_parallel)); the body then
/// rotates against them.
#[derive(Clone, Debug)]
pub(super) struct JointFrame<S> {
    /// The rotation of its axes in the parent's.
    pub rotation: FrameRotation<S>,
    /// The rotation of the body against its axes; `None` where they are fixed to it.
    body_rotation: Option<RotationAboutZ<S>>,
    /// The body's origin in the parent's axes.
    pub position: Vec3<S>,
}

/// The frames of all bodies at the coordinates `q`.
pub(super) fn joint_frames<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
) -> Vec<JointFrame<S>> {
    let mut frames = Vec::with_capacity(tree.bodies.len());
    joint_frames_in(&mut Vec::with_capacity(tree.bodies.len()), &mut frames, tree, trace, q);
    frames
}

/// [`joint_frames`] in the given buffers.
pub(super) fn joint_frames_in<S: Scalar, T: Trace<S>>(
    positions: &mut Vec<AxisPosition<S>>,
    frames: &mut Vec<JointFrame<S>>,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &T,
    q: &[S],
) {
    find_positions(positions, tree, q);
    if T::WHOLE_ROTATIONS {
        take_rotations(positions);
    }
    frames.clear();
    frames.reserve(tree.bodies.len());
    trace.sweep("frames", tree.outward(), |index| {
        let (body, AxisPosition { angle, displacement, in_space }) = (&tree.bodies[index], &positions[index]);
        // Only loaded where there is one: loading it waits for the stores of the parent's frame.
        let parent = body.parent.filter(|&parent| tree.bodies[parent].merged_parallel);
        let parent = parent.and_then(|parent| frames[parent].body_rotation);
        let joint_rotation = angle.as_ref().map(|&Angle { value, is_sum, rotation }| {
            let (cos, sin) = rotation.unwrap_or_else(|| {
                let (sin, cos) = value.sin_cos();
                (cos, sin)
            });
            let [cosine, sine] = if is_sum { ["cos_sum", "sin_sum"] } else { ["cos", "sin"] };
            trace.name(cos, cosine, index, "");
            trace.name(sin, sine, index, "");
            (cos, sin)
        });
        let Pose { rotation, position } = body.placement;
        let mut fixed = Mat3::constant(rotation);
        let mut position = rotated(parent, Vec3::constant(position));
        let parent_rotation = parent.filter(|_| !body.is_parallel());
        if let Some((orientation, displacement)) = in_space {
            if let Some(displacement) = displacement {
                position = position + rotated(parent_rotation, fixed.fused_product(*displacement));
            }
            fixed = fixed * quaternion::rotation(*orientation);
        }
        if let Some(displacement) = displacement {
            position = position + rotated(parent_rotation, fixed.column(2)).scale(*displacement);
        }
        let selects_column = body.joint.is_on_axis()
            && parent_rotation.is_none()
            && rotation.column(2).0.iter().filter(|x| **x != 0.0).count() == 1;
        let (rotation_about_z, body_rotation) =
            if body.merged_parallel { (None, joint_rotation) } else { (joint_rotation, None) };
        let in_space = in_space.as_ref().map(|(orientation, _)| (rotation, *orientation));
        let factors = RotationFactors { parent_rotation, fixed, rotation_about_z, selects_column, in_space };
        let rotation = if T::WHOLE_ROTATIONS {
            FrameRotation::Columns(factors.columns())
        } else {
            FrameRotation::Factors(factors)
        };
        frames.push(JointFrame { rotation, body_rotation, position });
    });
}

/// The angle of a body about its z axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Angle<S> {
    value: S,
    /// Whether it is the sum of several joint angles.
    is_sum: bool,
    /// Its cosine and sine, for numbers.
    rotation: Option<RotationAboutZ<S>>,
}

/// Where a body is on its joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisPosition<S> {
    /// Its angle about z: against its parent or, if the joint axes are parallel and the parent's axes do not rotate
    /// with its joint, against the parent's axes.
    angle: Option<Angle<S>>,
    /// Its displacement along z against its parent.
    displacement: Option<S>,
    /// Its rotation and displacement, where these are not about and along z.
    in_space: Option<(Quaternion<S>, Option<Vec3<S>>)>,
}

/// The position of each body on its joint.
fn find_positions<S: Scalar>(positions: &mut Vec<AxisPosition<S>>, tree: &Tree<impl Copy>, q: &[S]) {
    positions.clear();
    positions.reserve(tree.bodies.len());
    for body in &tree.bodies {
        let merged_parent = body.parent.filter(|&parent| tree.bodies[parent].merged_parallel && body.is_parallel());
        let is_term = body.merged_parallel || merged_parent.is_some() || body.offset != 0.0;
        let (angle, displacement) = match body.joint.position(&q[body.q.clone()]) {
            JointPosition::OnAxis { angle, displacement } => (angle, displacement),
            JointPosition::InSpace { orientation, displacement } => {
                let in_space = Some((orientation, displacement));
                positions.push(AxisPosition { angle: None, displacement: None, in_space });
                continue;
            }
        };
        let own = angle.map(|angle| {
            let [near] = if is_term { S::without_turns([angle]) } else { [angle] };
            if body.offset == 0.0 { near } else { near + S::from_f64(body.offset) }
        });
        let carried = merged_parent.and_then(|parent| positions[parent].angle);
        let carried = carried.map(|angle| body.about_parallel_axis(angle.value));
        let value = match (carried, own) {
            (Some(carried), Some(own)) => Some(carried + own),
            _ => carried.or(own),
        };
        let angle = value.map(|value| Angle { value, is_sum: carried.is_some(), rotation: None });
        positions.push(AxisPosition { angle, displacement, in_space: None });
    }
}

/// Computes the sines and cosines of all angles, several at once; for numbers only. In a traced function, those of a body
/// are computed in its step.
fn take_rotations<S: Scalar>(positions: &mut [AxisPosition<S>]) {
    /// As many as a vector of 256 bits holds in double precision.
    const AT_ONCE: usize = 4;
    for group in positions.chunks_mut(AT_ONCE) {
        let value = |i: usize| group.get(i).and_then(|position| position.angle).map_or(S::zero(), |angle| angle.value);
        let (sines, cosines) = S::sin_cos_all::<AT_ONCE>(std::array::from_fn(value));
        for (position, rotation) in group.iter_mut().zip(cosines.into_iter().zip(sines)) {
            if let Some(angle) = &mut position.angle {
                angle.rotation = Some(rotation);
            }
        }
    }
}

impl<S: Scalar> JointFrame<S> {
    /// A vector in the body's axes, in the parent's.
    #[inline(always)]
    pub fn to_parent(&self, v: Vec3<S>) -> Vec3<S> {
        self.rotation.to_parent(v)
    }

    /// A point given in the body's frame, in the parent's.
    #[inline(always)]
    pub fn point_to_parent(&self, point: Vec3<S>) -> Vec3<S> {
        self.to_parent(point) + self.position
    }

    /// A vector in the parent's axes, in the body's.
    #[inline(always)]
    pub fn to_body(&self, v: Vec3<S>) -> Vec3<S> {
        self.rotation.to_body(v)
    }

    /// A vector fixed to the body, in its axes.
    #[inline(always)]
    pub fn fixed_vector(&self, v: Vec3<S>) -> Vec3<S> {
        rotated(self.body_rotation, v)
    }

    /// The axes fixed to the body as columns, where its own axes are the columns of `axes`.
    #[inline(always)]
    pub fn fixed_axes(&self, axes: Mat3<S>) -> Mat3<S> {
        axes.map_rows(|row| rotated_back(self.body_rotation, row))
    }

    /// A pose fixed to the body, in its axes.
    #[inline(always)]
    pub fn fixed_pose(&self, pose: Pose<S>) -> Pose<S> {
        let columns = pose.rotation.transpose().map_rows(|column| self.fixed_vector(column));
        Pose { rotation: columns.transpose(), position: self.fixed_vector(pose.position) }
    }

    /// The moments of the body's own mass, in its axes.
    #[inline(always)]
    pub fn own_inertia(&self, inertia: PseudoInertia<impl ParameterIn<S>>) -> PseudoInertia<S> {
        let PseudoInertia { mass, moment, second } = inertia.map(ParameterIn::value);
        PseudoInertia { mass, moment: self.fixed_vector(moment), second: rotated_tensor(self.body_rotation, second) }
    }

    /// Whether the body rotates against its axes.
    #[inline(always)]
    pub fn merged_parallel(&self) -> bool {
        self.body_rotation.is_some()
    }

    /// A wrench on the body, in the parent's axes and about the parent's origin.
    #[inline(always)]
    pub fn wrench_to_parent(&self, Wrench { moment, force }: Wrench<S>) -> Wrench<S> {
        Wrench { force: self.to_parent(force), moment: self.to_parent(moment) }.moved_by(self.position)
    }

    /// A velocity of the parent at its origin, at the body's origin and in its axes.
    #[inline(always)]
    pub fn twist_to_body(&self, Twist { angular, linear }: Twist<S>) -> Twist<S> {
        let linear = self.to_body(linear + angular.fused_cross(self.position));
        Twist { angular: self.to_body(angular), linear }
    }

    /// Moments of mass about the body's origin, in the parent's axes and about the parent's origin.
    #[inline(always)]
    pub fn inertia_to_parent(&self, inertia: PseudoInertia<S>) -> PseudoInertia<S> {
        PseudoInertia {
            mass: inertia.mass,
            moment: self.to_parent(inertia.moment),
            second: self.rotation.tensor_to_parent(inertia.second),
        }
        .translated(self.position)
    }
}
