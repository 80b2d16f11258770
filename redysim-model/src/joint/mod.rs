//! What a joint does: one file for each kind, against one interface.
//!
//! A joint with one degree of freedom moves its body along or about the z axis of the body's frame; others turn it about any axis.
//! Its file states
//!
//! | item | what it is |
//! |---|---|
//! | `position` | where the body is at given coordinates, a [`JointPosition`] |
//! | `SCREW`, `SCREWS`, or a function | the motion subspace S in the body's frame: a [`Screw`] for each velocity |
//! | `split` | which inertia of the body its parent may carry as well, with the same joint forces |
//! | `meets` | which inertia alone makes the joint's diagonal element of the mass matrix positive |
//!
//! and [`Joint`] has a variant that names them and the functions by which its coordinates move, `coordinate_rates` and
//! its inverse `velocities`, `integrate`, `difference` and `neutral`, with the names of coordinates and velocities;
//! those of coordinates that add up are in `linear`, those of orientations in `quaternion`. From S follow the velocity S v across the joint, the bias
//! acceleration, and the joint force Sᵀ w of a wrench. The recursions do not depend on the kind of a joint.
//!
//! The joint of a link, a [`LinkJoint`], is one of these or a [`Series`] of them, each with a body of its own in the tree.

pub(crate) mod body_physics;
mod euler;
mod free;
mod helical;
mod linear;
mod link_joint;
mod measure;
pub(crate) mod physics;
mod position;
mod prismatic;
pub(crate) mod quaternion;
mod revolute;
mod screw;
mod series;
mod shared;
mod spherical;
mod stretch;

use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Pose, Twist, Vec3, Wrench};
pub use body_physics::{BodyPhysics, VelocityPhysics};
pub(crate) use body_physics::{Forces, sum};
pub use euler::EulerSequence;
pub use link_joint::LinkJoint;
pub use measure::Measure;
pub(crate) use physics::FRICTION_VELOCITY;
pub use physics::JointPhysics;
pub use position::JointPosition;
use redysim_runtime::Scalar;
pub use screw::{Screw, across};
pub use series::{Element, Series};
pub use shared::{AxisMass, Vanishing};

/// The most freedoms of a joint.
pub(crate) const MOST_FREEDOMS: usize = 6;

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
    /// Turns the body about any axis through the joint's origin. Its coordinates are a quaternion.
    Spherical,
    /// Leaves the body all six freedoms. Its coordinates are a position and a quaternion.
    Free,
}

