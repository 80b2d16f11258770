//! Splines: the velocities and accelerations at points with which the motion through them is smoothest.
//!
//! Of every joint, x = (v, a) at the points between the ends follows from equations that tie three neighbours together,
//! L xₗ + M x + U xᵣ = l Δqₗ + r Δqᵣ, where Δq are the ways to the neighbours. They depend on time alone, are the same
//! for all joints, and are solved by elimination from the first point to the last. C. de Boor, *A Practical Guide to
//! Splines*, Springer (2001), chapter IV.

use super::Motion;
use crate::vector::entry;
use crate::{Real, Vector};

type Pair<S> = [S; 2];
type Square<S> = [[S; 2]; 2];

/// The equations at a point.
pub(super) struct Equations<S> {
    /// L, M and U.
    blocks: [Square<S>; 3],
    /// l and r.
    ways: [Pair<S>; 2],
}

/// What is smooth at a point, given the times from its neighbours on the left and on the right.
pub(super) type Smoothness<S> = fn(S, S) -> Equations<S>;

/// Of least jerk, ∫ q⃛² dt: jerk and snap go on without a jump, so that q(t) is four times continuously differentiable.
pub(super) fn least_jerk<S: Real>(left: S, right: S) -> Equations<S> {
    let c = S::from_f64;
    let [l, r] = [left, right].map(|h| S::one() / h);
    let [l2, r2] = [l * l, r * r];
    let [l3, r3] = [l2 * l, r2 * r];
    let cross = c(36.0) * (r2 - l2);
    Equations {
        blocks: [
            [[c(168.0) * l3, c(24.0) * l2], [c(-24.0) * l2, c(-3.0) * l]],
            [[c(192.0) * (l3 + r3), cross], [cross, c(9.0) * (l + r)]],
            [[c(168.0) * r3, c(-24.0) * r2], [c(24.0) * r2, c(-3.0) * r]],
        ],
        ways: [[c(360.0) * l2 * l2, c(-60.0) * l3], [c(360.0) * r2 * r2, c(60.0) * r3]],
    }
}

/// Of least acceleration, ∫ q̈² dt: the cubic spline, whose acceleration goes on without a jump. The second equation
/// says which acceleration that is.
pub(super) fn least_acceleration<S: Real>(left: S, right: S) -> Equations<S> {
    let c = S::from_f64;
    let [l, r] = [left, right].map(|h| S::one() / h);
    let zero = S::zero();
    Equations {
        blocks: [
            [[c(2.0) * l, zero], [zero, zero]],
            [[c(4.0) * (l + r), zero], [c(4.0) * r, S::one()]],
            [[c(2.0) * r, zero], [c(2.0) * r, zero]],
        ],
        ways: [[c(6.0) * l * l, zero], [c(6.0) * r * r, c(6.0) * r * r]],
    }
}

/// Finds velocities and accelerations at all points but the first and the last, whose own are given.
pub(super) fn smooth<S: Real, V: Vector<S>, T: Vector<S>>(
    times: &T,
    points: &mut T::Of<Motion<V, V>>,
    smoothness: Smoothness<S>,
) {
    let points = points.as_mut();
    let count = points.len();
    // After elimination, x = y − P xᵣ; y takes the place of x until all are known.
    let mut upper = T::Of::<Square<S>>::from_fn(count, |_| [[S::zero(); 2]; 2]);
    let upper = upper.as_mut();
    let way = |from: &V, to: &V, joint| entry(to, joint) - entry(from, joint);
    for k in 1..count.saturating_sub(1) {
        let [left, right] = [k, k + 1].map(|k| entry(times, k) - entry(times, k - 1));
        let Equations { blocks: [l, m, u], ways } = smoothness(left, right);
        let (Some([eliminated, here_upper]), Some([before, here, after])) =
            (upper.get_mut(k - 1..=k), points.get_mut(k - 1..=k + 1))
        else {
            return;
        };
        let inverse = inverse(difference(m, product(l, *eliminated)));
        *here_upper = product(inverse, u);
        for joint in 0..here.q.as_ref().len() {
            let [from, to] = [way(&before.q, &here.q, joint), way(&here.q, &after.q, joint)];
            let [first, second] = times_pair(l, [entry(&before.v, joint), entry(&before.a, joint)]);
            let [[l0, l1], [r0, r1]] = ways;
            let wanted = [l0 * from + r0 * to - first, l1 * from + r1 * to - second];
            set(here, joint, times_pair(inverse, wanted));
        }
    }
    for k in (1..count.saturating_sub(1)).rev() {
        let (Some(upper), Some([here, after])) = (upper.get(k), points.get_mut(k..=k + 1)) else { return };
        for joint in 0..here.q.as_ref().len() {
            let from_right = times_pair(*upper, [entry(&after.v, joint), entry(&after.a, joint)]);
            let [v, a] = [entry(&here.v, joint), entry(&here.a, joint)];
            set(here, joint, [v - from_right[0], a - from_right[1]]);
        }
    }
}

fn set<S: Real, V: Vector<S>>(point: &mut Motion<V, V>, joint: usize, [v, a]: Pair<S>) {
    for (values, value) in [(&mut point.v, v), (&mut point.a, a)] {
        if let Some(element) = values.as_mut().get_mut(joint) {
            *element = value;
        }
    }
}

// By patterns and not by indices, whose bounds the compiler checks where it does not inline closures of `array::map`.

fn times_pair<S: Real>([[a, b], [c, d]]: Square<S>, [x, y]: Pair<S>) -> Pair<S> {
    [a * x + b * y, c * x + d * y]
}

fn product<S: Real>([[a, b], [c, d]]: Square<S>, [[e, f], [g, h]]: Square<S>) -> Square<S> {
    [[a * e + b * g, a * f + b * h], [c * e + d * g, c * f + d * h]]
}

fn difference<S: Real>([[a, b], [c, d]]: Square<S>, [[e, f], [g, h]]: Square<S>) -> Square<S> {
    [[a - e, b - f], [c - g, d - h]]
}

fn inverse<S: Real>([[a, b], [c, d]]: Square<S>) -> Square<S> {
    let determinant = a * d - b * c;
    [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]
}
