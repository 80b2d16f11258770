//! A local chart at a position, with one coordinate for each velocity: the model's coordinate for joints of one coordinate and
//! for positions, and for an orientation the rotation vector from that of the position, in its axes.

use super::Motion;
use crate::exponential::{inverse_right_jacobian, mapped, orientations, right_jacobian, set, turned};
use crate::linear_algebra::{cross, zeros};
use crate::tangent::velocities;
use crate::vector::entry;
use crate::{ConfigurationSpace, Mechanism, Real, Vector, VelocityCoordinates};

/// The coordinate of the model that the chart uses for velocity `index`; `None` for a component of a rotation vector.
pub(super) fn own_coordinate(mechanism: &impl Mechanism, index: usize) -> Option<usize> {
    let kind = mechanism.coordinates_of_velocity(index);
    match kind {
        VelocityCoordinates::One(coordinate) => Some(coordinate),
        VelocityCoordinates::Position(first) => {
            let is_before = |back: usize| {
                index.checked_sub(back).is_some_and(|before| mechanism.coordinates_of_velocity(before) == kind)
            };
            Some(first + usize::from(is_before(1)) + usize::from(is_before(2)))
        }
        VelocityCoordinates::Quaternion(_) | VelocityCoordinates::Unknown => None,
    }
}

/// The coordinates of `q` in the chart at `point`.
pub(super) fn coordinates<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    point: &M::Coordinates,
    q: &M::Coordinates,
) -> M::Velocities {
    let way = mechanism.difference(point, q);
    M::Velocities::from_fn(mechanism.nv(), |i| own_coordinate(mechanism, i).map_or(entry(&way, i), |own| entry(q, own)))
}

/// The rotation vectors among coordinates of a chart; zero for the others.
fn displacements<S: Real, V: Vector<S>>(mechanism: &impl Mechanism, x: &V) -> V {
    V::from_fn(mechanism.nv(), |i| if own_coordinate(mechanism, i).is_some() { S::zero() } else { entry(x, i) })
}

/// `x`, one number for each coordinate of a chart, with its vectors in the axes before the rotations `along`.
pub(super) fn in_axes_before<S: Real, V: Vector<S>>(mechanism: &impl Mechanism, along: &V, x: &V) -> V {
    let (along, moved) = (displacements(mechanism, along), displacements(mechanism, x));
    let zero = zeros(mechanism.nv());
    let (moved, _) = mapped(mechanism, turned, (&along, &zero), (&moved, &zero));
    V::from_fn(mechanism.nv(), |i| if own_coordinate(mechanism, i).is_some() { entry(x, i) } else { entry(&moved, i) })
}

/// The motion whose coordinates in the chart at `point` move as `x`.
pub(super) fn motion<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    point: &M::Coordinates,
    x: &Motion<M::Velocities, M::Velocities>,
) -> Motion<M::Coordinates, M::Velocities> {
    let [way, rates, second] = [&x.q, &x.v, &x.a].map(|part| displacements(mechanism, part));
    let (mut v, mut a) = mapped(mechanism, right_jacobian, (&way, &rates), (&rates, &second));
    let mut q = mechanism.integrate(point, &way);
    let (mut qd, mut qdd) = (zeros(mechanism.nq()), zeros(mechanism.nq()));
    for i in 0..mechanism.nv() {
        if let Some(own) = own_coordinate(mechanism, i) {
            set(&mut q, own, entry(&x.q, i));
            set(&mut qd, own, entry(&x.v, i));
            set(&mut qdd, own, entry(&x.a, i));
        }
    }
    // Of a free joint, v = Rᵀ ẋ.
    let (linear, push) = (velocities(mechanism, &q, &qd), velocities(mechanism, &q, &qdd));
    for i in (0..mechanism.nv()).filter(|&i| own_coordinate(mechanism, i).is_some()) {
        set(&mut v, i, entry(&linear, i));
        set(&mut a, i, entry(&push, i));
    }
    for (a, &of_turning) in a.as_mut().iter_mut().zip(turning(mechanism, &v).as_ref()) {
        *a -= of_turning;
    }
    Motion { q, v, a }
}

/// How the coordinates in the chart at `point` move: the inverse of [`motion`].
pub(super) fn motion_about<S: Real, M: ConfigurationSpace<S>>(
    mechanism: &M,
    point: &M::Coordinates,
    Motion { q, v, a }: &Motion<M::Coordinates, M::Velocities>,
) -> Motion<M::Velocities, M::Velocities> {
    let x = coordinates(mechanism, point, q);
    let [way, of_v, of_a] = [&x, v, a].map(|part| displacements(mechanism, part));
    let zero = zeros(mechanism.nv());
    let (mut rates, _) = mapped(mechanism, inverse_right_jacobian, (&way, &zero), (&of_v, &zero));
    let (_, mut second) = mapped(mechanism, inverse_right_jacobian, (&way, &rates), (&of_v, &of_a));
    // Of a free joint, ẋ = R v.
    let of_turning = turning(mechanism, v);
    let push = M::Velocities::from_fn(mechanism.nv(), |i| entry(a, i) + entry(&of_turning, i));
    let (qd, qdd) = (mechanism.coordinate_rates(q, v), mechanism.coordinate_rates(q, &push));
    for i in 0..mechanism.nv() {
        if let Some(own) = own_coordinate(mechanism, i) {
            set(&mut rates, i, entry(&qd, own));
            set(&mut second, i, entry(&qdd, own));
        }
    }
    Motion { q: x, v: rates, a: second }
}

/// ω × v of the linear velocities v of free joints; zero elsewhere.
fn turning<S: Real, V: Vector<S>>(mechanism: &impl Mechanism, v: &V) -> V {
    let mut product: V = zeros(mechanism.nv());
    for (linear, angular) in orientations(mechanism) {
        if let Some(linear) = linear {
            let part = |first: usize| [0, 1, 2].map(|i| entry(v, first + i));
            for (i, component) in cross(part(angular), part(linear)).into_iter().enumerate() {
                set(&mut product, linear + i, component);
            }
        }
    }
    product
}
