//! Rotations as quaternions (x, y, z, w), with the scalar part last, of any length but zero.
//!
//! Nothing here branches, so that the same code serves numbers, lanes, dual numbers and symbols: quotients that are 0/0
//! for a rotation of zero have the square of [`NEARLY_ZERO`] added to their denominator, which changes no digit of any
//! other, and a [`sign`] is a quotient.

use crate::parameter::{ParameterIn, acting};
use crate::spatial::{Mat3, Vec3};
use redysim_runtime::Scalar;

/// A rotation as a quaternion.
pub type Quaternion<S> = [S; 4];

/// An angle, rad, whose square is still a normal number in single precision, and which is less than a rounding of any
/// angle that matters.
const NEARLY_ZERO: f64 = 1e-18;

/// No rotation.
pub fn identity<S: Scalar>() -> Quaternion<S> {
    [S::zero(), S::zero(), S::zero(), S::one()]
}

fn parts<S: Scalar>([x, y, z, w]: Quaternion<S>) -> (Vec3<S>, S) {
    (Vec3([x, y, z]), w)
}

fn whole<S>(Vec3([x, y, z]): Vec3<S>, w: S) -> Quaternion<S> {
    [x, y, z, w]
}

/// Not fused, since the axes of a locked joint are constants of the model.
fn square<S: Scalar>(q: Quaternion<S>) -> S {
    let (v, w) = parts(q);
    w * w + v.dot(v)
}

/// p q: first the rotation q, then the rotation p.
pub fn product<S: Scalar>(p: Quaternion<S>, q: Quaternion<S>) -> Quaternion<S> {
    let ((a, s), (b, t)) = (parts(p), parts(q));
    whole(b.scale(s) + a.scale(t) + a.fused_cross(b), s * t - a.fused_dot(b))
}

fn conjugate<S: Scalar>(q: Quaternion<S>) -> Quaternion<S> {
    let (v, w) = parts(q);
    whole(-v, w)
}

/// The rotation q, then p in the turned axes, of a length nearer to 1 than that of q: q p · 2/(1 + |q|²) for p of
/// length 1. Near length 1 this is the first-order correction (3 − |q|²)/2, which for others may lead away from 1.
pub fn turned<S: Scalar>(q: Quaternion<S>, p: Quaternion<S>) -> Quaternion<S> {
    let toward_one = S::from_f64(2.0) / (S::one() + square(q));
    product(q.map(|component| component * toward_one), p)
}

/// The axes that the rotation gives, as columns: 1 + 2 (w v̂ + v̂²)/|q|².
pub fn rotation<S: Scalar>(q: Quaternion<S>) -> Mat3<S> {
    let (v, w) = parts(q);
    let scaled = v.scale(S::from_f64(2.0) / square(q));
    let [xx, yy, zz] = [0, 1, 2].map(|i| v[i] * scaled[i]);
    // Of z alone the unscaled component: where only the third row is used, two are scaled.
    let [xy, yz, zx] = [v[0] * scaled[1], v[2] * scaled[1], v[2] * scaled[0]];
    let [wx, wy, wz] = scaled.scale(w).0;
    let one = S::one();
    Mat3([
        [one - (yy + zz), xy - wz, zx + wy],
        [xy + wz, one - (zz + xx), yz - wx],
        [zx - wy, yz + wx, one - (xx + yy)],
    ])
}

/// The vector `a` of the axes before the rotation, in the turned ones: a + 2 (v × (v × a) − w v × a)/|q|².
///
/// For a vector that is known before run time, such as gravity. Where it is along one of the axes, its length is a
/// factor of 2/|q|² alone: 18 operations, where the matrix and the product take 24.
pub fn turned_back<S: Scalar>(q: Quaternion<S>, a: Vec3<impl ParameterIn<S>>) -> Vec3<S> {
    let (v, w) = parts(q);
    let components = a.map(acting::<S, _>);
    let (length, direction) = match components.0 {
        [Some(x), None, None] => (x, Vec3([S::one(), S::zero(), S::zero()])),
        [None, Some(y), None] => (y, Vec3([S::zero(), S::one(), S::zero()])),
        [None, None, Some(z)] => (z, Vec3([S::zero(), S::zero(), S::one()])),
        _ => (S::one(), a.map(ParameterIn::value)),
    };
    let across = v.fused_cross(direction);
    let turned = v.fused_cross(across) - across.scale(w);
    a.map(ParameterIn::value) + turned.scale((length + length) / square(q))
}

/// q̇ = ½ q (ω; 0) at the angular velocity ω in the turned axes.
pub fn rates<S: Scalar>(q: Quaternion<S>, angular: Vec3<S>) -> Quaternion<S> {
    let ((v, w), half) = (parts(q), angular.scale(S::from_f64(0.5)));
    whole(half.scale(w) + v.fused_cross(half), -v.fused_dot(half))
}

/// The exponential of SO(3), and what a rigid motion needs of it.
pub struct Exponential<S> {
    /// The unit quaternion of the rotation by |w| about w.
    pub quaternion: Quaternion<S>,
    /// sin(|w|/2)/|w|.
    sine_share: S,
    /// |w|².
    square: S,
}

