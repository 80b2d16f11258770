//! Motion through points.

use core::fmt;
use core::marker::PhantomData;

use super::spline::{Smoothness, least_acceleration, least_jerk, smooth};
use super::{Motion, Trajectory, TrajectoryError};
use crate::linear_algebra::zeros;
use crate::vector::entry;
use crate::{Real, Vector};

/// A motion through points at given times.
///
/// Between two points every joint moves by the polynomial of degree 5 that has both points' coordinates, velocities and
/// accelerations. Before the first point and after the last it stands there.
///
/// [`minimum_jerk`](Self::minimum_jerk) and [`cubic`](Self::cubic) find velocities and accelerations themselves,
/// [`through`](Self::through) takes them as they are. For joints of one coordinate, whose velocity is its rate
/// (revolute, prismatic and helical ones); [`ManifoldSpline`](crate::ManifoldSpline) is for any. `T` holds the times, `[S; N]` or `Vec<S>`, one for each point.
///
/// ```
/// use redysim_runtime::{Trajectory, ViaPoints};
///
/// // Out in 1 s, past a point that is not the middle, and back in 2 s.
/// let there_and_back = ViaPoints::minimum_jerk([0.0, 1.0, 3.0], [[0.0], [0.7], [0.0]])?;
/// assert_eq!(there_and_back.at(1.0).q, [0.7]);
/// assert!(there_and_back.at(1.0).v[0] > 0.1);
/// assert_eq!(there_and_back.at(3.0).v, [0.0]);
/// # Ok::<(), redysim_runtime::TrajectoryError<f64>>(())
/// ```
#[derive(Clone)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Fields<T, T::Of<Motion<V, V>>>"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize, T::Of<Motion<V, V>>: serde::Serialize",
        deserialize = "S: Real, V: Vector<S>, T: serde::Deserialize<'de>, T::Of<Motion<V, V>>: serde::Deserialize<'de>"
    ))
)]
pub struct ViaPoints<S, V: Clone, T: Vector<S>> {
    times: T,
    points: T::Of<Motion<V, V>>,
    #[cfg_attr(feature = "serde", serde(skip))]
    scalar: PhantomData<S>,
}

/// The fields of [`ViaPoints`], which [`ViaPoints::through`] checks.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(rename = "ViaPoints")]
struct Fields<T, P> {
    times: T,
    points: P,
}

#[cfg(feature = "serde")]
impl<S: Real, V: Vector<S>, T: Vector<S>> TryFrom<Fields<T, T::Of<Motion<V, V>>>> for ViaPoints<S, V, T> {
    type Error = TrajectoryError<S>;

    fn try_from(Fields { times, points }: Fields<T, T::Of<Motion<V, V>>>) -> Result<Self, TrajectoryError<S>> {
        ViaPoints::through(times, points)
    }
}

impl<S: Real, V: Vector<S>, T: Vector<S>> ViaPoints<S, V, T> {
    /// The motion that has the given coordinates, velocities and accelerations at the given times, s.
    ///
    /// # Errors
    /// [`TrajectoryError`], for fewer than two points, a point without a time, points with different joints, or times
    /// that do not grow.
    pub fn through(times: T, points: T::Of<Motion<V, V>>) -> Result<Self, TrajectoryError<S>> {
        check(&times, points.as_ref())?;
        Ok(Self { times, points, scalar: PhantomData })
    }

    /// The motion of least jerk, ∫ q⃛² dt, from rest at the first point to rest at the last, through those between
    /// without a stop: its fourth derivative is continuous. Between two points alone it is
    /// q₀ + (q₁ − q₀)(10 s³ − 15 s⁴ + 6 s⁵) with s = (t − t₀)/(t₁ − t₀). T. Flash and N. Hogan, *The coordination of
    /// arm movements*, J. Neurosci. 5 (1985).
    ///
    /// # Errors
    /// As [`through`](Self::through).
    pub fn minimum_jerk(times: T, q: T::Of<V>) -> Result<Self, TrajectoryError<S>> {
        Self::smoothest(times, q, least_jerk)
    }

