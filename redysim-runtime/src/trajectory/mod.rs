//! Motions prescribed in advance: coordinates, velocities and accelerations as functions of time.
//!
//! | trajectory | of | q(t) |
//! |---|---|---|
//! | [`SetPoint`] | any joints | rest |
//! | [`Cycloid`] | joints of one coordinate | from rest to rest |
//! | [`ViaPoints`] | joints of one coordinate | through points: of least jerk, cubic, or with given velocities |
//! | [`TangentTrajectory`] | any joints | q₀ ⊞ w(t): along a [constant screw](ConstantDirection) by any time law, or any way |
//! | [`ManifoldSpline`] | any joints | through points, as [`ViaPoints`] |

mod chart;
mod cycloid;
mod manifold_spline;
mod set_point;
mod spline;
mod tangent;
mod via_points;

use core::fmt;

use crate::LengthMismatch;

pub use cycloid::Cycloid;
pub use manifold_spline::ManifoldSpline;
pub use set_point::SetPoint;
pub use tangent::{ConstantDirection, TangentTrajectory};
pub use via_points::ViaPoints;

/// A motion at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Motion<Q, V> {
    /// Joint coordinates, rad or m.
    pub q: Q,
    /// Joint velocities, rad/s or m/s.
    pub v: V,
    /// Joint accelerations, rad/s² or m/s².
    pub a: V,
}

/// A motion prescribed for every time. Every closure `Fn(S) -> Motion<Q, V>` is one.
pub trait Trajectory<S, Q, V> {
    /// The motion at time `t`, s.
    fn at(&self, t: S) -> Motion<Q, V>;
}

impl<S, Q, V, F: Fn(S) -> Motion<Q, V>> Trajectory<S, Q, V> for F {
    fn at(&self, t: S) -> Motion<Q, V> {
        self(t)
    }
}

/// Why a trajectory cannot be.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum TrajectoryError<S> {
    /// The duration is zero, negative, infinite or not a number.
    BadDuration {
        /// The given duration, s.
        duration: S,
    },
    /// Start and end have different numbers of joints.
    DifferentLengths {
        /// Joints at the start.
        from: usize,
        /// Joints at the end.
        to: usize,
    },
    /// A motion through points has fewer than two.
    TooFewPoints {
        /// How many points were given.
        given: usize,
    },
    /// There is not one time for each point.
    DifferentCounts {
        /// How many times were given.
        times: usize,
        /// How many points were given.
        points: usize,
    },
    /// A point of a motion does not come later than the one before it, or has a time that is not finite.
    TimesOutOfOrder {
        /// The point's number, counted from 0.
        point: usize,
        /// The time before it, s.
        previous: S,
        /// Its time, s.
        t: S,
    },
    /// A vector has another length than the mechanism needs.
    WrongLength(LengthMismatch),
    /// No way leads to a point: a coordinate is not finite, or a quaternion zero.
    NoWay {
        /// The point's number, counted from 0.
        point: usize,
    },
}

impl<S: fmt::Debug> fmt::Display for TrajectoryError<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadDuration { duration } => {
                write!(f, "the duration of a motion must be positive and finite, but it is {duration:?} s")
            }
            Self::DifferentLengths { from, to } => write!(
                f,
                "a motion must start and end with the same joints, but {from} joints start and {to} end; give one \
                 coordinate for each joint to both"
            ),
            Self::TooFewPoints { given } => {
                write!(f, "a motion goes through at least two points, its start and its end, but {given} were given")
            }
            Self::DifferentCounts { times, points } => {
                write!(f, "every point of a motion has one time, but {points} points came with {times} times")
            }
            Self::TimesOutOfOrder { point, previous, t } => write!(
                f,
                "the points of a motion must follow each other in time, but point {point} (counted from 0) is at \
                 t = {t:?} s and the one before it at {previous:?} s; sort them, and drop the one that is there twice"
            ),
            Self::WrongLength(mismatch) => {
                write!(f, "the vectors of a motion must have the lengths of those of its mechanism: {mismatch}")
            }
            Self::NoWay { point } => write!(
                f,
                "no way leads to point {point} (counted from 0) of a motion: its coordinates must be finite, and its \
                 quaternions not zero"
            ),
        }
    }
}

impl<S: fmt::Debug> core::error::Error for TrajectoryError<S> {}
