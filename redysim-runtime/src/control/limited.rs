//! Forces within the limits of the actuators.

use crate::vector::entry;
use crate::{ConfigurationSpace, LengthMismatch, Real, TorqueLaw, Vector};

/// Any law with the limits of the actuators: τ_applied = min(max(τ, −limit), limit) in each joint.
///
/// A law that has states, such as [`Pid`](crate::Pid), receives the difference of applied and commanded force
/// ([`TorqueLaw::track`]), so that its integral action does not wind up.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Limited<L, V> {
    /// The law.
    pub law: L,
    /// The largest force in either direction, one for each velocity, N m or N; non-negative: zero for an undriven
    /// joint, infinite for no limit.
    pub limits: V,
}

impl<L, V> Limited<L, V> {
    /// The forces `tau` within the limits. NaN stays NaN.
    fn applied<S: Real>(&self, tau: &V) -> V
    where
        V: Vector<S>,
    {
        V::from_fn(tau.as_ref().len(), |i| {
            let limit = entry(&self.limits, i);
            entry(tau, i).maximum(-limit).minimum(limit)
        })
    }
}

impl<S, M, L> TorqueLaw<S, M> for Limited<L, M::Velocities>
where
    S: Real,
    M: ConfigurationSpace<S>,
    L: TorqueLaw<S, M>,
{
    fn torque(&mut self, mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let asked = self.law.torque(mechanism, t, q, v);
        self.applied(&asked)
    }

    fn check_lengths(&self, t: S, mechanism: &M) -> Result<(), LengthMismatch> {
        LengthMismatch::check("limits", self.limits.as_ref(), mechanism.nv())?;
        self.law.check_lengths(t, mechanism)
    }

    /// Zero for forces that are cut off.
    fn torque_tangent(
        &mut self,
        mechanism: &M,
        t: S,
        (q, v): (&M::Coordinates, &M::Velocities),
        slopes: (&M::Coordinates, &M::Velocities),
    ) -> Option<M::Velocities> {
        let slope = self.law.torque_tangent(mechanism, t, (q, v), slopes)?;
        let asked = self.law.torque(mechanism, t, q, v);
        Some(M::Velocities::from_fn(v.as_ref().len(), |i| {
            let is_cut_off = entry(&asked, i).abs() > entry(&self.limits, i);
            if is_cut_off { S::zero() } else { entry(&slope, i) }
        }))
    }

    fn state_count(&self, mechanism: &M) -> usize {
        self.law.state_count(mechanism)
    }

    fn initial_state(&self, index: usize) -> S {
        self.law.initial_state(index)
    }

    fn torque_with_state(
        &mut self,
        mechanism: &M,
        t: S,
        at: (&M::Coordinates, &M::Velocities),
        state: &[S],
        rates: &mut [S],
    ) -> M::Velocities {
        let asked = self.law.torque_with_state(mechanism, t, at, state, rates);
        let applied = self.applied(&asked);
        let saturation_error = M::Velocities::from_fn(asked.as_ref().len(), |i| entry(&applied, i) - entry(&asked, i));
        self.law.track(&saturation_error, rates);
        applied
    }

    fn track(&self, saturation_error: &M::Velocities, rates: &mut [S]) {
        self.law.track(saturation_error, rates);
    }
}
