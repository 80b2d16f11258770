//! Torque laws: what the actuators do.
//!
//! The given laws treat each joint by itself, with one gain for each velocity. [`ComputedTorque`] takes position errors
//! from the mechanism's `difference`; the others subtract coordinates from coordinates, and are for joints of one
//! coordinate (revolute, prismatic and helical ones). Torques are N m (N for a prismatic joint), proportional gains
//! N m/rad (N/m) and derivative gains N m s/rad (N s/m) by default. One gain for all joints is written
//! `[50.0; Kr5::NV]`, or for any mechanism [`uniform`]. A simulation does not begin with gains or targets of wrong
//! length, nor with a law that the mechanism has too many coordinates for ([`TorqueLaw::check_lengths`]).

use crate::vector::entry;
use crate::{ConfigurationSpace, InverseDynamics, LengthMismatch, Mechanism, Motion, Real, Scalar, Trajectory, Vector};

/// What the actuators do. Every closure `FnMut(S, &Coordinates, &Velocities) -> Velocities` is one.
///
/// Integrators ask at points of their own choice, also at points of steps that they then reject: a law that remembers
/// should remember by time, not by call.
pub trait TorqueLaw<S: Scalar, M: ConfigurationSpace<S>> {
    /// The joint forces at time `t` (s) for coordinates `q` and velocities `v`.
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities;

    /// Checks, before a simulation of `mechanism` begins at the time `t`, that the vectors of the law have the lengths
    /// that it needs. Arrays always have. By default, nothing is checked.
    ///
    /// # Errors
    /// The first vector that has another length.
    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        let _ = (t, mechanism);
        Ok(())
    }

    /// The derivative of the joint forces along `(dq, dv)`, (∂τ/∂q) dq + (∂τ/∂v) dv, for the Jacobians of implicit
    /// integrators. `None`, the default, leaves it to differences of [`torque`](Self::torque).
    fn torque_tangent(
        &mut self,
        t: S,
        at: (&M::Coordinates, &M::Velocities),
        slopes: (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        let _ = (t, at, slopes);
        None
    }
}

impl<S, M, F> TorqueLaw<S, M> for F
where
    S: Scalar,
    M: ConfigurationSpace<S>,
    F: FnMut(S, &M::Coordinates, &M::Velocities) -> M::Velocities,
{
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        self(t, q, v)
    }
}

/// The same gain, or whatever else belongs to a joint, for all joints of a mechanism.
pub fn uniform<S: Scalar, M: ConfigurationSpace<S>>(mechanism: &M, gain: S) -> M::Velocities {
    M::Velocities::from_fn(mechanism.nv(), |_| gain)
}

/// No torque at all: τ = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZeroTorque;

impl<S: Scalar, M: ConfigurationSpace<S>> TorqueLaw<S, M> for ZeroTorque {
    fn torque(&mut self, _t: S, _q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |_| S::zero())
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (_, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(M::Velocities::from_fn(dv.as_ref().len(), |_| S::zero()))
    }
}

/// A spring to a set point: τ = Kp (q_d − q).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proportional<Q, V> {
    /// The set point q_d.
    pub target: Q,
    /// Kp, one for each velocity.
    pub kp: V,
}

impl<S: Real, M: ConfigurationSpace<S>> TorqueLaw<S, M> for Proportional<M::Coordinates, M::Velocities> {
    fn torque(&mut self, _t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |i| entry(&self.kp, i) * (entry(&self.target, i) - entry(q, i)))
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_coordinates(mechanism, "target", &self.target)?;
        LengthMismatch::check("kp", self.kp.as_ref(), mechanism.nv())
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(M::Velocities::from_fn(dv.as_ref().len(), |i| -entry(&self.kp, i) * entry(dq, i)))
    }
}

/// A spring and a damper to a set point: τ = Kp (q_d − q) − Kd q̇.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProportionalDerivative<Q, V> {
    /// The set point q_d.
    pub target: Q,
    /// Kp, one for each velocity.
    pub kp: V,
    /// Kd, one for each velocity.
    pub kd: V,
}

impl<S: Real, M: ConfigurationSpace<S>> TorqueLaw<S, M> for ProportionalDerivative<M::Coordinates, M::Velocities> {
    fn torque(&mut self, _t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * (entry(&self.target, i) - entry(q, i)) - entry(&self.kd, i) * entry(v, i)
        })
    }

    fn check_lengths(&self, _t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_coordinates(mechanism, "target", &self.target)?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring_and_damper(&self.kp, &self.kd, dq, dv))
    }
}

/// Checks that there is a gain Kp and a gain Kd for each velocity.
fn check_gains<S: Scalar, V: Vector<S>>(mechanism: &impl Mechanism, kp: &V, kd: &V) -> Result<(), LengthMismatch> {
    LengthMismatch::check("kp", kp.as_ref(), mechanism.nv())?;
    LengthMismatch::check("kd", kd.as_ref(), mechanism.nv())
}

