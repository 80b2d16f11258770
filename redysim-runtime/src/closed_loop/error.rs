//! Why a loop could not be closed, or its dynamics not be solved.

use core::fmt;

use super::Rows;

/// What is wrong with a closed loop. Rows are counted from 0 in the order of `loop_residual`, coordinates in the
/// model's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LoopError<S> {
    /// The start of a simulation leaves a loop open.
    Open {
        /// The largest component of the residual, m (or a sine).
        gap: S,
        /// Its row.
        row: usize,
    },
    /// The velocities pull a loop apart, or held velocities cannot be met.
    PullsApart {
        /// The largest component of J q̇, m/s (or 1/s).
        rate: S,
        /// Its row.
        row: usize,
    },
    /// No motion of the free coordinates makes the gap any smaller.
    CannotClose {
        /// The remaining gap, m (or a sine).
        gap: S,
        /// The row that is farthest open.
        row: usize,
    },
    /// The search still made progress when its iterations were used up, or a step of integration left a gap.
    NoConvergence {
        /// The smallest gap that was reached, m (or a sine).
        gap: S,
        /// The row that is farthest open.
        row: usize,
    },
    /// The independent coordinates do not determine the others.
    LostRank {
        /// How many coordinates the loops determine at this position.
        rank: usize,
        /// How many they must determine.
        needed: usize,
        /// The rows that say nothing new at this position; none if the loops have too few rows at any.
        rows: Rows,
    },
    /// The trajectory leaves what the mechanism can reach.
    Unreachable {
        /// The time, s.
        t: S,
        /// The independent coordinate that moves farthest in the step that fails.
        coordinate: usize,
        /// The gap that remains, m (or a sine).
        gap: S,
    },
    /// A coordinate that is to be held, prescribed or actuated does not exist.
    BadCoordinate {
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
    /// The trajectory has not one component for each independent coordinate.
    WrongTrajectory {
        /// How many components it has.
        given: usize,
        /// How many independent coordinates there are.
        wanted: usize,
    },
    /// A joint needs a force that neither its actuator nor the loops can give.
    Unsupported {
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
    BadAlpha {
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
            Self::Open { row, .. }
            | Self::PullsApart { row, .. }
            | Self::CannotClose { row, .. }
            | Self::NoConvergence { row, .. } => Some(*row),
            Self::LostRank { rows, .. } => rows.iter().next(),
            _ => None,
        }
    }

    /// The coordinate that the error is about.
    pub fn coordinate(&self) -> Option<usize> {
        match self {
            Self::Unreachable { coordinate, .. }
            | Self::BadCoordinate { coordinate, .. }
            | Self::RepeatedCoordinate { coordinate }
            | Self::Unsupported { coordinate, .. }
            | Self::SingularInertia { coordinate } => Some(*coordinate),
            _ => None,
        }
    }
}

impl<S: fmt::Debug> fmt::Display for LoopError<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open { gap, row } => write!(
                f,
                "the start leaves a loop open: row {row} of the loop residual is {gap:?} m; close it with `assemble`, \
                 which says how far the joints move"
            ),
            Self::PullsApart { rate, row } => write!(
                f,
                "the velocities pull a loop apart: row {row} of the loop residual changes by {rate:?} m/s; `assemble` \
                 finds the velocities that fit those that are held, so hold fewer, or others"
            ),
            Self::CannotClose { gap, row } => write!(
                f,
                "the loop cannot be closed from this guess: a gap of {gap:?} m remains in row {row} of the loop \
                 residual; check the lengths of the links and the points of the cut, hold fewer coordinates, or guess \
                 nearer, and not with the links in line"
            ),
            Self::NoConvergence { gap, row } => write!(
                f,
                "closing the loop did not converge: the smallest gap reached is {gap:?} m, in row {row} of the loop \
                 residual; begin nearer to a closed position, or take smaller steps"
            ),
            Self::LostRank { rank, needed, rows } => {
                write!(
                    f,
                    "the loops determine {rank} of the {needed} coordinates that are not prescribed; prescribe others, \
                     or keep away from this position"
                )?;
                if rows.is_empty() {
                    return Ok(());
                }
                write!(f, ", where these rows of the loop residual say nothing new: {rows}")
            }
            Self::Unreachable { t, coordinate, gap } => write!(
                f,
                "the mechanism cannot follow its trajectory to t = {t:?} s: with coordinate {coordinate} moved on, \
                 a gap of {gap:?} m remains; stay within the reach of the links, or ask for nearer instants"
            ),
            Self::BadCoordinate { coordinate, count } => {
                write!(f, "there is no coordinate {coordinate}; the mechanism's {count} coordinates are counted from 0")
            }
            Self::RepeatedCoordinate { coordinate } => {
                write!(f, "coordinate {coordinate} is prescribed twice; name each independent coordinate once")
            }
            Self::WrongTrajectory { given, wanted } => write!(
                f,
                "the trajectory has {given} components for {wanted} independent coordinates; give one for each, in \
                 positions, velocities and accelerations"
            ),
            Self::Unsupported { coordinate, force } => write!(
                f,
                "the joint of coordinate {coordinate} needs a force of {force:?} that neither its actuator nor the \
                 loops give; actuate it, or keep away from this singular position"
            ),
            Self::UnstableBaumgarte { alpha, step } => write!(
                f,
                "Baumgarte's stabilisation with alpha = {alpha:?} 1/s blows up with steps of {step:?} s: their product \
                 must stay below 1.3; take smaller steps (`max_step`), a smaller alpha, or the projection"
            ),
            Self::BadAlpha { alpha } => {
                write!(f, "Baumgarte's alpha must be positive and finite, but it is {alpha:?} 1/s")
            }
            Self::SingularInertia { coordinate } => write!(
                f,
                "the generalised inertia matrix is not positive definite at coordinate {coordinate}, and the loops do not \
                 determine how it moves; give the links that its joint moves a mass and an inertia"
            ),
            Self::NotFinite => f.write_str(
                "a position, a velocity or a force is infinite or not a number; look at the start and at the torque \
                 law, and, without the projection, for a singular position",
            ),
        }
    }
}

impl<S: fmt::Debug> core::error::Error for LoopError<S> {}
