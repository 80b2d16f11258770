//! From rest to rest along a cycloid.

use core::f64::consts::TAU;

use super::{Motion, Trajectory, TrajectoryError};
use crate::vector::entry;
use crate::{Real, Vector};

/// The cycloidal motion of ReDySim from rest to rest.
///
/// Every joint moves by
///
/// θ(t) = θ₀ + (θ₁ − θ₀)/T · (t − T/(2π) sin(2πt/T)), 0 ≤ t ≤ T,
///
/// with vanishing velocity and acceleration at both ends, and rest before and after. It is for joints of one
/// coordinate, whose velocity is its rate (revolute, prismatic and helical ones);
/// [`TangentTrajectory::along_screw`](crate::TangentTrajectory::along_screw) takes one as the time law of any joints. Source: eq. (1) of S. V. Shah, P. V.
/// Nandihal and S. K. Saha, *Recursive dynamics simulator (ReDySim)*, Theor. Appl. Mech. Lett. 2, 063011 (2012).
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
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Fields<S, V>"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(deserialize = "S: Real + serde::Deserialize<'de>, V: Vector<S> + serde::Deserialize<'de>"))
)]
pub struct Cycloid<S, V> {
    from: V,
    to: V,
    duration: S,
}

/// The fields of a [`Cycloid`], which [`Cycloid::new`] checks.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "Cycloid")]
struct Fields<S, V> {
    from: V,
    to: V,
    duration: S,
}

#[cfg(feature = "serde")]
impl<S: Real, V: Vector<S>> TryFrom<Fields<S, V>> for Cycloid<S, V> {
    type Error = TrajectoryError<S>;

    fn try_from(Fields { from, to, duration }: Fields<S, V>) -> Result<Self, TrajectoryError<S>> {
        Cycloid::new(from, to, duration)
    }
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

    /// The times at which the motion begins and ends, s: 0 and its duration.
    pub fn span(&self) -> (S, S) {
        (S::zero(), self.duration)
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