/// Checks that there is a coordinate for each velocity and that a vector has an element for each.
fn check_coordinates<S: Scalar, Q: Vector<S>>(
    mechanism: &impl Mechanism,
    name: &'static str,
    q: &Q,
) -> Result<(), LengthMismatch> {
    LengthMismatch::check(name, q.as_ref(), mechanism.nq())?;
    LengthMismatch::check(name, q.as_ref(), mechanism.nv())
}

/// Checks that a motion moves all coordinates.
fn check_motion<S: Scalar, Q: Vector<S>, V: Vector<S>>(
    mechanism: &impl Mechanism,
    motion: &Motion<Q, V>,
) -> Result<(), LengthMismatch> {
    LengthMismatch::check("trajectory.q", motion.q.as_ref(), mechanism.nq())?;
    LengthMismatch::check("trajectory.v", motion.v.as_ref(), mechanism.nv())?;
    LengthMismatch::check("trajectory.a", motion.a.as_ref(), mechanism.nv())
}

/// −Kp dq − Kd dv.
fn spring_and_damper<S: Real, Q: Vector<S>, V: Vector<S>>(kp: &V, kd: &V, dq: &Q, dv: &V) -> V {
    V::from_fn(dv.as_ref().len(), |i| -entry(kp, i) * entry(dq, i) - entry(kd, i) * entry(dv, i))
}

/// A spring and a damper to a moving target: τ = Kp (q_d(t) − q) + Kd (q̇_d(t) − q̇).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackingPd<T, V> {
    /// The motion to follow.
    pub trajectory: T,
    /// Kp, one for each velocity.
    pub kp: V,
    /// Kd, one for each velocity.
    pub kd: V,
}

impl<S, M, T> TorqueLaw<S, M> for TrackingPd<T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let desired = self.trajectory.at(t);
        M::Velocities::from_fn(v.as_ref().len(), |i| {
            entry(&self.kp, i) * (entry(&desired.q, i) - entry(q, i))
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
        })
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        let desired = self.trajectory.at(t);
        check_coordinates(mechanism, "trajectory.q", &desired.q)?;
        check_motion(mechanism, &desired)?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        _t: S,
        _at: (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        Some(spring_and_damper(&self.kp, &self.kd, dq, dv))
    }
}

/// Computed torque: τ = M(q) (q̈_d + Kd ė + Kp e) + C(q, q̇) q̇ + g(q), with the error e = q_d(t) ⊟ q, the mechanism's
/// [`difference`](ConfigurationSpace::difference).
///
/// For a model that is right it leaves the linear error dynamics ë + Kd ė + Kp e = 0, the same for every joint and
/// every pose. It takes one inverse dynamics; no matrix is formed. The gains multiply accelerations: Kp 1/s², Kd 1/s.
/// Kd = 2√Kp is critically damped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComputedTorque<'m, M, T, V> {
    /// The mechanism as the controller knows it.
    pub mechanism: &'m M,
    /// The motion to follow.
    pub trajectory: T,
    /// Kp, one for each velocity, 1/s².
    pub kp: V,
    /// Kd, one for each velocity, 1/s.
    pub kd: V,
}

impl<N, T, V> ComputedTorque<'_, N, T, V> {
    /// q̈_d + Kd ė + Kp e.
    fn acceleration<S: Real>(&self, t: S, q: &N::Coordinates, v: &V) -> V
    where
        N: ConfigurationSpace<S, Velocities = V>,
        T: Trajectory<S, N::Coordinates, V>,
        V: Vector<S>,
    {
        let desired = self.trajectory.at(t);
        let error = self.mechanism.difference(q, &desired.q);
        V::from_fn(v.as_ref().len(), |i| {
            entry(&desired.a, i)
                + entry(&self.kd, i) * (entry(&desired.v, i) - entry(v, i))
                + entry(&self.kp, i) * entry(&error, i)
        })
    }
}

impl<S, M, N, T> TorqueLaw<S, M> for ComputedTorque<'_, N, T, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    N: InverseDynamics<S, Coordinates = M::Coordinates, Velocities = M::Velocities>,
    T: Trajectory<S, M::Coordinates, M::Velocities>,
{
    fn torque(&mut self, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        self.mechanism.inverse_dynamics(q, v, &self.acceleration(t, q, v))
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        check_motion(mechanism, &self.trajectory.at(t))?;
        check_gains(mechanism, &self.kp, &self.kd)
    }

    fn torque_tangent(
        &mut self,
        t: S,
        (q, v): (&M::Coordinates, &M::Velocities),
        (dq, dv): (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        if self.mechanism.nq() != self.mechanism.nv() {
            // The derivative of the difference is not that of the coordinates.
            return None;
        }
        let a = self.acceleration(t, q, v);
        let da = spring_and_damper(&self.kp, &self.kd, dq, dv);
        self.mechanism.inverse_dynamics_tangent((q, v, &a), (dq, dv, &da))
    }
}
