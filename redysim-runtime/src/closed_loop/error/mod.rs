//! Why a loop could not be closed, or its dynamics not be solved.

mod named;

use core::fmt;

use crate::linear_algebra::{NotFinite, NotPositiveDefinite};
use crate::{LengthMismatch, RowSet};

pub use named::NamedLoopError;

/// What is wrong with a closed loop. Rows are counted from 0 in the order of `loop_residual`, velocities in the
/// model's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LoopError<S> {
    /// The start of a simulation leaves a loop open.
    NotClosed {
        /// The largest component of the residual, m (or a sine).
        position_residual: S,
        /// Its row.
        row: usize,
    },
    /// The velocities violate the constraints, or prescribed velocities or accelerations cannot be met.
    InconsistentVelocity {
        /// The largest component of J q̇, m/s (or 1/s); of accelerations, that of J q̈ + J̇ q̇, m/s² (or 1/s²).
        residual: S,
        /// Its row.
        row: usize,
    },
    /// No motion of the free coordinates makes the position residual any smaller.
    CannotClose {
        /// The remaining residual, m (or a sine).
        position_residual: S,
        /// Its row.
        row: usize,
    },
    /// The search still made progress when its iterations were used up, or a step of integration left loops open.
    NoConvergence {
        /// The smallest residual that was reached, m (or a sine).
        position_residual: S,
        /// Its row.
        row: usize,
    },
    /// The independent coordinates do not determine the others.
    RankDeficient {
        /// How many coordinates the loops determine at this position.
        rank: usize,
        /// How many they must determine.
        needed: usize,
        /// The rows that depend on the others at this position; none if the loops have too few rows at any.
        rows: RowSet,
    },
    /// The trajectory leaves what the mechanism can reach.
    Unreachable {
        /// The time, s.
        t: S,
        /// The independent velocity whose coordinate moves farthest in the step that fails.
        velocity: usize,
        /// The residual that remains, m (or a sine).
        position_residual: S,
    },
    /// A velocity that is to be held, prescribed or actuated does not exist.
    VelocityOutOfRange {
        /// The given number.
        velocity: usize,
        /// How many velocities there are.
        count: usize,
    },
    /// A velocity is prescribed twice.
    RepeatedVelocity {
        /// The number that is given again.
        velocity: usize,
    },
    /// A velocity is prescribed, but not all others that its coordinates depend on: the three angular velocities of an
    /// orientation, and for the linear velocities of a free joint, which are in the axes of its link, all six.
    PartOfJoint {
        /// The velocity.
        velocity: usize,
        /// A velocity of the same joint that is not prescribed.
        missing: usize,
    },
    /// A velocity is prescribed whose joint has several coordinates of an unknown kind
    /// ([`Mechanism::coordinates_of_velocity`](crate::Mechanism::coordinates_of_velocity)).
    NoCoordinate {
        /// The velocity.
        velocity: usize,
    },
    /// The trajectory or a gain does not have one element for each independent coordinate or velocity.
    WrongLength(LengthMismatch),
    /// A joint needs a force that neither its actuator nor the loops can give.
    Unactuated {
        /// The joint's velocity.
        velocity: usize,
        /// The force that is missing, N m or N.
        force: S,
    },
    /// Baumgarte's stabilisation with steps that make it unstable.
    UnstableBaumgarte {
        /// The rate α of the stabilisation, 1/s.
        alpha: S,
        /// The size h of the step, s.
        step: S,
    },
    /// Baumgarte's rate α is zero, negative, infinite or not a number.
    InvalidAlpha {
        /// The given rate, 1/s.
        alpha: S,
    },
    /// The generalised inertia matrix is not positive definite on the velocities that the loops leave free.
    SingularInertia {
        /// The velocity of the first pivot that is not positive.
        velocity: usize,
    },
    /// A position, a velocity, a force, or what the mechanism makes of them is infinite or not a number.
    NotFinite,
}

impl<S> From<NotPositiveDefinite> for LoopError<S> {
    fn from(NotPositiveDefinite { velocity }: NotPositiveDefinite) -> Self {
        Self::SingularInertia { velocity }
    }
}

impl<S> From<NotFinite> for LoopError<S> {
    fn from(_: NotFinite) -> Self {
        Self::NotFinite
    }
}

impl<S> LoopError<S> {
    /// The row of the loop residual that the error is about.
    pub fn row(&self) -> Option<usize> {
        match self {
            Self::NotClosed { row, .. }
            | Self::InconsistentVelocity { row, .. }
            | Self::CannotClose { row, .. }
            | Self::NoConvergence { row, .. } => Some(*row),
            Self::RankDeficient { rows, .. } => rows.iter().next(),
            _ => None,
        }
    }

