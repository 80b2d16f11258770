//! The position of a body on its joint.

use super::quaternion::{self, Quaternion};
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_runtime::Scalar;

/// The position of a body relative to the frame of its joint on the parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum JointPosition<S> {
    /// Of a joint that moves its body about and along its z axis.
    OnAxis {
        /// The rotation about z, rad; `None` if the joint does not turn.
        angle: Option<S>,
        /// The displacement along z, m; `None` if the joint does not slide.
        displacement: Option<S>,
    },
    /// Of a joint that turns its body about any axis.
    InSpace {
        /// The rotation of the body, as a quaternion (x, y, z, w) of any length but zero.
        orientation: Quaternion<S>,
        /// The body's origin, m; `None` if it stays at that of the joint.
        displacement: Option<Vec3<S>>,
    },
}

impl<S: Scalar> JointPosition<S> {
    /// The body's frame.
    pub fn pose(self) -> Pose<S> {
        let (zero, one) = (S::zero(), S::one());
        match self {
            JointPosition::OnAxis { angle, displacement } => {
                let (sin, cos) = angle.map_or((zero, one), S::sin_cos);
                Pose {
                    rotation: Mat3([[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]]),
                    position: Vec3([zero, zero, displacement.unwrap_or(zero)]),
                }
            }
            JointPosition::InSpace { orientation, displacement } => {
                Pose { rotation: quaternion::rotation(orientation), position: displacement.unwrap_or_else(Vec3::zero) }
            }
        }
    }
}
