//! Joints held at a value: as if the file had them fixed there.

use crate::joint::{Element, JointPhysics, JointPosition, LinkJoint};
use crate::model::{JointKind, Link, Model};
use crate::rotation;
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_toml::words::{did_you_mean, nearest, quoted};
use std::fmt;

impl Model {
    /// The model with joints held at these values of their coordinates, rad or m: each as if it were fixed there. A joint
    /// of one coordinate is held at a number, one of several at an array of them.
    ///
    /// A joint is given by its name or by that of its link. The link stays among the links, without a coordinate, and
    /// becomes part of its parent's body.
    ///
    /// # Errors
    ///
    /// If the joint does not exist, is fixed or is named twice; if its value is not finite, has the wrong number of
    /// coordinates, or has a zero quaternion; or if no joint is left that moves.
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
    pub fn locked(&self, joints: &[(&str, impl JointCoordinates)]) -> Result<Model, LockError> {
        let mut model = self.clone();
        for (joint, value) in joints {
            let (joint, values) = (*joint, value.coordinates());
            let names = self.links.iter().map(|link| (Some(link.joint_name.as_str()), Some(link.name.as_str())));
            let Some(index) = by_name(joint, names) else {
                let joints = self.moving_links().map(|link| link.joint_name.clone()).collect();
                return Err(LockError::Unknown { joint: joint.into(), joints });
            };
            let Some(motion) = LinkJoint::of(&self.links[index]) else {
                return Err(LockError::Fixed { joint: joint.into() });
            };
            if model.links[index].joint == JointKind::Fixed {
                return Err(LockError::Twice { joint: joint.into() });
            }
            let expected = motion.nq();
            if values.len() != expected {
                return Err(LockError::WrongCount { joint: joint.into(), expected, found: values.len() });
            }
            if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
                return Err(LockError::NotFinite { joint: joint.into(), value });
            }
            if motion.has_no_orientation_at(values) {
                return Err(LockError::NoOrientation { joint: joint.into() });
            }
            if let Some(mimic) = self.links[index].mimic {
                let followed = self.links[mimic.link].joint_name.clone();
                return Err(LockError::Mimics { joint: joint.into(), followed });
            }
            model.lock(index, values);
        }
        if model.dof() == 0 { Err(LockError::NothingMoves) } else { Ok(model) }
    }
}

impl Model {
    /// Fixes the joint of a link where its coordinates are `values`, and those that mimic it where they are then.
    fn lock(&mut self, index: usize, values: &[f64]) {
        self.links[index].lock(values);
        for follower in 0..self.links.len() {
            if let (Some(mimic), [value]) = (self.links[follower].mimic.filter(|mimic| mimic.link == index), values) {
                self.lock(follower, &[mimic.multiplier * value + mimic.offset]);
            }
        }
    }
}

/// The coordinates of one joint: a number, or several.
pub trait JointCoordinates {
    /// The coordinates.
    fn coordinates(&self) -> &[f64];
}

impl JointCoordinates for f64 {
    fn coordinates(&self) -> &[f64] {
        std::slice::from_ref(self)
    }
}

impl<const N: usize> JointCoordinates for [f64; N] {
    fn coordinates(&self) -> &[f64] {
        self
    }
}

impl JointCoordinates for Vec<f64> {
    fn coordinates(&self) -> &[f64] {
        self
    }
}

impl JointCoordinates for &[f64] {
    fn coordinates(&self) -> &[f64] {
        self
    }
}

impl LinkJoint {
    /// Whether the coordinates have a quaternion, and that is zero.
    pub(crate) fn has_no_orientation_at(self, values: &[f64]) -> bool {
        let quaternion = values.get(self.quaternion()).unwrap_or_default();
        !quaternion.is_empty() && quaternion.iter().all(|component| *component == 0.0)
    }
}

/// The frame that a joint of the tree moves, at its coordinates `q` and the offset, in the frame where its motion is zero;
/// exact at quarter turns. An offset belongs to a joint of one coordinate.
fn held(Element { joint, axes }: Element, offset: f64, q: &[f64]) -> Pose<f64> {
    let travel: Vec<f64> = q.iter().map(|q| offset + q).collect();
    let JointPosition::OnAxis { angle, displacement } = joint.position(&travel) else {
        return joint.transform(&travel);
    };
    let turned = |angle| axes * rotation::about_z(angle) * axes.transpose();
    Pose {
        rotation: angle.map_or(Mat3::identity(), turned),
        position: displacement.map_or(Vec3::zero(), |slide| axes.column(2).scale(slide)),
    }
}

impl Link {
    /// Fixes the joint where its coordinates are `values`, as many as it has.
    pub(crate) fn lock(&mut self, values: &[f64]) {
        if let Some(joint) = LinkJoint::of(self) {
            let elements = joint.elements(self.axis);
            // Each has one coordinate, but a joint in space, which has all.
            let of_each = elements.iter().zip(values.chunks((values.len() / elements.len()).max(1)));
            let motion = of_each.fold(Pose::identity(), |moved, (element, q)| moved * held(*element, self.offset, q));
            self.placement = (self.placement * motion * self.frame).without_negative_zeros();
            self.frame = Pose::identity();
        }
        self.joint = JointKind::Fixed;
        self.axis = Vec3([0.0, 0.0, 1.0]);
        (self.offset, self.pitch, self.coordinates) = (0.0, 0.0, None);
        self.physics = JointPhysics::default();
        self.mimic = None;
        self.actuated = true.into();
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
    /// The joint mimics another.
    Mimics {
        /// The name given.
        joint: String,
        /// The joint that it mimics.
        followed: String,
    },
    /// The value has the wrong number of coordinates.
    WrongCount {
        /// The name given.
        joint: String,
        /// How many coordinates the joint has.
        expected: usize,
        /// How many are given.
        found: usize,
    },
    /// The joint's quaternion is zero.
    NoOrientation {
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
            LockError::Mimics { joint, followed } => {
                write!(f, "joint {} mimics {}: lock that one instead", quoted(joint), quoted(followed))
            }
            LockError::WrongCount { joint, expected, found } => {
                write!(f, "joint {} has {expected} coordinates, but is locked at {found}", quoted(joint))
            }
            LockError::NoOrientation { joint } => {
                write!(f, "joint {} cannot be locked at a zero quaternion: give one that is not zero", quoted(joint))
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
