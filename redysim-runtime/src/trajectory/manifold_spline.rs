//! Motion through positions of joints with orientations.

use core::fmt;
use core::marker::PhantomData;
use core::ops::Deref;

use super::chart;
use super::via_points::{Place, between, check_times, place, resting};
use super::{Motion, Trajectory, TrajectoryError, ViaPoints};
use crate::exponential::{orientations, set};
use crate::linear_algebra::zeros;
use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, Vector, VelocityCoordinates};

/// A motion through positions at given times, of any mechanism: [`ViaPoints`] for joints with orientations, too.
///
/// Between two points, orientations move on the tangent at the first: R(t) = Rₖ exp(φ(t)), where the rotation vector φ is
/// the polynomial of degree 5 that has the angular velocities and accelerations of both points, by the right Jacobian of
/// the exponential and its derivative. From a point it goes to the next the shorter way. Other coordinates move by
/// polynomials of their own, as those of [`ViaPoints`] do, to the same digit; among them the position of a free joint, so
/// that it goes straight through points on a line, however the link turns. Before the first point and after the last it
/// stands there. q(t) is twice continuously differentiable.
///
/// [`through`](Self::through) takes velocities and accelerations as they are. [`minimum_jerk`](Self::minimum_jerk) and
/// [`cubic`](Self::cubic) find them by unrolling: the rotation vectors φₖ between successive orientations are transported in
/// parallel to the tangent space of the first point and added, the spline of [`ViaPoints`] through these sums is computed, and
/// its velocities and accelerations are transported back. Parallel transport along φ rotates by −φ/2 in the axes of the link.
/// For rotations about one axis the result is the scalar spline of the angle. It does not depend on the base frame. For other
/// rotations, jerk and snap are discontinuous at the points. P. E. Jupp and J. T. Kent, *Fitting smooth paths to spherical data*,
/// Appl. Statist. 36 (1987); K. Hüper and F. Silva Leite, *On the geometry of rolling and interpolation curves on Sⁿ, SOₙ,
/// and Grassmann manifolds*, J. Dyn. Control Syst. 13 (2007).
///
/// Quaternions are scaled to length 1. A quaternion and its negative are the same orientation: each point takes that nearer
/// to the point before it.
///
/// ```
/// # #[allow(dead_code)]
/// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
/// # use mechanisms::Top;
/// use redysim_runtime::{ConfigurationSpace, ManifoldSpline, Trajectory};
///
/// let upright = Top.neutral();
/// let [left, right]: [[f64; 4]; 2] = [[1.5, 0.0, 0.3], [-1.5, 0.2, 0.0]].map(|way| Top.integrate(&upright, &way));
/// let nod = ManifoldSpline::minimum_jerk(&Top, [0.0, 1.0, 3.0], [upright, left, right])?;
/// assert_eq!(nod.at(1.0).q, left);
/// assert_eq!(nod.at(3.0).v, [0.0; 3]);
/// # Ok::<(), redysim_runtime::TrajectoryError<f64>>(())
/// ```
#[derive(Clone)]
pub struct ManifoldSpline<P, Q: Clone, V: Clone, T: Vector<S>, S> {
    mechanism: P,
    times: T,
    points: T::Of<Motion<Q, V>>,
    scalar: PhantomData<S>,
}

