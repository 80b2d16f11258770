//! Motion given on the tangent at a position.

use core::ops::Deref;

use super::{Motion, Trajectory, TrajectoryError};
use crate::exponential::{mapped, right_jacobian};
use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, Vector};

/// A trajectory given on the tangent at a position: q(t) = q₀ ⊞ w(t), with the mechanism's
/// [`integrate`](ConfigurationSpace::integrate).
///
/// Its velocities are v = J(w) ẇ, and its accelerations v̇. Of joints of one coordinate, J is 1; of an orientation, w is the
/// rotation vector in the axes at q₀ and J the right Jacobian of the exponential of SO(3), with a position that of SE(3).
/// Coordinates of [another kind](crate::VelocityCoordinates::Unknown) count as those of joints of one velocity.
///
/// Along a [`ConstantDirection`] every joint moves along a constant screw, an orientation about a fixed axis: with
/// [`along_screw`](Self::along_screw) from one position to another the shorter way.
///
/// ```
/// # #[allow(dead_code)]
/// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
/// # use mechanisms::Top;
/// use redysim_runtime::{ConfigurationSpace, Cycloid, TangentTrajectory, Trajectory};
///
/// // From rest to rest by 2 rad about the axis (1, 2, 2)/3.
/// let (upright, axis) = (Top.neutral(), [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0]);
/// let tilted: [f64; 4] = Top.integrate(&upright, &axis.map(|a| 2.0 * a));
/// let law = Cycloid::new([0.0], [1.0], 4.0)?;
/// let turn = TangentTrajectory::along_screw(&Top, upright, &tilted, law)?;
/// let half: [f64; 3] = turn.at(2.0).v;
/// assert!((0..3).all(|i| (half[i] - axis[i]).abs() < 1e-14), "1 rad/s half way");
/// # Ok::<(), redysim_runtime::TrajectoryError<f64>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentTrajectory<P, Q, T> {
    /// The mechanism: a reference `&M`, or a pointer that owns it, such as `Arc<M>`.
    pub mechanism: P,
    /// q₀.
    pub from: Q,
    /// w(t): displacements over velocities, with their first and second derivatives.
    pub way: T,
}

/// A straight way on the tangent: w(t) = s(t) `way`.
///
/// The time law s is a trajectory of one coordinate, such as a [`Cycloid`](crate::Cycloid) from 0 to 1, or a
/// [`ViaPoints`](crate::ViaPoints).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstantDirection<V, L> {
    /// The displacement at s = 1; an angle may be of any number of turns.
    pub way: V,
    /// s(t).
    pub law: L,
}

impl<S: Real, V: Vector<S>, L: Trajectory<S, [S; 1], [S; 1]>> Trajectory<S, V, V> for ConstantDirection<V, L> {
    fn at(&self, t: S) -> Motion<V, V> {
        let Motion { q: [s], v: [ds], a: [dds] } = self.law.at(t);
        let scaled = |factor: S| V::from_fn(self.way.as_ref().len(), |i| entry(&self.way, i) * factor);
        Motion { q: scaled(s), v: scaled(ds), a: scaled(dds) }
    }
}

impl<P, Q, V, L> TangentTrajectory<P, Q, ConstantDirection<V, L>> {
    /// The motion along the constant screw that leads from `from` to `to`: q(t) = `from` ⊞ s(t) (`to` ⊟ `from`) with the
    /// time law s(t), from 0 to 1.
    ///
    /// # Errors
    /// [`TrajectoryError`], if a position has another length than the mechanism needs, or no way leads from one to the
    /// other, as from a quaternion of length zero: `from` is point 0, `to` point 1.
    pub fn along_screw<S, M>(mechanism: P, from: Q, to: &Q, law: L) -> Result<Self, TrajectoryError<S>>
    where
        S: Real,
        M: ConfigurationSpace<S, Coordinates = Q, Velocities = V>,
        P: Deref<Target = M>,
        Q: Vector<S>,
        V: Vector<S>,
        L: Trajectory<S, [S; 1], [S; 1]>,
    {
        for (name, q) in [("from", &from), ("to", to)] {
            LengthMismatch::check(name, q.as_ref(), mechanism.nq()).map_err(TrajectoryError::WrongLength)?;
        }
        let ways = [mechanism.difference(&from, &from), mechanism.difference(&from, to)];
        let is_way = |way: &V| way.as_ref().iter().all(|component| component.is_finite());
        if let Some(point) = ways.iter().position(|way| !is_way(way)) {
            return Err(TrajectoryError::NoWay { point });
        }
        let [_, way] = ways;
        Ok(TangentTrajectory { mechanism, from, way: ConstantDirection { way, law } })
    }
}

impl<S, M, P, T> Trajectory<S, M::Coordinates, M::Velocities> for TangentTrajectory<P, M::Coordinates, T>
where
    S: Real,
    M: ConfigurationSpace<S>,
    P: Deref<Target = M>,
    T: Trajectory<S, M::Velocities, M::Velocities>,
{
    fn at(&self, t: S) -> Motion<M::Coordinates, M::Velocities> {
        let mechanism: &M = &self.mechanism;
        let way = self.way.at(t);
        let (v, a) = mapped(mechanism, right_jacobian, (&way.q, &way.v), (&way.v, &way.a));
        Motion { q: mechanism.integrate(&self.from, &way.q), v, a }
    }
}