    /// The velocity that the error is about.
    pub fn velocity(&self) -> Option<usize> {
        match self {
            Self::Unreachable { velocity, .. }
            | Self::VelocityOutOfRange { velocity, .. }
            | Self::RepeatedVelocity { velocity }
            | Self::PartOfJoint { velocity, .. }
            | Self::NoCoordinate { velocity }
            | Self::Unactuated { velocity, .. }
            | Self::SingularInertia { velocity } => Some(*velocity),
            _ => None,
        }
    }
}

impl<S: fmt::Debug> fmt::Display for LoopError<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotClosed { position_residual, row } => write!(
                f,
                "the start leaves a loop open: row {row} of the loop residual is {position_residual:?} m; close it \
                 with `assemble`, which reports how far the joints move"
            ),
            Self::InconsistentVelocity { residual, row } => write!(
                f,
                "the velocities violate the constraints: row {row} of the loop residual changes by {residual:?} m/s; \
                 `assemble` finds the velocities that fit those that are held, so hold fewer, or others"
            ),
            Self::CannotClose { position_residual, row } => write!(
                f,
                "the loop cannot be closed from this guess: a position residual of {position_residual:?} m remains in \
                 row {row} of the loop residual; check the lengths of the links and the points of the cut, hold fewer \
                 coordinates, or guess nearer, and not with the links in line"
            ),
            Self::NoConvergence { position_residual, row } => write!(
                f,
                "closing the loop did not converge: the smallest position residual reached is {position_residual:?} \
                 m, in row {row} of the loop residual; begin nearer to a closed position, or take smaller steps"
            ),
            Self::RankDeficient { rank, needed, rows } => {
                write!(
                    f,
                    "the loops determine {rank} of the {needed} coordinates that are not prescribed; prescribe others, \
                     or keep away from this position"
                )?;
                if rows.is_empty() {
                    return Ok(());
                }
                write!(f, ", where these rows of the loop residual depend on the others: {rows}")
            }
            Self::Unreachable { t, velocity, position_residual } => write!(
                f,
                "the mechanism cannot follow its trajectory to t = {t:?} s: with the coordinate of velocity \
                 {velocity} moved on, a position residual of {position_residual:?} m remains; stay within the reach of \
                 the links, or ask for nearer instants"
            ),
            Self::VelocityOutOfRange { velocity, count } => {
                write!(f, "velocity {velocity} does not exist; the mechanism's {count} velocities are counted from 0")
            }
            Self::RepeatedVelocity { velocity } => {
                write!(f, "velocity {velocity} is prescribed twice; name each independent velocity once")
            }
            Self::PartOfJoint { velocity, missing } => write!(
                f,
                "velocity {velocity} is prescribed without velocity {missing} of the same joint; prescribe the three \
                 angular velocities of an orientation together, and the linear velocities of a free joint only with them"
            ),
            Self::NoCoordinate { velocity } => write!(
                f,
                "velocity {velocity} cannot be prescribed by a trajectory: its joint has several coordinates that are \
                 not a position or a quaternion; prescribe velocities of other joints"
            ),
            Self::WrongLength(mismatch) => write!(
                f,
                "{mismatch}; give one for each coordinate of the independent joints in `trajectory.q`, and one for each \
                 independent velocity elsewhere"
            ),
            Self::Unactuated { velocity, force } => write!(
                f,
                "the joint of velocity {velocity} needs a force of {force:?} that neither its actuator nor the \
                 loops give; actuate it, or keep away from this singular position"
            ),
            Self::UnstableBaumgarte { alpha, step } => write!(
                f,
                "Baumgarte's stabilisation with alpha = {alpha:?} 1/s blows up with steps of {step:?} s: their product \
                 must stay below 1.3; take smaller steps (`max_step`), a smaller alpha, or the projection"
            ),
            Self::InvalidAlpha { alpha } => {
                write!(f, "Baumgarte's alpha must be positive and finite, but it is {alpha:?} 1/s")
            }
            Self::SingularInertia { velocity } => write!(
                f,
                "the generalised inertia matrix is not positive definite at velocity {velocity}, and the \
                 loops do not determine how it moves; give the links that its joint moves a mass and an inertia"
            ),
            Self::NotFinite => f.write_str(
                "a position, a velocity or a force is infinite or not a number; look at the start and at the torque \
                 law, and, without the projection, for a singular position",
            ),
        }
    }
}

impl<S: fmt::Debug> core::error::Error for LoopError<S> {}
