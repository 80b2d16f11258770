//! Motions prescribed in advance: coordinates, velocities and accelerations as functions of time.

use core::f64::consts::TAU;
use core::fmt;

use crate::vector::entry;
use crate::{Real, Vector};

/// A motion at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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

/// The cycloidal motion of ReDySim from rest to rest, every joint by
///
/// θ(t) = θ₀ + (θ₁ − θ₀)/T · (t − T/(2π) sin(2πt/T)), 0 ≤ t ≤ T,
///
/// with vanishing velocity and acceleration at both ends, and rest before and after. For joints whose velocities are
/// the rates of their coordinates (revolute and prismatic ones). Source: eq. (1) of S. V. Shah, P. V. Nandihal and S.
/// K. Saha, *Recursive dynamics simulator (ReDySim)*, Theor. Appl. Mech. Lett. 2, 063011 (2012).
///
/// ```
/// use redysim_runtime::{Cycloid, Trajectory};
///
/// let lift = Cycloid::new([0.0, 1.0], [1.0, 1.0], 2.0)?;
/// let half = lift.at(1.0);
/// assert!((half.q[0] - 0.5_f64).abs() < 1e-15 && (half.v[0] - 1.0).abs() < 1e-15);
/// assert_eq!(lift.at(7.0).q, [1.0, 1.0]);
/// # Ok::<(), redysim_runtime::TrajectoryError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cycloid<S, V> {
    from: V,
    to: V,
    duration: S,
}

impl<S: Real, V: Vector<S>> Cycloid<S, V> {
    /// The motion that leaves `from` at time 0 and reaches `to` at time `duration` > 0, s.
    ///
    /// # Errors
    /// [`TrajectoryError`], for a duration that is not positive and finite, or ends of different length.
    pub fn new(from: V, to: V, duration: S) -> Result<Self, TrajectoryError<S>> {
        // Of a duration too small, the rate 2π/T is infinite.
        if !(duration > S::zero() && duration.is_finite() && (S::from_f64(TAU) / duration).is_finite()) {
            return Err(TrajectoryError::BadDuration { duration });
        }
        let (from_len, to_len) = (from.as_ref().len(), to.as_ref().len());
        if from_len != to_len {
            return Err(TrajectoryError::DifferentLengths { from: from_len, to: to_len });
        }
        Ok(Self { from, to, duration })
    }
}

impl<S: Real, V: Vector<S>> Trajectory<S, V, V> for Cycloid<S, V> {
    fn at(&self, t: S) -> Motion<V, V> {
        let len = self.from.as_ref().len();
        let rest = |q: &V| {
            let zero = V::from_fn(len, |_| S::zero());
            Motion { q: q.clone(), v: zero.clone(), a: zero }
        };
        if t <= S::zero() {
            return rest(&self.from);
        }
        if t >= self.duration {
            return rest(&self.to);
        }
        let rate = S::from_f64(TAU) / self.duration;
        let (sin, cos) = (rate * t).sin_cos();
        // Every joint travels the same fraction of its way.
        let s = t / self.duration - sin / S::from_f64(TAU);
        let (ds, dds) = ((S::one() - cos) / self.duration, rate * sin / self.duration);
        let way = |i| entry(&self.to, i) - entry(&self.from, i);
        Motion {
            q: V::from_fn(len, |i| entry(&self.from, i) + way(i) * s),
            v: V::from_fn(len, |i| way(i) * ds),
            a: V::from_fn(len, |i| way(i) * dds),
        }
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
        }
    }
}

impl<S: fmt::Debug> core::error::Error for TrajectoryError<S> {}
