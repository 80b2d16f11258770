//! Joints held at a value: as if the file had them fixed there.

use crate::joint::{Joint, JointPhysics, JointPosition};
use crate::model::{JointKind, Link, Model};
use crate::rotation;
use crate::rotation::align_z;
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_toml::words::{did_you_mean, nearest, quoted};
use std::fmt;

impl Model {
    /// The model with joints held at these values of their coordinates, rad or m: each as if it were fixed there.
    ///
    /// A joint is meant by its name or by that of its link. The link stays among the links; its coordinate is none any
    /// more, and the link becomes part of its parent's body.
    ///
    /// # Errors
    ///
    /// If there is no such joint, it is fixed or named twice, its value is not finite, or nothing is left that moves.
    ///
    /// # Example
    ///
    /// ```
    /// # use redysim_model::Model;
    /// # let text = "name = 'arm'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'upper'\nparent = 'base'\n\
    /// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 1.0\ncom = [0.5, 0, 0]\n\n[[link]]\nname = 'fore'\n\
    /// #     joint_name = 'elbow'\nparent = 'upper'\njoint = 'revolute'\naxis = [0, 1, 0]\nmass = 1.0\ncom = [0.5, 0, 0]";
    /// let arm = Model::from_toml(text, "arm.toml").unwrap().model;
    /// let stiff = arm.locked(&[("elbow", 0.3)])?;
    /// assert_eq!((arm.dof(), stiff.dof()), (2, 1));
    /// assert_eq!(
    ///     arm.locked(&[("elbw", 0.3)]).unwrap_err().to_string(),
    ///     "unknown joint `elbw` to lock; did you mean `elbow`? The joints are: upper, elbow"
    /// );
    /// # Ok::<(), redysim_model::LockError>(())
    /// ```
    pub fn locked(&self, joints: &[(&str, f64)]) -> Result<Model, LockError> {
        let mut model = self.clone();
        for &(joint, value) in joints {
            let names = self.links.iter().map(|link| (Some(link.joint_name.as_str()), Some(link.name.as_str())));
            let Some(index) = by_name(joint, names) else {
                let joints = self.moving_links().map(|link| link.joint_name.clone()).collect();
                return Err(LockError::Unknown { joint: joint.into(), joints });
            };
            if self.links[index].joint == JointKind::Fixed {
                return Err(LockError::Fixed { joint: joint.into() });
            }
            if !self.links[index].joint.has_axis() {
                return Err(LockError::SeveralCoordinates { joint: joint.into() });
            }
            if model.links[index].joint == JointKind::Fixed {
                return Err(LockError::Twice { joint: joint.into() });
            }
            if !value.is_finite() {
                return Err(LockError::NotFinite { joint: joint.into(), value });
            }
            model.links[index].lock(value);
        }
        if model.dof() == 0 { Err(LockError::NothingMoves) } else { Ok(model) }
    }
}

impl Link {
    /// Fixes the joint where its coordinate is `value`.
    pub(crate) fn lock(&mut self, value: f64) {
        let travel = self.offset + value;
        if let Some(joint) = Joint::of(self) {
            let motion = match joint.position(&[travel]) {
                JointPosition::OnAxis { angle, displacement } => {
                    let turn = angle.map_or(Mat3::identity(), |angle| {
                        let aligned = align_z(self.axis);
                        aligned * rotation::about_z(angle) * aligned.transpose()
                    });
                    let slide = displacement.map_or(Vec3::zero(), |slide| self.axis.scale(slide));
                    Pose { rotation: turn, position: slide }
                }
                in_space => in_space.pose(),
            };
            self.placement = (self.placement * motion * self.frame).without_negative_zeros();
            self.frame = Pose::identity();
        }
        self.joint = JointKind::Fixed;
        self.axis = Vec3([0.0, 0.0, 1.0]);
        (self.offset, self.pitch) = (0.0, 0.0);
        self.physics = JointPhysics::default();
    }
}

/// The index of the link whose joint has this name, or else which has it itself. `names` are the joint's and the
/// link's, as far as they can be read.
pub(crate) fn by_name<'a>(
    name: &str,
    names: impl Iterator<Item = (Option<&'a str>, Option<&'a str>)> + Clone,
) -> Option<usize> {
    let joint = names.clone().position(|(joint, _)| joint == Some(name));
    joint.or_else(|| names.clone().position(|(_, link)| link == Some(name)))
}

/// Why joints cannot be locked.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LockError {
    /// Neither a joint nor a link has this name.
    Unknown {
        /// The name given.
        joint: String,
        /// The joints that move.
        joints: Vec<String>,
    },
    /// The joint is fixed in the model.
    Fixed {
        /// The name given.
        joint: String,
    },
    /// The joint has several coordinates, which one value cannot set.
    SeveralCoordinates {
        /// The name given.
        joint: String,
    },
    /// The joint is named twice, perhaps once by its link.
    Twice {
        /// The name given the second time.
        joint: String,
    },
    /// The value is infinite or not a number.
    NotFinite {
        /// The name given.
        joint: String,
        /// The value given.
        value: f64,
    },
    /// No joint is left that moves.
    NothingMoves,
}

impl fmt::Display for LockError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LockError::Unknown { joint, joints } => {
                let meant = did_you_mean(nearest(joint, joints.iter().map(String::as_str)));
                write!(f, "unknown joint {} to lock; {meant}The joints are: {}", quoted(joint), joints.join(", "))
            }
            LockError::Fixed { joint } => write!(f, "joint {} is fixed already: do not lock it", quoted(joint)),
            LockError::SeveralCoordinates { joint } => {
                write!(f, "joint {} has several coordinates, which one value cannot lock", quoted(joint))
            }
            LockError::Twice { joint } => write!(f, "joint {} is locked twice: give it one value", quoted(joint)),
            LockError::NotFinite { joint, value } => {
                write!(f, "joint {} cannot be locked at {value:?}: give a finite value, rad or m", quoted(joint))
            }
            LockError::NothingMoves => write!(f, "every joint is fixed or locked: leave at least one that moves"),
        }
    }
}

impl std::error::Error for LockError {}
