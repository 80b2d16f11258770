//! Where a frame stands in another, as files write it.

use nalgebra::UnitQuaternion;
use redysim_model::rotation::{roll_pitch_yaw, sin_cos};
use redysim_model::spatial::{Mat3, Pose, Vec3};

/// A position in metres, and roll, pitch and yaw in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Origin {
    pub xyz: [f64; 3],
    pub rpy: [f64; 3],
}

impl Origin {
    /// The frame itself.
    pub fn identity() -> Self {
        Origin { xyz: [0.0; 3], rpy: [0.0; 3] }
    }

    pub fn pose(self) -> Pose<f64> {
        Pose { rotation: roll_pitch_yaw(self.rpy), position: Vec3(self.xyz) }
    }

    /// The origin of a pose. Yaw comes first, and roll from what it leaves, so that they fit each other even where only
    /// their sum is determined, at a pitch of 90°.
    pub fn of(pose: Pose<f64>) -> Self {
        let nearest = |x: f64| if (x - x.round()).abs() < 4.0 * f64::EPSILON { x.round() + 0.0 } else { x };
        let Mat3(r) = Mat3::from_fn(|i, j| nearest(pose.rotation.0[i][j]));
        let yaw = r[1][0].atan2(r[0][0]);
        let pitch = (-r[2][0]).atan2(r[0][0].hypot(r[1][0]));
        let (sin, cos) = sin_cos(yaw);
        let roll = (sin * r[0][2] - cos * r[1][2]).atan2(cos * r[1][1] - sin * r[0][1]);
        Origin { xyz: pose.position.0, rpy: [roll, pitch, yaw] }
    }
}

/// The rotation of a quaternion (x, y, z, w) of any length; `None` for zero.
pub fn rotation(quaternion: [f64; 4]) -> Option<Mat3<f64>> {
    let rotation = UnitQuaternion::from_quaternion(scaled(quaternion)?.into()).to_rotation_matrix();
    Some(Mat3::from_fn(|i, j| rotation[(i, j)]))
}

/// The vector divided by its largest component, so that no square of a component overflows and their sum does not vanish;
/// `None` for zero.
pub fn scaled<const N: usize>(vector: [f64; N]) -> Option<[f64; N]> {
    let largest = vector.into_iter().fold(0.0, |largest: f64, component| largest.max(component.abs()));
    (largest > 0.0).then(|| vector.map(|component| component / largest))
}
