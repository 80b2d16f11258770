//! Frames of interest on the links of a mechanism, such as tools and feet: their motion, Jacobians and wrenches.

use crate::{ConfigurationSpace, Scalar, Vector};

/// The frames of interest of a mechanism: the tables `[[frame]]` of its model, in the file's order.
///
/// A compiled type has this trait if its model has frames and all functions of the trait are among its functions.
pub trait Frames<S: Scalar>: ConfigurationSpace<S> {
    /// One [`FrameState`] for each frame: `[FrameState<S>; NF]`.
    type States: AsRef<[FrameState<S>]>;
    /// One [`FrameJacobian`] for each frame: `[FrameJacobian<[S; NV]>; NF]`.
    type Jacobians: Vector<FrameJacobian<Self::Velocities>>;
    /// One [`FrameAcceleration`] for each frame: `[FrameAcceleration<S>; NF]`.
    type Accelerations: Vector<FrameAcceleration<S>>;
    /// One [`Wrench`] for each frame: `[Wrench<S>; NF]`.
    type Wrenches: Vector<Wrench<S>>;

    /// Position and velocity of every frame, in the base frame.
    fn frame_kinematics(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::States;
    /// J(q) of every frame.
    fn frame_jacobians(&self, q: &Self::Coordinates) -> Self::Jacobians;
    /// J̇ v of every frame: its acceleration at zero joint accelerations.
    fn frame_bias(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Accelerations;
    /// Σ Jᵀ w, N m or N: the joint forces that do the same work as `wrenches`, which act on the mechanism at the
    /// frames. With these, the equations of motion are M a + C v + g = τ + Σ Jᵀ w.
    fn frame_forces(&self, q: &Self::Coordinates, wrenches: &Self::Wrenches) -> Self::Velocities;
}

/// Position and velocity of one frame, in the base frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameState<S> {
    /// The frame's axes, as columns, in the base frame; `rotation[row][column]`.
    pub rotation: [[S; 3]; 3],
    /// Origin of the frame, m.
    pub origin: [S; 3],
    /// Velocity of the origin, m/s.
    pub velocity: [S; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [S; 3],
}

/// The Jacobian of one frame at its origin, in the axes of the base frame. `Row` has an entry for each joint velocity:
/// `[S; NV]` for compiled types, `Vec<S>` for the generic path.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameJacobian<Row> {
    /// By rows: the velocity of the origin is `linear` · v, m/s.
    pub linear: [Row; 3],
    /// By rows: the angular velocity is `angular` · v, rad/s.
    pub angular: [Row; 3],
}

impl<Row: Clone> FrameJacobian<Row> {
    /// All rows: those of `linear`, then those of `angular`.
    pub fn rows(&self) -> [Row; 6] {
        let ([x, y, z], [rx, ry, rz]) = (self.linear.clone(), self.angular.clone());
        [x, y, z, rx, ry, rz]
    }
}

/// The acceleration of one frame, in the base frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameAcceleration<S> {
    /// Acceleration of the origin, the second derivative of its position, m/s².
    pub linear: [S; 3],
    /// Angular acceleration, rad/s².
    pub angular: [S; 3],
}

/// A wrench on the mechanism at the origin of a frame, in the axes of the base frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Wrench<S> {
    /// Force, N.
    pub force: [S; 3],
    /// Moment about the frame's origin, N m.
    pub moment: [S; 3],
}
