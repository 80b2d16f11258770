//! The functions of frames: tools, feet and other frames of interest on the links of a mechanism.

use ::nalgebra::{Isometry3, RealField, SMatrix, SVector, Vector3, Vector6};

use super::{Number, array, isometry, matrix};
use crate::{FrameAcceleration, FrameJacobian, FrameState, Frames};

/// Position and velocity of one frame, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<S: RealField> {
    /// The frame: takes its points to the base frame, m.
    pub pose: Isometry3<S>,
    /// Velocity of the frame's origin, m/s.
    pub velocity: Vector3<S>,
    /// Angular velocity, rad/s.
    pub angular_velocity: Vector3<S>,
}

impl<S: RealField + Copy> Frame<S> {
    /// The velocity of the origin, then the angular velocity: J v of [`frame_jacobians`].
    pub fn twist(&self) -> Vector6<S> {
        stacked(*array(&self.velocity), *array(&self.angular_velocity))
    }
}

impl<S: RealField + Copy> From<FrameState<S>> for Frame<S> {
    fn from(state: FrameState<S>) -> Self {
        let FrameState { rotation, origin, velocity, angular_velocity } = state;
        Frame { pose: isometry(rotation, origin), velocity: velocity.into(), angular_velocity: angular_velocity.into() }
    }
}

/// A wrench on the mechanism at the origin of a frame, in the axes of the base frame. As a vector it is the force, then
/// the moment, so that its power is that vector times [`Frame::twist`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench<S: ::nalgebra::Scalar> {
    /// Force, N.
    pub force: Vector3<S>,
    /// Moment about the frame's origin, N m.
    pub moment: Vector3<S>,
}

impl<S: ::nalgebra::Scalar + Copy> From<Vector6<S>> for Wrench<S> {
    fn from(vector: Vector6<S>) -> Self {
        let [x, y, z, mx, my, mz] = *array(&vector);
        Wrench { force: [x, y, z].into(), moment: [mx, my, mz].into() }
    }
}

impl<S: ::nalgebra::Scalar + Copy> From<Wrench<S>> for Vector6<S> {
    fn from(wrench: Wrench<S>) -> Self {
        stacked(*array(&wrench.force), *array(&wrench.moment))
    }
}

impl<S: ::nalgebra::Scalar + Copy> From<Wrench<S>> for crate::Wrench<S> {
    fn from(wrench: Wrench<S>) -> Self {
        crate::Wrench { force: *array(&wrench.force), moment: *array(&wrench.moment) }
    }
}

/// The linear part, then the angular one.
fn stacked<S: ::nalgebra::Scalar>([x, y, z]: [S; 3], [rx, ry, rz]: [S; 3]) -> Vector6<S> {
    [x, y, z, rx, ry, rz].into()
}

/// [`Frames::frame_kinematics`]: where every frame is and how it moves, in the base frame, in the model's order.
pub fn frame_kinematics<S, M, const NQ: usize, const NV: usize, const NF: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> [Frame<S>; NF]
where
    S: Number + RealField,
    M: Frames<S, Coordinates = [S; NQ], Velocities = [S; NV], States = [FrameState<S>; NF]>,
{
    mechanism.frame_kinematics(array(q), array(v)).map(Frame::from)
}

/// [`Frames::frame_jacobians`]: the Jacobian J of every frame at its origin, in the axes of the base frame.
///
/// Rows 0 to 2 are linear: the velocity of the origin, m/s. Rows 3 to 5 are angular: the angular velocity, rad/s. This
/// is the order of [`FrameJacobian::rows`] and of [`Frame::twist`].
pub fn frame_jacobians<S, M, const NQ: usize, const NV: usize, const NF: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
) -> [SMatrix<S, 6, NV>; NF]
where
    S: Number,
    M: Frames<S, Coordinates = [S; NQ], Velocities = [S; NV], Jacobians = [FrameJacobian<[S; NV]>; NF]>,
{
    mechanism.frame_jacobians(array(q)).map(|jacobian| matrix(jacobian.rows()))
}

/// [`Frames::frame_bias`]: J̇ v of every frame, its acceleration at zero joint accelerations.
///
/// Rows are those of [`frame_jacobians`]: the acceleration of the origin, m/s², then the angular acceleration, rad/s².
pub fn frame_bias<S, M, const NQ: usize, const NV: usize, const NF: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> [Vector6<S>; NF]
where
    S: Number,
    M: Frames<S, Coordinates = [S; NQ], Velocities = [S; NV], Accelerations = [FrameAcceleration<S>; NF]>,
{
    mechanism.frame_bias(array(q), array(v)).map(|FrameAcceleration { linear, angular }| stacked(linear, angular))
}

/// [`Frames::frame_forces`]: Σ Jᵀ w, N m or N, the joint forces that do the same work as the wrenches on the frames.
pub fn frame_forces<S, M, const NQ: usize, const NV: usize, const NF: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    wrenches: &[Wrench<S>; NF],
) -> SVector<S, NV>
where
    S: Number,
    M: Frames<S, Coordinates = [S; NQ], Velocities = [S; NV], Wrenches = [crate::Wrench<S>; NF]>,
{
    mechanism.frame_forces(array(q), &wrenches.map(Into::into)).into()
}
