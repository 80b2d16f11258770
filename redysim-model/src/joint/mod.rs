//! What a joint does: one file for each kind, against one interface.
//!
//! A joint moves its body along or about the z axis of the body's frame. Its file states
//!
//! | item | what it is |
//! |---|---|
//! | `position` | where the body is at given coordinates, a [`JointPosition`] |
//! | `SCREW`, or a function of the joint's parameters | the motion subspace S in the body's frame |
//! | `split` | which inertia of the body its parent may carry as well, with the same joint forces |
//! | `meets` | which inertia alone makes the joint's diagonal element of the mass matrix positive |
//!
//! and [`Joint`] has a variant that names them and the functions by which its coordinates move, `coordinate_rates` and
//! its inverse `velocities`, `integrate`, `difference` and `neutral`, with the names of coordinates and velocities;
//! those of coordinates that add up are in `linear`. From S follow the velocity S v across the joint, the bias
//! acceleration, and the joint force Sᵀ w of a wrench. The recursions do not depend on the kind of a joint.

mod helical;
mod linear;
pub(crate) mod physics;
mod position;
mod prismatic;
mod revolute;
mod screw;
mod shared;

use crate::model::{JointKind, Link};
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Pose, Twist, Vec3, Wrench};
pub(crate) use physics::FRICTION_VELOCITY;
pub use physics::JointPhysics;
pub(crate) use physics::sum;
pub use position::JointPosition;
use redysim_runtime::Scalar;
pub use screw::Screw;
pub use shared::{AxisMass, Vanishing};

/// What a joint of the tree does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Joint {
    /// Turns the body about its z axis.
    Revolute,
    /// Moves the body along its z axis.
    Prismatic,
    /// Turns the body about its z axis and moves it along.
    Helical {
        /// Displacement for a unit of rotation, m/rad.
        pitch: f64,
    },
}

impl Joint {
    /// What the joint of a link does; `None` if it is fixed.
    pub fn of(link: &Link) -> Option<Joint> {
        Joint::of_kind(link.joint, link.pitch)
    }

    /// The joint of the given kind, `None` if it is fixed. A helical joint has the pitch `pitch`, m/rad.
    pub(crate) fn of_kind(kind: JointKind, pitch: f64) -> Option<Joint> {
        match kind {
            JointKind::Revolute => Some(Joint::Revolute),
            JointKind::Prismatic => Some(Joint::Prismatic),
            JointKind::Helical => Some(Joint::Helical { pitch }),
            JointKind::Fixed => None,
        }
    }

    /// Number of coordinates.
    #[inline]
    pub fn nq(self) -> usize {
        self.coordinate_names().len()
    }

    /// Number of velocities.
    #[inline]
    pub fn nv(self) -> usize {
        self.velocity_names().len()
    }