impl Joint {
    /// Whether it moves its body about and along the z axis of the body's frame alone.
    #[inline]
    pub fn is_on_axis(self) -> bool {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => true,
            Joint::Spherical | Joint::Free => false,
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
            Joint::Spherical => spherical::COORDINATE_NAMES,
            Joint::Free => free::COORDINATE_NAMES,
        }
    }

    /// Names of its velocities, each unique within the joint.
    #[inline]
    pub fn velocity_names(self) -> &'static [&'static str] {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::VELOCITY_NAMES,
            Joint::Spherical => spherical::VELOCITY_NAMES,
            Joint::Free => free::VELOCITY_NAMES,
        }
    }

    /// What its coordinates measure.
    #[inline]
    pub fn coordinate_measures(self) -> &'static [Measure] {
        use Measure::{Angle, Length, Number};
        match self {
            Joint::Revolute | Joint::Helical { .. } => &[Angle],
            Joint::Prismatic => &[Length],
            Joint::Spherical => &[Number; 4],
            Joint::Free => &[Length, Length, Length, Number, Number, Number, Number],
        }
    }

    /// What the integrals of its velocities measure.
    #[inline]
    pub fn velocity_measures(self) -> &'static [Measure] {
        use Measure::{Angle, Length};
        match self {
            Joint::Revolute | Joint::Helical { .. } => &[Angle],
            Joint::Prismatic => &[Length],
            Joint::Spherical => &[Angle; 3],
            Joint::Free => &[Length, Length, Length, Angle, Angle, Angle],
        }
    }

    /// Which component a velocity is, for the names of values: "" for the one of a joint that has one.
    #[inline]
    pub fn component(self, velocity: usize) -> &'static str {
        match self.velocity_names() {
            [_] => "",
            names => names[velocity],
        }
    }

    /// The rates of its coordinates, q̇ = N(q) v.
    pub fn coordinate_rates<S: Scalar>(self, q: &[S], v: &[S], rates: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::coordinate_rates(v, rates),
            Joint::Spherical => spherical::coordinate_rates(q, v, rates),
            Joint::Free => free::coordinate_rates(q, v, rates),
        }
    }

    /// q ⊞ dv: where the joint is after a unit of time at the velocity `dv`.
    pub fn integrate<S: Scalar>(self, q: &[S], dv: &[S], moved: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::integrate(q, dv, moved),
            Joint::Spherical => spherical::integrate(q, dv, moved),
            Joint::Free => free::integrate(q, dv, moved),
        }
    }

    /// q₁ ⊟ q₀: the velocity that leads from `q0` to `q1` in a unit of time.
    pub fn difference<S: Scalar>(self, q0: &[S], q1: &[S], dv: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::difference(q0, q1, dv),
            Joint::Spherical => spherical::difference(q0, q1, dv),
            Joint::Free => free::difference(q0, q1, dv),
        }
    }

    /// The coordinates of the zero position.
    pub fn neutral<S: Scalar>(self, q: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::neutral(q),
            Joint::Spherical => spherical::neutral(q),
            Joint::Free => free::neutral(q),
        }
    }

    /// The position of the body at the coordinates `q`.
    #[inline]
    pub fn position<S: Scalar>(self, q: &[S]) -> JointPosition<S> {
        match self {
            Joint::Revolute => revolute::position(q[0]),
            Joint::Prismatic => prismatic::position(q[0]),
            Joint::Helical { pitch } => helical::position(pitch, q[0]),
            Joint::Spherical => spherical::position(q),
            Joint::Free => free::position(q),
        }
    }

    /// The body's frame at the coordinates `q`, in the frame of the joint on the parent.
    pub fn transform<S: Scalar>(self, q: &[S]) -> Pose<S> {
        self.position(q).pose()
    }

    /// `twist` + S v.
    #[inline(always)]
    pub fn added<S: Scalar>(self, mut twist: Twist<S>, v: &[S]) -> Twist<S> {
        if self.is_on_axis() {
            return self.screw(0).added(twist, v[0]);
        }
        for (i, &v) in v.iter().enumerate() {
            twist = self.screw(i).added(twist, v);
        }
        twist
    }

    /// The acceleration of the body against its parent at zero joint acceleration, where the parent's angular velocity
    /// is `angular` in the body's axes: (ω × ω_r; (2 ω + ω_r) × u_r) for the velocity (ω_r; u_r) across the joint.
    #[inline(always)]
    pub fn bias<S: Scalar>(self, angular: Vec3<S>, v: &[S]) -> Twist<S> {
        if self.is_on_axis() {
            return self.screw(0).bias(angular, v[0]);
        }
        let across = self.added(Twist::zero(), v);
        Twist {
            angular: angular.fused_cross(across.angular),
            linear: (angular + angular + across.angular).fused_cross(across.linear),
        }
    }

    /// Sᵀ w, the joint forces of a wrench.
    #[inline(always)]
    pub fn project<S: Scalar>(self, wrench: Wrench<S>, tau: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => project_on([self.screw(0)], wrench, tau),
            Joint::Spherical => project_on(spherical::SCREWS, wrench, tau),
            Joint::Free => project_on(free::SCREWS, wrench, tau),
        }
    }

    /// The column of the motion subspace S for one of its velocities.
    #[inline]
    pub fn screw(self, velocity: usize) -> Screw {
        match self {
            Joint::Revolute => revolute::SCREW,
            Joint::Prismatic => prismatic::SCREW,
            Joint::Helical { pitch } => helical::screw(pitch),
            Joint::Spherical => spherical::SCREWS[velocity],
            Joint::Free => free::SCREWS[velocity],
        }
    }

    /// The columns of the motion subspace S.
    #[inline]
    pub fn screws(self) -> impl DoubleEndedIterator<Item = Screw> + ExactSizeIterator {
        (0..self.nv()).map(move |velocity| self.screw(velocity))
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
            Joint::Spherical => spherical::split(inertia),
            Joint::Free => free::split(inertia),
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
            Joint::Spherical => spherical::meets(inertia),
            Joint::Free => free::meets(inertia),
        }
    }

    /// The same joint in another unit of length, `unit` m; `None` if a coordinate is a length.
    pub fn in_unit(self, unit: f64) -> Option<Joint> {
        match self {
            Joint::Revolute | Joint::Spherical => Some(self),
            Joint::Prismatic | Joint::Free => None,
            Joint::Helical { pitch } => Some(Joint::Helical { pitch: pitch / unit }),
        }
    }
}

/// The joint forces of a wrench along `screws`, which the compiler knows if it unrolls this loop.
#[inline(always)]
fn project_on<S: Scalar, const N: usize>(screws: [Screw; N], wrench: Wrench<S>, tau: &mut [S]) {
    if let Some(tau) = tau.first_chunk_mut::<N>() {
        for i in 0..N {
            // One at a time: vectors of the few velocities of a joint take longer to put together than they save.
            [tau[i]] = S::apart([screws[i].project(wrench)]);
        }
    }
}

#[cfg(test)]
mod tests;
