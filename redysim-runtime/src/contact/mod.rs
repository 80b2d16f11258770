//! Contact with the ground: frames of a mechanism that meet planes.
//!
//! | item | is |
//! |---|---|
//! | [`Contact`] | a frame, the [`GroundPlane`] that it meets, and the law of the force between them |
//! | [`ReDySimContact`] | ReDySim's law: a linear spring and damper, friction by the arctangent |
//! | [`HuntCrossleyContact`] | a nonlinear spring whose damping fades with the penetration, regularised Coulomb friction |
//! | [`AnyContactLaw`] | one of the two, where contacts of one mechanism have different laws; [`ContactLaw`] is for laws of your own |
//! | [`Grounded`] | a mechanism with contacts: a mechanism itself, which every simulation and torque law takes |
//!
//! The contact force acts at the origin of the frame, which may be any number of times in the list of contacts.
//!
//! ```
//! use redysim_runtime::{Contact, FrameState, GroundPlane, HuntCrossleyContact};
//!
//! let law = HuntCrossleyContact { stiffness: 1e5, exponent: 1.5, damping: 0.3, friction: 0.7, slip_velocity: 0.01 };
//! let ground = GroundPlane::new([0.0; 3], [0.0, 0.0, 1.0])?;
//! let foot = Contact::new(0, ground, law)?;
//! let above = FrameState { origin: [0.0, 0.0, 0.1], ..FrameState::default() };
//! assert_eq!(foot.reaction(&above).force, [0.0; 3]);
//! let below = FrameState { origin: [0.0, 0.0, -0.01], ..FrameState::default() };
//! assert!((foot.reaction(&below).normal_force - 1e5 * 0.001) < 1e-9);
//! # Ok::<(), redysim_runtime::ContactError<f64>>(())
//! ```

mod error;
mod friction;
mod grounded;
mod hunt_crossley;
mod law;
mod phases;
mod plane;
mod redysim;

use core::cell::Cell;

use crate::{FrameState, Real};

pub use error::{ContactError, ContactRule};
pub use grounded::Grounded;
pub use hunt_crossley::HuntCrossleyContact;
pub use law::{AnyContactLaw, ContactLaw, NormalForce};
pub use phases::ContactEvent;
pub use plane::GroundPlane;
pub use redysim::ReDySimContact;

/// A frame of a mechanism that may touch a plane, and the law of the force between them.
///
/// Whether the two touch follows from the position: they do where the penetration is that of the law's
/// [`onset`](ContactLaw::onset) or more. [`Grounded::run`] fixes the state of contact from event to event instead, so that
/// the force is smooth within each step.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact<S, L> {
    frame: usize,
    plane: GroundPlane<S>,
    law: L,
    phase: Cell<Phase>,
}

/// How a contact determines whether it exerts a force.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    /// It exerts a force where the frame penetrates the ground.
    ByPosition,
    /// It does not exert a force until the next touch-down.
    Open,
    /// It exerts a force until the next lift-off.
    Closed,
}

/// What the ground does to a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Reaction<S> {
    /// Force on the mechanism at the origin of the frame, in the axes of the base frame, N.
    pub force: [S; 3],
    /// Its component along the outward normal of the ground, N.
    pub normal_force: S,
    /// How deep the origin of the frame is in the ground, m; negative above it.
    pub penetration: S,
    /// Whether frame and ground touch.
    pub touching: bool,
    /// Elastic energy stored in the ground, J.
    pub energy: S,
    /// Power that damping and friction of the ground take, W.
    pub dissipated_power: S,
}

impl<S: Real, L: ContactLaw<S>> Contact<S, L> {
    /// The contact of frame number `frame`, counted from 0 as in [`frame_name`](crate::Mechanism::frame_name), with
    /// `plane`.
    ///
    /// # Errors
    /// The first parameter of the law that is invalid.
    pub fn new(frame: usize, plane: GroundPlane<S>, law: L) -> Result<Self, ContactError<S>> {
        law.check()?;
        Ok(Self { frame, plane, law, phase: Cell::new(Phase::ByPosition) })
    }

    /// The number of the frame.
    pub fn frame(&self) -> usize {
        self.frame
    }

    /// The ground that it meets.
    pub fn plane(&self) -> &GroundPlane<S> {
        &self.plane
    }

    /// The law of the force.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// How far the frame is from touching, m: its height above the ground and the [`onset`](ContactLaw::onset) of the law.
    /// It falls through zero at the touch-down and rises through zero at the lift-off.
    pub fn gap(&self, state: &FrameState<S>) -> S {
        self.plane.height(&state.origin) + self.law.onset()
    }

    /// What the ground does to the frame in a state.
    pub fn reaction(&self, state: &FrameState<S>) -> Reaction<S> {
        let penetration = -self.plane.height(&state.origin);
        let touching = match self.phase.get() {
            Phase::ByPosition => self.gap(state) <= S::zero(),
            Phase::Open => false,
            Phase::Closed => true,
        };
        if !touching && penetration.is_finite() {
            return Reaction { penetration, ..Reaction::default() };
        }
        let [along, sliding @ ..] = self.plane.components(&state.velocity);
        let NormalForce { force: normal_force, energy, dissipated_power } = self.law.normal(penetration, -along);
        let friction = self.law.friction(normal_force, sliding);
        let [x, y] = friction;
        let [vx, vy] = sliding;
        Reaction {
            force: self.plane.vector([normal_force, x, y]),
            normal_force,
            penetration,
            touching,
            energy,
            dissipated_power: dissipated_power - (x * vx + y * vy),
        }
    }

    /// The gap while open, its negative while closed: positive until the state of contact changes.
    fn margin(&self, state: &FrameState<S>) -> S {
        match self.phase.get() {
            Phase::Closed => -self.gap(state),
            Phase::Open | Phase::ByPosition => self.gap(state),
        }
    }
}