impl<S, M, P, T> ManifoldSpline<P, M::Coordinates, M::Velocities, T, S>
where
    S: Real,
    M: ConfigurationSpace<S>,
    P: Deref<Target = M>,
    T: Vector<S>,
{
    /// The motion that has the given coordinates, velocities and accelerations at the given times, s. `mechanism` is a
    /// reference `&M`, or a pointer that owns it, such as `Arc<M>`.
    ///
    /// # Errors
    /// [`TrajectoryError`], for fewer than two points, a point without a time, times that do not grow, vectors of another
    /// length than the mechanism needs, or a point to which no way leads, as to a quaternion of length zero.
    pub fn through(
        mechanism: P,
        times: T,
        points: T::Of<Motion<M::Coordinates, M::Velocities>>,
    ) -> Result<Self, TrajectoryError<S>> {
        check_times(&times, points.as_ref().len())?;
        let mut spline = Self { mechanism, times, points, scalar: PhantomData };
        spline.check_points()?;
        spline.choose_quaternions();
        Ok(spline)
    }

    /// The motion of small jerk from rest at the first point to rest at the last, through those between without a stop, as
    /// [`ViaPoints::minimum_jerk`].
    ///
    /// # Errors
    /// As [`through`](Self::through).
    pub fn minimum_jerk(mechanism: P, times: T, q: T::Of<M::Coordinates>) -> Result<Self, TrajectoryError<S>> {
        Self::resting_at(mechanism, times, &q)?.smoothed(ViaPoints::minimum_jerk)
    }

    /// The motion of small acceleration from rest at the first point to rest at the last, through those between without a
    /// stop, as [`ViaPoints::cubic`]: its acceleration is continuous between the ends, and jumps at both.
    ///
    /// # Errors
    /// As [`through`](Self::through).
    pub fn cubic(mechanism: P, times: T, q: T::Of<M::Coordinates>) -> Result<Self, TrajectoryError<S>> {
        Self::resting_at(mechanism, times, &q)?.smoothed(ViaPoints::cubic)
    }

    /// The times of the points, s.
    pub fn times(&self) -> &[S] {
        self.times.as_ref()
    }

    /// The first time and the last, s.
    pub fn span(&self) -> (S, S) {
        (entry(&self.times, 0), entry(&self.times, self.times.as_ref().len().saturating_sub(1)))
    }

    /// The motion that rests at each point.
    fn resting_at(mechanism: P, times: T, q: &T::Of<M::Coordinates>) -> Result<Self, TrajectoryError<S>> {
        let q = q.as_ref();
        check_times(&times, q.len())?;
        let (mut each, nv) = (q.iter(), mechanism.nv());
        let points = T::Of::<Motion<M::Coordinates, M::Velocities>>::from_fn(q.len(), |_| {
            each.next().map_or_else(|| resting(&mechanism.neutral(), nv), |q| resting(q, nv))
        });
        Self::through(mechanism, times, points)
    }

    /// The same points, with the velocities and accelerations of a spline through the unrolled points.
    fn smoothed(mut self, spline: Smoothing<S, M::Velocities, T>) -> Result<Self, TrajectoryError<S>> {
        let mechanism: &M = &self.mechanism;
        let unrolled = unrolled::<S, M, T>(mechanism, self.points.as_ref());
        let unrolled = unrolled.as_ref();
        let mut each = unrolled.iter();
        let flat = T::Of::<M::Velocities>::from_fn(unrolled.len(), |_| {
            each.next().map_or_else(|| zeros(mechanism.nv()), |point| point.coordinates.clone())
        });
        let flat = spline(self.times.clone(), flat)?;
        for ((point, flat), Unrolled { axes, .. }) in self.points.as_mut().iter_mut().zip(flat.points()).zip(unrolled) {
            let back = M::Velocities::from_fn(mechanism.nv(), |i| -entry(axes, i));
            let [v, a] = [&flat.v, &flat.a].map(|part| chart::in_axes_before(mechanism, &back, part));
            let about = Motion { q: chart::coordinates(mechanism, &point.q, &point.q), v, a };
            Motion { v: point.v, a: point.a, .. } = chart::motion(mechanism, &point.q, &about);
        }
        Ok(self)
    }

    /// Checks that the points are as long as the mechanism needs, and that a way leads from each to the next.
    fn check_points(&self) -> Result<(), TrajectoryError<S>> {
        let mechanism: &M = &self.mechanism;
        let mut before = None;
        for (point, Motion { q, v, a }) in self.points.as_ref().iter().enumerate() {
            LengthMismatch::check("q", q.as_ref(), mechanism.nq())
                .and_then(|()| LengthMismatch::check("v", v.as_ref(), mechanism.nv()))
                .and_then(|()| LengthMismatch::check("a", a.as_ref(), mechanism.nv()))
                .map_err(TrajectoryError::WrongLength)?;
            let way = chart::coordinates(mechanism, before.unwrap_or(q), q);
            if !way.as_ref().iter().all(|component| component.is_finite()) {
                return Err(TrajectoryError::NoWay { point });
            }
            before = Some(q);
        }
        Ok(())
    }

    /// Scales quaternions to length 1, and takes of each and its negative the one that is nearer to that of the point before.
    fn choose_quaternions(&mut self) {
        let mut before: Option<M::Coordinates> = None;
        for Motion { q, .. } in self.points.as_mut() {
            for (_, angular) in orientations(&*self.mechanism) {
                let kind = self.mechanism.coordinates_of_velocity(angular);
                let VelocityCoordinates::Quaternion(first) = kind else { continue };
                let product = |a: &M::Coordinates, b: &M::Coordinates| {
                    (first..first + 4).fold(S::zero(), |sum, i| sum + entry(a, i) * entry(b, i))
                };
                let square = product(q, q);
                // A quaternion of length 1 but for rounding stays as it is.
                let is_unit = (square - S::one()).abs() <= S::from_f64(16.0) * S::EPSILON;
                let length = if is_unit { S::one() } else { square.sqrt() };
                let is_opposite = before.as_ref().is_some_and(|before| product(before, q) < S::zero());
                let factor = if is_opposite { -length } else { length };
                (first..first + 4).for_each(|i| set(q, i, entry(q, i) / factor));
            }
            before = Some(q.clone());
        }
    }
}

