//! The position of a body on its joint.

use crate::spatial::{Mat3, Pose, Vec3};
use redysim_runtime::Scalar;

/// The position of a body relative to the frame of its joint on the parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointPosition<S> {
    /// Its rotation about z, rad; `None` if the joint does not turn.
    pub angle: Option<S>,
    /// Its displacement along z, m; `None` if the joint does not slide.
    pub displacement: Option<S>,
}

impl<S: Scalar> JointPosition<S> {
    /// The body's frame.
    pub fn pose(self) -> Pose<S> {
        let (zero, one) = (S::zero(), S::one());
        let (sin, cos) = self.angle.map_or((zero, one), S::sin_cos);
        Pose {
            rotation: Mat3([[cos, -sin, zero], [sin, cos, zero], [zero, zero, one]]),
            position: Vec3([zero, zero, self.displacement.unwrap_or(zero)]),
        }
    }
}