    /// Names of its coordinates, each unique within the joint.
    #[inline]
    pub fn coordinate_names(self) -> &'static [&'static str] {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::COORDINATE_NAMES,
        }
    }

    /// Names of its velocities, each unique within the joint.
    #[inline]
    pub fn velocity_names(self) -> &'static [&'static str] {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::VELOCITY_NAMES,
        }
    }

    /// The rates of its coordinates, q̇ = N(q) v.
    pub fn coordinate_rates<S: Scalar>(self, q: &[S], v: &[S], rates: &mut [S]) {
        let _ = q;
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::coordinate_rates(v, rates),
        }
    }

    /// The velocities at which its coordinates have these rates: the inverse of
    /// [`coordinate_rates`](Joint::coordinate_rates).
    pub fn velocities<S: Scalar>(self, q: &[S], rates: &[S], v: &mut [S]) {
        let _ = q;
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::velocities(rates, v),
        }
    }

    /// q ⊞ dv: where the joint is after a unit of time at the velocity `dv`.
    pub fn integrate<S: Scalar>(self, q: &[S], dv: &[S], moved: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::integrate(q, dv, moved),
        }
    }

    /// q₁ ⊟ q₀: the velocity that leads from `q0` to `q1` in a unit of time.
    pub fn difference<S: Scalar>(self, q0: &[S], q1: &[S], dv: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::difference(q0, q1, dv),
        }
    }

    /// The coordinates of the zero position.
    pub fn neutral<S: Scalar>(self, q: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::neutral(q),
        }
    }

    /// The position of the body at the coordinates `q`.
    #[inline]
    pub fn position<S: Scalar>(self, q: &[S]) -> JointPosition<S> {
        match self {
            Joint::Revolute => revolute::position(q[0]),
            Joint::Prismatic => prismatic::position(q[0]),
            Joint::Helical { pitch } => helical::position(pitch, q[0]),
        }
    }

    /// The body's frame at the coordinates `q`, in the frame of the joint on the parent.
    pub fn transform<S: Scalar>(self, q: &[S]) -> Pose<S> {
        self.position(q).pose()
    }

    /// `twist` + S v.
    #[inline]
    pub fn added<S: Scalar>(self, twist: Twist<S>, v: &[S]) -> Twist<S> {
        self.screw().added(twist, v[0])
    }

    /// The acceleration of the body against its parent at zero joint acceleration, where the parent's angular velocity
    /// is `angular` in the body's axes.
    #[inline]
    pub fn bias<S: Scalar>(self, angular: Vec3<S>, v: &[S]) -> Twist<S> {
        self.screw().bias(angular, v[0])
    }

    /// Sᵀ w, the joint forces of a wrench.
    #[inline]
    pub fn project<S: Scalar>(self, wrench: Wrench<S>, tau: &mut [S]) {
        tau[0] = self.screw().project(wrench);
    }

    /// `wrench` with the joint forces set to `tau`, their exact values.
    #[inline]
    pub fn with_forces<S: Scalar>(self, wrench: Wrench<S>, tau: &[S]) -> Wrench<S> {
        self.screw().with_force(wrench, tau[0])
    }

    /// The motion subspace S.
    #[inline]
    pub fn screw(self) -> Screw {
        match self {
            Joint::Revolute => revolute::SCREW,
            Joint::Prismatic => prismatic::SCREW,
            Joint::Helical { pitch } => helical::screw(pitch),
        }
    }

    /// The inertia of the body as what stays with it, in which `vanishing` vanishes, and what its parent may carry:
    /// joint forces, the mass matrix and energies are then the same.
    pub fn split<P: Parameter>(
        self,
        inertia: PseudoInertia<P>,
        vanishing: Vanishing,
    ) -> (PseudoInertia<P>, PseudoInertia<P>) {
        match self {
            Joint::Revolute => revolute::split(inertia, vanishing),
            Joint::Prismatic => prismatic::split(inertia),
            Joint::Helical { .. } => helical::split(inertia, vanishing),
        }
    }

    /// Whether all mass on the joint's axis may move to the parent: [`split`](Self::split) leaves none with the body.
    pub fn shares_axis_mass(self) -> bool {
        let mass = AxisMass { mass: 1.0, first: 1.0, second: 1.0 }.inertia();
        self.split(mass, Vanishing::SecondMomentZz).0 == PseudoInertia::zero()
    }

    /// How much of the body's own inertia resists the joint's motion, Sᵀ I S, as a share of what could.
    pub fn meets(self, inertia: PseudoInertia<f64>) -> f64 {
        match self {
            Joint::Revolute => revolute::meets(inertia),
            Joint::Prismatic => prismatic::meets(inertia),
            Joint::Helical { pitch } => helical::meets(pitch, inertia),
        }
    }

    /// The same joint in another unit of length, `unit` m; `None` if its coordinate is a length.
    pub fn in_unit(self, unit: f64) -> Option<Joint> {
        match self {
            Joint::Revolute => Some(self),
            Joint::Prismatic => None,
            Joint::Helical { pitch } => Some(Joint::Helical { pitch: pitch / unit }),
        }
    }
}

impl Link {
    /// The displacement of the link along its axis where the joint variable is zero, m.
    pub fn offset_along_axis(&self) -> f64 {
        Joint::of(self).and_then(|joint| joint.position(&[self.offset]).displacement).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests;
