//! Small changes of a configuration on the tangent: as velocities, errors of coordinates, projections, and slopes of
//! differences.

use core::ops::Range;

use crate::exponential::{inverse_right_jacobian, mapped};
use crate::integrate::{Tolerances, finite};
use crate::linear_algebra::{dot, zeros};
use crate::vector::entry;
use crate::{ConfigurationSpace, Real, Vector, VelocityCoordinates};

/// [`Ode::error_norm`](crate::Ode::error_norm) of a simulation of `mechanism`: where it has as many coordinates as
/// velocities, [`Tolerances::norm`].
pub(crate) fn error_norm<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    tolerances: &Tolerances<'_, S>,
    error: &Y,
    (y, z): (&Y, &Y),
) -> S {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    if nq == nv {
        return tolerances.norm(error, y, z);
    }
    let moved = displacement(mechanism, error, z);
    let by_itself = |component: usize| {
        let size = entry(y, component).abs().maximum(entry(z, component).abs());
        tolerances.weighed(component, entry(error, component), size)
    };
    // The smallest absolute tolerance, which is that with the largest share.
    let by_all = |components: Range<usize>, along: S, size: S| {
        components.fold(S::zero(), |norm, component| norm.maximum(tolerances.weighed(component, along, size)))
    };
    let of_velocity = |velocity: usize| {
        let along = entry(&moved, velocity);
        match mechanism.coordinates_of_velocity(velocity) {
            VelocityCoordinates::One(component) => by_itself(component),
            VelocityCoordinates::Position(first) => {
                let components = first..first + 3;
                let distance = length(y, components.clone()).maximum(length(z, components.clone()));
                by_all(components, along, distance)
            }
            VelocityCoordinates::Quaternion(first) => by_all(first..first + 4, along, S::one()),
            VelocityCoordinates::Unknown => by_all(0..nq, along, S::one()),
        }
    };
    let norm = (0..nv).fold(S::zero(), |norm, velocity| norm.maximum(of_velocity(velocity)));
    finite((nq..error.as_ref().len()).fold(norm, |norm, component| norm.maximum(by_itself(component))))
}

/// [`Ode::project_onto_tangent`](crate::Ode::project_onto_tangent) of a simulation of `mechanism`: d − q (q · d)/(q · q) of each
/// quaternion q.
pub(crate) fn project<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(mechanism: &M, state: &Y, direction: &mut Y) {
    if mechanism.nq() == mechanism.nv() {
        return;
    }
    let mut projected = None;
    for velocity in 0..mechanism.nv() {
        let VelocityCoordinates::Quaternion(first) = mechanism.coordinates_of_velocity(velocity) else { continue };
        // Three velocities share a quaternion.
        if projected.replace(first) == Some(first) {
            continue;
        }
        let (along, square) = (first..first + 4).fold((S::zero(), S::zero()), |(along, square), i| {
            let q = entry(state, i);
            (along + q * entry(direction, i), square + q * q)
        });
        for (part, i) in direction.as_mut().iter_mut().skip(first).take(4).zip(first..) {
            *part -= entry(state, i) * along / square;
        }
    }
}

/// N⁺ dq: the velocities that, over a unit of time, move the coordinates of `state` by those of `change` to first order.
///
/// The logarithm of a large change is not proportional to it, and rounding leaves nothing of a small one: it is that of a
/// change of a given size.
fn displacement<S: Real, Y: Vector<S>, M: ConfigurationSpace<S>>(
    mechanism: &M,
    change: &Y,
    state: &Y,
) -> M::Velocities {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    let size = length(change, 0..nq);
    if size == S::zero() {
        return M::Velocities::from_fn(nv, |_| S::zero());
    }
    let share = S::EPSILON.sqrt().sqrt() / size;
    let from = M::Coordinates::from_fn(nq, |i| entry(state, i));
    let to = M::Coordinates::from_fn(nq, |i| entry(state, i) + share * entry(change, i));
    let moved = mechanism.difference(&from, &to);
    M::Velocities::from_fn(nv, |i| entry(&moved, i) / share)
}

/// √Σ yᵢ² of some components.
fn length<S: Real, Y: Vector<S>>(y: &Y, components: Range<usize>) -> S {
    components.fold(S::zero(), |sum, i| sum + entry(y, i) * entry(y, i)).sqrt()
}

/// N⁺ dq: the velocities at which coordinates change by `dq`, and by the nearest that they can where they are constrained.
///
/// The columns of N belong to a joint of one velocity, or are those of a rotation and of a quaternion: orthogonal.
pub(crate) fn velocities<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    q: &M::Coordinates,
    dq: &M::Coordinates,
) -> M::Velocities {
    let nv = mechanism.nv();
    M::Velocities::from_fn(nv, |velocity| {
        if let VelocityCoordinates::One(coordinate) = mechanism.coordinates_of_velocity(velocity) {
            return entry(dq, coordinate);
        }
        let unit = M::Velocities::from_fn(nv, |i| if i == velocity { S::one() } else { S::zero() });
        let column = mechanism.coordinate_rates(q, &unit);
        dot(column.as_ref(), dq.as_ref()) / dot(column.as_ref(), column.as_ref())
    })
}

/// The derivative of the error e = `target` ⊟ q along `dq` at a constant target: −J(−e)⁻¹ N⁺ dq, with the right Jacobian J of
/// the exponential; `None` where the mechanism has coordinates of an unknown kind.
pub(crate) fn error_slope<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    q: &M::Coordinates,
    target: &M::Coordinates,
    dq: &M::Coordinates,
) -> Option<M::Velocities> {
    let negative = |v: &M::Velocities| M::Velocities::from_fn(mechanism.nv(), |i| -entry(v, i));
    let moved = negative(&velocities(mechanism, q, dq));
    if mechanism.nq() == mechanism.nv() {
        return Some(moved);
    }
    if (0..mechanism.nv()).any(|i| mechanism.coordinates_of_velocity(i) == VelocityCoordinates::Unknown) {
        return None;
    }
    let (back, zero) = (negative(&mechanism.difference(q, target)), zeros(mechanism.nv()));
    Some(mapped(mechanism, inverse_right_jacobian, (&back, &zero), (&moved, &zero)).0)
}