    /// The motion of least acceleration, ∫ q̈² dt, from rest at the first point to rest at the last, through those
    /// between without a stop: the clamped cubic spline. Its acceleration is continuous between the ends, and jumps at
    /// both.
    ///
    /// # Errors
    /// As [`through`](Self::through).
    pub fn cubic(times: T, q: T::Of<V>) -> Result<Self, TrajectoryError<S>> {
        let mut motion = Self::smoothest(times, q, least_acceleration)?;
        motion.accelerate_ends();
        Ok(motion)
    }

    fn smoothest(times: T, q: T::Of<V>, smoothness: Smoothness<S>) -> Result<Self, TrajectoryError<S>> {
        let coordinates = q.as_ref();
        check_times(&times, coordinates.len())?;
        let mut each = coordinates.iter();
        let mut points = T::Of::<Motion<V, V>>::from_fn(coordinates.len(), |_| {
            each.next().map_or_else(|| resting(&zeros(0), 0), |q| resting(q, q.as_ref().len()))
        });
        check(&times, points.as_ref())?;
        smooth::<S, V, T>(&times, &mut points, smoothness);
        Ok(Self { times, points, scalar: PhantomData })
    }

    /// Gives the ends the accelerations of the cubics that begin and end there.
    fn accelerate_ends(&mut self) {
        let last = self.points.as_ref().len().saturating_sub(1);
        for (end, neighbour) in [(0, 1), (last, last.saturating_sub(1))] {
            let h = entry(&self.times, neighbour) - entry(&self.times, end);
            let points = self.points.as_mut();
            let Some(of_neighbour) = points.get(neighbour).cloned() else { return };
            let Some(of_end) = points.get_mut(end) else { return };
            let c = S::from_f64;
            of_end.a = V::from_fn(of_end.q.as_ref().len(), |joint| {
                let way = entry(&of_neighbour.q, joint) - entry(&of_end.q, joint);
                let speeds = c(4.0) * entry(&of_end.v, joint) + c(2.0) * entry(&of_neighbour.v, joint);
                (c(6.0) * way / h - speeds) / h
            });
        }
    }

    /// The points, with their velocities and accelerations.
    pub(super) fn points(&self) -> &[Motion<V, V>] {
        self.points.as_ref()
    }

    /// The first time and the last, s.
    pub fn span(&self) -> (S, S) {
        (entry(&self.times, 0), entry(&self.times, self.times.as_ref().len() - 1))
    }
}

impl<S: Real, V: Vector<S>, T: Vector<S>> Trajectory<S, V, V> for ViaPoints<S, V, T> {
    fn at(&self, t: S) -> Motion<V, V> {
        match place(self.times.as_ref(), self.points.as_ref(), t) {
            Some(Place::Rest(point)) => resting(&point.q, point.v.as_ref().len()),
            Some(Place::Point(point)) => point.clone(),
            Some(Place::Between { from, to, h, s }) => between(from, to, h, s),
            // There are two points at least.
            None => resting(&zeros(0), 0),
        }
    }
}

/// Where a time is among those of points.
pub(super) enum Place<'p, S, P> {
    /// Before the first point or after the last, which is this.
    Rest(&'p P),
    /// At this point.
    Point(&'p P),
    /// Between two points, at the part `s` of the way, which takes the time `h`.
    Between { from: &'p P, to: &'p P, h: S, s: S },
}

/// Where `t` is among the `times` of `points`; between the first two, if it is not a number. `None` without two points.
pub(super) fn place<'p, S: Real, P>(times: &[S], points: &'p [P], t: S) -> Option<Place<'p, S, P>> {
    let right = times.partition_point(|&time| time <= t).max(1).min(times.len().saturating_sub(1));
    let left = right.saturating_sub(1);
    let (&start, &end) = (times.get(left)?, times.get(right)?);
    let (from, to) = (points.get(left)?, points.get(right)?);
    Some(if t < start {
        Place::Rest(from)
    } else if t > end {
        Place::Rest(to)
    } else if t == start {
        Place::Point(from)
    } else if t == end {
        Place::Point(to)
    } else {
        Place::Between { from, to, h: end - start, s: (t - start) / (end - start) }
    })
}

