//! The interface of an equation.

use super::Tolerances;
use crate::{LengthMismatch, Real, Vector};

/// The right-hand side of an ordinary differential equation, ẏ = f(t, y).
///
/// Every closure `FnMut(S, &Y, &mut Y)` is one. Integrators choose the points at which they call it, which
/// include those of rejected steps and are not always in the order of time.
pub trait Ode<S, Y> {
    /// Writes f(t, y) to `dydt`, which has the length of `y` and arbitrary elements.
    fn derivative(&mut self, t: S, y: &Y, dydt: &mut Y);

    /// Checks, before the first derivative, that the state `y` at the first time `t` and the vectors that the equation
    /// holds have the lengths that it needs. Arrays always have. By default, nothing is checked.
    ///
    /// # Errors
    /// The first vector that has another length.
    fn check_lengths(&self, t: S, y: &Y) -> Result<(), LengthMismatch> {
        let _ = (t, y);
        Ok(())
    }

    /// Called once for each accepted step, with its end `t`, its size `step` > 0 and the state `y` there, which may be
    /// corrected in place: for example, so that an invariant of the equation holds. What an integration shows as the
    /// end of the step is the corrected state, and from there it goes on; within the step the solution is that of the
    /// method, as [`interpolated`](Self::interpolated) corrects it. Where an event ends the integration within a step, it is called once more, for the state there, which is
    /// earlier. By default, nothing happens.
    fn accepted(&mut self, t: S, step: S, y: &mut Y) -> Accepted {
        let _ = (t, step, y);
        Accepted::Unchanged
    }

    /// Called for each state that is shown at a time `t` within a step, for a time that is asked for or an event, where the
    /// solution is that of the dense output. The state may be corrected in place, as by [`accepted`](Self::accepted); the
    /// integration does not depend on it. By default, nothing happens.
    fn interpolated(&mut self, t: S, y: &mut Y) {
        let _ = (t, y);
    }

    /// The size of `error`, a small difference of states at `z`, as `tolerances` weigh it: at most
    /// [rtol](Tolerances::relative) where they are met. `y` and `z` are the states between which the components have
    /// their magnitudes: the start and the end of a step. By default each component is weighed by itself
    /// ([`Tolerances::norm`]).
    ///
    /// Simulations of a mechanism weigh errors of coordinates that are more than the velocities, such as quaternions,
    /// on the tangent: for each velocity, the [difference](crate::ConfigurationSpace::difference) of configurations to
    /// first order. One along a rotation is compared with 1 rad, whatever the orientation is, and one along a
    /// translation with the distance from the origin of the joint, so that neither the choice of axes of the base
    /// frame nor the length of a quaternion matters. The absolute tolerance of either is the smallest of the
    /// coordinates of that position or orientation, in m or rad.
    fn error_norm(&self, tolerances: &Tolerances<'_, S>, error: &Y, y: &Y, z: &Y) -> S
    where
        S: Real,
        Y: Vector<S>,
    {
        tolerances.norm(error, y, z)
    }

    /// Projects `direction`, a small change of the state `y`, onto the tangent space of the states that the system can have.
    /// By default, all directions are tangent. [`Ode15s`](crate::Ode15s), [`Radau5`](crate::Radau5) and
    /// [`largest_stable_step`](crate::integrate::stability::largest_stable_step) differentiate along projected directions: their
    /// Jacobian is (∂f/∂y) P with this projection P. An equation that wraps another one forwards this method.
    ///
    /// Simulations of a mechanism remove from a direction the change of length of each quaternion, which no motion has.
    fn project_onto_tangent(&self, y: &Y, direction: &mut Y) {
        let _ = (y, direction);
    }

    /// Writes (∂f/∂y) `direction` at (t, y) to `slope` and returns `true`, if it can do that without differences; from
    /// such products implicit methods have their Jacobians. `false`, the default, leaves them to differences.
    fn tangent(&mut self, t: S, y: &Y, direction: &Y, slope: &mut Y) -> bool {
        let _ = (t, y, direction, slope);
        false
    }

    /// Writes the rates of the leading components of y that are coordinates of a mechanical system, those whose rates
    /// depend on the coordinates and velocities alone, and returns how many there are: what a method needs that treats
    /// coordinates and velocities differently. The default is 0.
    fn coordinate_rates(&mut self, t: S, y: &Y, rates: &mut Y) -> usize {
        let _ = (t, y, rates);
        0
    }
}

/// The result of [`Ode::accepted`].
///
/// The enumeration is exhaustive, so that every method outside this crate handles all cases: to take an unknown one for
/// `Unchanged` would be wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accepted {
    /// The state is unchanged.
    Unchanged,
    /// The state was changed, so that the derivative there must be evaluated again.
    Corrected,
    /// The state cannot be accepted: the integration ends with
    /// [`IntegrationError::Refused`](crate::IntegrationError::Refused).
    Refused,
}

impl<S, Y, F: FnMut(S, &Y, &mut Y)> Ode<S, Y> for F {
    fn derivative(&mut self, t: S, y: &Y, dydt: &mut Y) {
        self(t, y, dydt);
    }
}