/// exp ŵ.
pub fn exponential<S: Scalar>(w: Vec3<S>) -> Exponential<S> {
    let square = w.fused_dot(w) + S::from_f64(NEARLY_ZERO * NEARLY_ZERO);
    let angle = square.sqrt();
    let (sin, cos) = (S::from_f64(0.5) * angle).sin_cos();
    let sine_share = sin / angle;
    Exponential { quaternion: whole(w.scale(sine_share), cos), sine_share, square }
}

impl<S: Scalar> Exponential<S> {
    /// V u, the displacement in the axes before it of a motion at the constant velocity (u; w) in moving axes:
    /// V = 1 + (1 − cos θ)/θ² ŵ + (θ − sin θ)/θ³ ŵ², the left Jacobian of SO(3).
    pub fn displacement(&self, w: Vec3<S>, u: Vec3<S>) -> Vec3<S> {
        let Exponential { quaternion: [_, _, _, cos], sine_share, square } = *self;
        let two = S::from_f64(2.0);
        let across = w.fused_cross(u);
        let second = (S::one() - two * (sine_share * cos)) / square;
        u + across.scale(two * (sine_share * sine_share)) + w.fused_cross(across).scale(second)
    }
}

/// The logarithm of SO(3), and what a rigid motion needs of it.
pub struct Logarithm<S> {
    /// The rotation vector, of length 0 to π.
    pub vector: Vec3<S>,
    /// (θ/2) cot(θ/2).
    half_cotangent: S,
}

/// w with exp ŵ = q₀⁻¹ q₁, the shorter way round.
pub fn difference<S: Scalar>(q0: Quaternion<S>, q1: Quaternion<S>) -> Logarithm<S> {
    let q = product(conjugate(q0), q1);
    let (v, w) = parts(q);
    let (one, length, cos) = (S::one(), square(q).sqrt(), (w * w).sqrt());
    // Of q and −q the one with a positive scalar part. Half a turn, whose scalar part is zero, keeps its axis.
    let sign = sign(w / length);
    // tan(θ/4), halved twice to tan(θ/16) ≤ 0.199, for which twelve terms of the arctangent are enough.
    let mut share = sign / (length + cos);
    for _ in 0..2 {
        let tangent = v.scale(share);
        share = share / (one + (one + tangent.fused_dot(tangent)).sqrt());
    }
    let tangent = v.scale(share);
    let share = S::from_f64(16.0) * (share * arctangent_share(tangent.fused_dot(tangent)));
    // θ/sin(θ/2) · cos(θ/2), where sin(θ/2) is |v|/|q|.
    Logarithm { vector: v.scale(share), half_cotangent: S::from_f64(0.5) * (share * sign) * cos }
}

/// The sign of a number, 1 or −1; 1 within [`NEARLY_ZERO`].
///
/// (x + ε)/(|x| + ε) is 1 for all positive x, but −1 to the last digit only for x far below −ε: of −1e-16 it makes −0.98.
/// Of that it makes −1, and the third time it does so of whatever the first has left.
fn sign<S: Scalar>(x: S) -> S {
    let zero = S::from_f64(NEARLY_ZERO);
    (0..3).fold(x, |x, _| (x + zero) / ((x * x).sqrt() + zero))
}

/// atan(x)/x of a square x² ≤ 0.04, to 1e-18.
fn arctangent_share<S: Scalar>(square: S) -> S {
    const TERMS: i32 = 12;
    let coefficient = |k: i32| S::from_f64(if k % 2 == 0 { 1.0 } else { -1.0 } / f64::from(2 * k + 1));
    (0..TERMS - 1).rev().fold(coefficient(TERMS - 1), |sum, k| sum.mul_add(square, coefficient(k)))
}

impl<S: Scalar> Logarithm<S> {
    /// V⁻¹ d, the velocity that, constant in moving axes, leads to the displacement d in the axes before it.
    pub fn velocity(&self, d: Vec3<S>) -> Vec3<S> {
        let w = self.vector;
        let across = w.fused_cross(d);
        let second = (S::one() - self.half_cotangent) / (w.fused_dot(w) + S::from_f64(NEARLY_ZERO * NEARLY_ZERO));
        d - across.scale(S::from_f64(0.5)) + w.fused_cross(across).scale(second)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_known_vector_is_turned_back_as_by_the_matrix() {
        for q in [[0.1, -0.7, 0.4, 0.5], [2.0, 0.3, -1.0, 0.0], [0.0, 0.0, 0.0, 3.0]] {
            let vectors =
                [[0.0; 3], [9.81, 0.0, 0.0], [0.0, -3.0, 0.0], [0.0, 0.0, -9.81], [1.0, -9.0, 3.0], [0.0, 2.0, 5.0]];
            for a in vectors.map(Vec3) {
                let (found, expected) = (turned_back(q, a), rotation(q).transpose() * a);
                for i in 0..3 {
                    assert!((found[i] - expected[i]).abs() <= 1e-14, "{q:?} {a:?}: {found:?}, {expected:?}");
                }
            }
        }
    }
}
