//! Forward simulation of mechanisms with closed loops.

use core::iter::once;

use super::linear::{dot, largest, product};
use super::linearised::{Linearised, size};
use super::{Assembly, ClosedLoop, ConstrainedMotion, LoopError, Stabilisation};
use crate::integrate::Accepted;
use crate::vector::entry;
use crate::{BiasForces, ForwardSimulation, LoopClosure, MassMatrix, Mechanism, Ode, Real, SimulationState, TorqueLaw};

/// A start may be open by this part of the mechanism's size, and pull apart by this part of its speed.
const OPEN: f64 = 1e-8;

/// A mechanism with closed loops, moved by a torque law, as an [`Ode`] in the state y = [q, q̇, E_act] of a
/// [`ForwardSimulation`]. It runs with every integrator.
///
/// Accelerations are those of [`ClosedLoop::dynamics`]; [`Stabilisation`] says what keeps the loops closed, by default
/// the projection after each accepted step. When an integration ends with an error,
/// [`last_error`](Self::last_error) has the loops' own reason, if it was theirs.
#[derive(Debug)]
pub struct ClosedLoopSimulation<'m, S, M, L, C = M> {
    loops: ClosedLoop<'m, M, C>,
    law: L,
    stabilisation: Stabilisation<S>,
    last_error: Option<LoopError<S>>,
}

impl<'m, S: Real, M, L, C> ClosedLoopSimulation<'m, S, M, L, C> {
    /// The simulation of `loops` under `law`.
    pub fn new(loops: ClosedLoop<'m, M, C>, law: L) -> Self {
        Self { loops, law, stabilisation: Stabilisation::default(), last_error: None }
    }

    /// Sets what keeps the loops closed.
    pub fn stabilisation(self, stabilisation: Stabilisation<S>) -> Self {
        Self { stabilisation, ..self }
    }

    /// The mechanism and its closure.
    pub fn loops(&self) -> ClosedLoop<'m, M, C> {
        self.loops
    }

    /// The torque law.
    pub fn law(&self) -> &L {
        &self.law
    }

    /// What went wrong in the loops when a derivative was evaluated or a step corrected last; `None` if nothing did.
    pub fn last_error(&self) -> Option<LoopError<S>> {
        self.last_error
    }

    /// The state [q, v, 0] to start from.
    ///
    /// # Errors
    /// A start that leaves loops open is refused with [`LoopError::Open`], one whose velocities pull them apart with
    /// [`LoopError::PullsApart`]: [`ClosedLoop::assemble`] finds one that fits. [`state`](Self::state) takes any.
    pub fn start(&self, q: &M::Coordinates, v: &M::Velocities) -> Result<M::State, LoopError<S>>
    where
        M: Mechanism<S>,
        C: LoopClosure<S, M>,
    {
        let closure = self.loops.closure;
        let jacobian = closure.loop_jacobian(q);
        let scale = size(jacobian.as_ref());
        let (gap, row) = largest(closure.loop_residual(q).as_ref().iter().copied());
        let small = S::from_f64(OPEN).maximum(S::from_f64(100.0) * S::EPSILON);
        if gap > small * scale {
            return Err(LoopError::Open { gap, row });
        }
        let rates: C::Rows = product(jacobian.as_ref(), v.as_ref());
        let (rate, row) = largest(rates.as_ref().iter().copied());
        let (fastest, _) = largest(v.as_ref().iter().copied());
        if rate > small * scale * fastest {
            return Err(LoopError::PullsApart { rate, row });
        }
        if !(gap.is_finite() && rate.is_finite() && fastest.is_finite()) {
            return Err(LoopError::NotFinite);
        }
        Ok(self.state(q, v))
    }

    /// The state [q, v, 0] to start from an [`Assembly`].
    pub fn assembled(&self, assembly: &Assembly<S, M::Coordinates, M::Velocities>) -> M::State
    where
        M: Mechanism<S>,
    {
        self.state(&assembly.q, &assembly.v)
    }

    /// The state [q, v, 0], whether or not the loops are closed there.
    pub fn state(&self, q: &M::Coordinates, v: &M::Velocities) -> M::State
    where
        M: Mechanism<S>,
    {
        ForwardSimulation::new(self.loops.mechanism, ()).state(q, v)
    }

    /// The parts of a state. What a `Vec` lacks is NaN.
    pub fn split(&self, state: &M::State) -> SimulationState<S, M::Coordinates, M::Velocities>
    where
        M: Mechanism<S>,
    {
        ForwardSimulation::new(self.loops.mechanism, ()).split(state)
    }

    /// Accelerations, multipliers and rank in a state, as the simulation sees them.
    ///
    /// # Errors
    /// As [`ClosedLoop::dynamics`].
    pub fn motion(&mut self, t: S, state: &M::State) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
        L: TorqueLaw<S, M>,
    {
        self.driven_motion(t, state).map(|(_, motion)| motion)
    }

    /// As [`motion`](Self::motion), behind the joint forces of the law.
    ///
    /// # Errors
    /// As [`ClosedLoop::dynamics`].
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub fn driven_motion(
        &mut self,
        t: S,
        state: &M::State,
    ) -> Result<(M::Velocities, ConstrainedMotion<M::Velocities, C::Rows>), LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
        L: TorqueLaw<S, M>,
    {
        let SimulationState { q, v, .. } = self.split(state);
        let tau = self.law.torque(t, &q, &v);
        let motion = self.constrained(&self.loops.linearise(&q, &[])?, &q, &v, &tau)?;
        Ok((tau, motion))
    }

    /// The parts of a state at which the derivative is taken, and the loops there: the state itself, or, with the
    /// projection near a singular position or with redundant rows, the nearest one that keeps the loops closed: in a
    /// state that is slightly open rows contradict each other, and the rank may be another.
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    fn taken_at(&self, state: &M::State) -> Result<(M::Coordinates, M::Velocities, Linearised<S, M, C>), LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let SimulationState { q, v, .. } = self.split(state);
        let at = self.loops.linearise(&q, &[])?;
        if self.stabilisation == Stabilisation::Projection
            && (at.space.nearly_singular() || at.space.rank() < self.loops.closure.nc())
            && let Ok((closing, v)) = self.loops.nearest(&q, &v)
        {
            return Ok((closing.q, v, closing.at));
        }
        Ok((q, v, at))
    }

    fn constrained(
        &self,
        at: &Linearised<S, M, C>,
        q: &M::Coordinates,
        v: &M::Velocities,
        tau: &M::Velocities,
    ) -> Result<ConstrainedMotion<M::Velocities, C::Rows>, LoopError<S>>
    where
        M: MassMatrix<S> + BiasForces<S>,
        C: LoopClosure<S, M>,
    {
        let Stabilisation::Baumgarte { alpha } = self.stabilisation else {
            return self.loops.dynamics_at(at, q, v, tau, |_| S::zero());
        };
        let residual = self.loops.closure.loop_residual(q);
        let rates: C::Rows = product(at.jacobian.as_ref(), v.as_ref());
        self.loops.dynamics_at(at, q, v, tau, |row| {
            let rate = entry(&rates, row);
            alpha * (rate + rate + alpha * entry(&residual, row))
        })
    }
}