impl<S: fmt::Debug, V: Clone + fmt::Debug, T: Vector<S> + fmt::Debug> fmt::Debug for ViaPoints<S, V, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ViaPoints").field("times", &self.times).field("points", &self.points.as_ref()).finish()
    }
}

/// The polynomial of degree 5 between two points, `h` apart in time, at the part `s` of the way.
pub(super) fn between<S: Real, V: Vector<S>>(from: &Motion<V, V>, to: &Motion<V, V>, h: S, s: S) -> Motion<V, V> {
    let c = S::from_f64;
    // Coefficients of s⁰ to s⁵: the first three from the start, the others from what these miss at the end.
    let coefficients = |joint| {
        let at = |motion: &Motion<V, V>| {
            [entry(&motion.q, joint), entry(&motion.v, joint) * h, entry(&motion.a, joint) * h * h]
        };
        let ([q, v, a], [q_end, v_end, a_end]) = (at(from), at(to));
        let half = c(0.5) * a;
        let [way, speed, push] = [q_end - q - v - half, v_end - v - a, c(0.5) * (a_end - a)];
        let third = c(10.0) * way - c(4.0) * speed + push;
        let fourth = c(-15.0) * way + c(7.0) * speed - c(2.0) * push;
        let fifth = c(6.0) * way - c(3.0) * speed + push;
        [q, v, half, third, fourth, fifth]
    };
    // The derivative `order` of the polynomial, by Horner's rule.
    let derivative = |order: usize, joint: usize| {
        let coefficients = coefficients(joint);
        (order..6).rev().fold(S::zero(), |sum, power| {
            let factor = (0..order).map(|down| (power - down) as f64).product::<f64>();
            sum * s + c(factor) * entry(&coefficients, power)
        })
    };
    let len = from.q.as_ref().len();
    Motion {
        q: V::from_fn(len, |joint| derivative(0, joint)),
        v: V::from_fn(len, |joint| derivative(1, joint) / h),
        a: V::from_fn(len, |joint| derivative(2, joint) / (h * h)),
    }
}

/// Rest at `q`, with `nv` velocities.
pub(super) fn resting<S: Real, Q: Clone, V: Vector<S>>(q: &Q, nv: usize) -> Motion<Q, V> {
    let zero = V::from_fn(nv, |_| S::zero());
    Motion { q: q.clone(), v: zero.clone(), a: zero }
}

fn check<S: Real, V: Vector<S>, T: Vector<S>>(times: &T, points: &[Motion<V, V>]) -> Result<(), TrajectoryError<S>> {
    check_times(times, points.len())?;
    let joints = points.first().map_or(0, |point| point.q.as_ref().len());
    let lengths = points.iter().flat_map(|point| [&point.q, &point.v, &point.a]).map(|part| part.as_ref().len());
    if let Some(to) = lengths.into_iter().find(|&length| length != joints) {
        return Err(TrajectoryError::DifferentLengths { from: joints, to });
    }
    Ok(())
}

/// Checks that there are at least two points, and a time for each, later than that before it.
pub(super) fn check_times<S: Real, T: Vector<S>>(times: &T, points: usize) -> Result<(), TrajectoryError<S>> {
    let times = times.as_ref();
    if times.len() != points {
        return Err(TrajectoryError::DifferentCounts { times: times.len(), points });
    }
    if points < 2 {
        return Err(TrajectoryError::TooFewPoints { given: points });
    }
    for (k, pair) in times.windows(2).enumerate() {
        let &[previous, t] = pair else { continue };
        if !(t > previous && (t - previous).is_finite()) {
            return Err(TrajectoryError::TimesOutOfOrder { point: k + 1, previous, t });
        }
    }
    Ok(())
}
