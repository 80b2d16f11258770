//! Why a loop could not be closed, or its dynamics not be solved.

mod named;
mod row_set;

use core::fmt;

use crate::LengthMismatch;

pub use named::NamedLoopError;
pub use row_set::RowSet;

/// What is wrong with a closed loop. Rows are counted from 0 in the order of `loop_residual`, coordinates in the
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
        /// The independent coordinate that moves farthest in the step that fails.
        coordinate: usize,
        /// The residual that remains, m (or a sine).
        position_residual: S,
    },
    /// A coordinate that is to be held, prescribed or actuated does not exist.
    CoordinateOutOfRange {
        /// The given number.
        coordinate: usize,
        /// How many coordinates there are.
        count: usize,
    },
    /// A coordinate is prescribed twice.
    RepeatedCoordinate {
        /// The number that is given again.
        coordinate: usize,
    },
    /// The trajectory or a gain does not have one component for each independent coordinate.
    WrongLength(LengthMismatch),
    /// A joint needs a force that neither its actuator nor the loops can give.
    Unactuated {
        /// The joint's coordinate.
        coordinate: usize,
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
        /// The coordinate of the first pivot that is not positive.
        coordinate: usize,
    },
    /// A position, a velocity, a force, or what the mechanism makes of them is infinite or not a number.
    NotFinite,
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

    /// The coordinate that the error is about.
    pub fn coordinate(&self) -> Option<usize> {
        match self {
            Self::Unreachable { coordinate, .. }
            | Self::CoordinateOutOfRange { coordinate, .. }
            | Self::RepeatedCoordinate { coordinate }
            | Self::Unactuated { coordinate, .. }
            | Self::SingularInertia { coordinate } => Some(*coordinate),
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
            Self::Unreachable { t, coordinate, position_residual } => write!(
                f,
                "the mechanism cannot follow its trajectory to t = {t:?} s: with coordinate {coordinate} moved on, \
                 a position residual of {position_residual:?} m remains; stay within the reach of the links, or ask \
                 for nearer instants"
            ),
            Self::CoordinateOutOfRange { coordinate, count } => {
                write!(f, "there is no coordinate {coordinate}; the mechanism's {count} coordinates are counted from 0")
            }
            Self::RepeatedCoordinate { coordinate } => {
                write!(f, "coordinate {coordinate} is prescribed twice; name each independent coordinate once")
            }
            Self::WrongLength(mismatch) => write!(f, "{mismatch}; give one for each independent coordinate"),
            Self::Unactuated { coordinate, force } => write!(
                f,
                "the joint of coordinate {coordinate} needs a force of {force:?} that neither its actuator nor the \
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
            Self::SingularInertia { coordinate } => write!(
                f,
                "the generalised inertia matrix is not positive definite at coordinate {coordinate}, and the \
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
