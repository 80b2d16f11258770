//! What a joint does: one file for each kind, against one interface.
//!
//! A joint moves its body along or about the z axis of the body's frame. Its file states
//!
//! | item | what it is |
//! |---|---|
//! | `SCREW`, or a function of the joint's parameters | the motion subspace S in the body's frame: velocity across the joint is S v |
//! | `split` | which inertia of the body its parent may carry as well, with the same joint forces |
//! | `meets` | which inertia alone makes the joint's diagonal element of the mass matrix positive |
//!
//! and [`Joint`] has a variant that names them. From S follow the transform (a rotation about z by the turn of q, a
//! displacement along z by its slide), the bias acceleration, and the joint force Sᵀ w of a wrench; the recursions know no
//! kind of joint.

mod prismatic;
mod revolute;
mod screw;
mod shared;

use crate::model::{JointKind, Link};
use crate::pseudo::PseudoInertia;
pub use screw::Screw;
pub use shared::{AxisMass, Vanishing};

/// What a joint of the tree does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// Turns the body about its z axis.
    Revolute,
    /// Moves the body along its z axis.
    Prismatic,
}

impl Joint {
    /// What the joint of a link does; `None` if it is fixed.
    pub fn of(link: &Link) -> Option<Joint> {
        match link.joint {
            JointKind::Revolute => Some(Joint::Revolute),
            JointKind::Prismatic => Some(Joint::Prismatic),
            JointKind::Fixed => None,
        }
    }

    /// Number of coordinates.
    pub fn nq(self) -> usize {
        1
    }

    /// Number of velocities.
    pub fn nv(self) -> usize {
        1
    }

    /// The motion subspace S.
    pub fn screw(self) -> Screw {
        match self {
            Joint::Revolute => revolute::SCREW,
            Joint::Prismatic => prismatic::SCREW,
        }
    }

    /// The inertia of the body as what stays with it, in which `vanishing` vanishes, and what its parent may carry: joint
    /// forces, the mass matrix and energies are then the same.
    pub fn split(self, inertia: PseudoInertia<f64>, vanishing: Vanishing) -> (PseudoInertia<f64>, PseudoInertia<f64>) {
        match self {
            Joint::Revolute => revolute::split(inertia, vanishing),
            Joint::Prismatic => prismatic::split(inertia),
        }
    }

    /// How much of the body's own inertia resists the joint's motion, Sᵀ I S, as a share of what could.
    pub fn meets(self, inertia: PseudoInertia<f64>) -> f64 {
        match self {
            Joint::Revolute => revolute::meets(inertia),
            Joint::Prismatic => prismatic::meets(inertia),
        }
    }
}