/// Makes a spline through points at given times.
type Smoothing<S, V, T> = fn(T, <T as Vector<S>>::Of<V>) -> Result<ViaPoints<S, V, T>, TrajectoryError<S>>;

/// A point in the tangent space to which the motion is unrolled.
#[derive(Clone)]
struct Unrolled<V> {
    /// Its coordinates there.
    coordinates: V,
    /// The rotation vectors that parallel transport makes of its axes, in the axes of the first point.
    axes: V,
}

/// Lays the ways between `points` end to end.
fn unrolled<S: Real, M: ConfigurationSpace<S>, T: Vector<S>>(
    mechanism: &M,
    points: &[Motion<M::Coordinates, M::Velocities>],
) -> T::Of<Unrolled<M::Velocities>> {
    let (nv, first) = (mechanism.nv(), mechanism.neutral());
    let own = |i: usize| chart::own_coordinate(mechanism, i).is_some();
    let mut here = Unrolled { coordinates: zeros(nv), axes: zeros(nv) };
    let mut axes = first.clone();
    let (mut before, mut each) = (None, points.iter());
    T::Of::from_fn(points.len(), |_| {
        let Some(Motion { q, .. }) = each.next() else { return here.clone() };
        let way = chart::coordinates(mechanism, before.unwrap_or(q), q);
        before = Some(q);
        let carried = chart::in_axes_before(mechanism, &here.axes, &way);
        let half = M::Velocities::from_fn(nv, |i| if own(i) { S::zero() } else { S::from_f64(0.5) * entry(&way, i) });
        axes = mechanism.integrate(&axes, &half);
        let coordinates = M::Velocities::from_fn(nv, |i| {
            if own(i) { entry(&carried, i) } else { entry(&here.coordinates, i) + entry(&carried, i) }
        });
        here = Unrolled { coordinates, axes: mechanism.difference(&first, &axes) };
        here.clone()
    })
}

impl<S, M, P, T> Trajectory<S, M::Coordinates, M::Velocities> for ManifoldSpline<P, M::Coordinates, M::Velocities, T, S>
where
    S: Real,
    M: ConfigurationSpace<S>,
    P: Deref<Target = M>,
    T: Vector<S>,
{
    fn at(&self, t: S) -> Motion<M::Coordinates, M::Velocities> {
        let mechanism: &M = &self.mechanism;
        match place(self.times.as_ref(), self.points.as_ref(), t) {
            Some(Place::Rest(point)) => resting(&point.q, mechanism.nv()),
            Some(Place::Point(point)) => point.clone(),
            Some(Place::Between { from, to, h, s }) => {
                let [start, end] = [from, to].map(|point| chart::motion_about(mechanism, &from.q, point));
                chart::motion(mechanism, &from.q, &between(&start, &end, h, s))
            }
            // There are two points at least.
            None => resting(&mechanism.neutral(), mechanism.nv()),
        }
    }
}

impl<P, Q, V, T, S> fmt::Debug for ManifoldSpline<P, Q, V, T, S>
where
    P: fmt::Debug,
    Q: Clone + fmt::Debug,
    V: Clone + fmt::Debug,
    T: Vector<S> + fmt::Debug,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("ManifoldSpline");
        shown.field("mechanism", &self.mechanism).field("times", &self.times);
        shown.field("points", &self.points.as_ref()).finish()
    }
}