impl<S, M, L, C> Ode<S, M::State> for ClosedLoopSimulation<'_, S, M, L, C>
where
    S: Real,
    M: MassMatrix<S> + BiasForces<S>,
    L: TorqueLaw<S, M>,
    C: LoopClosure<S, M>,
{
    /// Not a number where the loops cannot be solved; [`last_error`](Self::last_error) then says why.
    fn derivative(&mut self, t: S, state: &M::State, rate: &mut M::State) {
        let taken = self.taken_at(state).and_then(|(q, v, at)| {
            let tau = self.law.torque(t, &q, &v);
            let motion = self.constrained(&at, &q, &v, &tau)?;
            Ok((self.loops.mechanism.coordinate_rates(&q, &v), motion.accelerations, dot(tau.as_ref(), v.as_ref())))
        });
        match taken {
            Err(error) => {
                self.last_error = Some(error);
                rate.as_mut().fill(S::from_f64(f64::NAN));
            }
            Ok((rates, accelerations, power)) => {
                self.last_error = None;
                let values = rates.as_ref().iter().chain(accelerations.as_ref()).chain(once(&power));
                for (rate, &value) in rate.as_mut().iter_mut().zip(values) {
                    *rate = value;
                }
            }
        }
    }

    fn coordinate_rates(&mut self, _t: S, state: &M::State, rates: &mut M::State) -> usize {
        let SimulationState { q, v, .. } = self.split(state);
        for (rate, &value) in rates.as_mut().iter_mut().zip(self.loops.mechanism.coordinate_rates(&q, &v).as_ref()) {
            *rate = value;
        }
        self.loops.mechanism.nq()
    }

    fn accepted(&mut self, _t: S, step: S, state: &mut M::State) -> Accepted {
        let corrected = self.stabilisation.check(step).and_then(|()| match self.stabilisation {
            Stabilisation::Projection => {
                let SimulationState { q, v, .. } = self.split(state);
                self.loops.project(&q, &v).map(Some)
            }
            Stabilisation::Baumgarte { .. } | Stabilisation::None => Ok(None),
        });
        match corrected {
            Err(error) => {
                self.last_error = Some(error);
                Accepted::Refused
            }
            Ok(None) => Accepted::AsItIs,
            Ok(Some(projection)) => {
                let values = projection.q.as_ref().iter().chain(projection.v.as_ref());
                for (state, &value) in state.as_mut().iter_mut().zip(values) {
                    *state = value;
                }
                Accepted::Corrected
            }
        }
    }
}
