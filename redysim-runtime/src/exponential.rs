//! The exponentials of SO(3) and SE(3): right Jacobians, which map rates of rotation vectors and screws to joint velocities,
//! their inverses and their time derivatives.
//!
//! Along q₀ ⊞ w(t), a joint with an orientation has the velocity J(w) ẇ in its link's axes, with the right Jacobian of the
//! exponential (J. Solà, J. Deray and D. Atchuthan, *A micro Lie theory for state estimation in robotics*, 2018, eqs. 143 to
//! 146). Written for SO(3) it is that of SE(3), too, for screws ω + ε u with ε² = 0 in the place of vectors ω: the principle
//! of transference (J. M. Selig, *Geometric Fundamentals of Robotics*, 2nd ed., Springer 2005, section 7.6). So a screw here
//! is a vector of [`Dual`] numbers, and each of its parts one again, which has its time derivative.

use crate::linear_algebra::{cross, dot};
use crate::vector::entry;
use crate::{Dual, Mechanism, Real, Scalar, Vector, VelocityCoordinates};

/// ω + ε u, each with its time derivative.
type Screw<S> = [Dual<Dual<S>>; 3];
/// A linear map of screws x that depends on a screw w.
pub(crate) type ScrewMap<S> = fn(Screw<S>, Screw<S>) -> Screw<S>;

/// J(w) x, with the right Jacobian of the exponential, J = 1 − (1 − cos θ)/θ² ŵ + (θ − sin θ)/θ³ ŵ².
pub(crate) fn right_jacobian<S: Real>(w: Screw<S>, x: Screw<S>) -> Screw<S> {
    let [second, third] = coefficients(dot(&w, &w));
    polynomial(w, x, -second, third)
}

/// J(w)⁻¹ x, with J⁻¹ = 1 + ½ ŵ + (1 − θ/2 cot θ/2)/θ² ŵ², for |w| < 2π.
pub(crate) fn inverse_right_jacobian<S: Real>(w: Screw<S>, x: Screw<S>) -> Screw<S> {
    let (square, half) = (dot(&w, &w), Dual::from_f64(0.5));
    let third = if is_small(square) {
        let [second, third] = coefficients(square);
        (half * second - third) / (Dual::one() - square * third)
    } else {
        let angle = half * square.sqrt();
        let (sin, cos) = angle.sin_cos();
        (Dual::one() - angle * cos / sin) / square
    };
    polynomial(w, x, half, third)
}

/// exp(ŵ) x, the screw x in the axes before the motion exp(ŵ).
pub(crate) fn turned<S: Real>(w: Screw<S>, x: Screw<S>) -> Screw<S> {
    let square = dot(&w, &w);
    let [second, third] = coefficients(square);
    polynomial(w, x, Dual::one() - square * third, second)
}

/// Applies `map` to the velocities `x` of every joint with an orientation, and differentiates: y = map(w, x) and ẏ of `w`,
/// `x` and their time derivatives. The velocities of other joints stay as they are.
pub(crate) fn mapped<S: Real, V: Vector<S>>(
    mechanism: &impl Mechanism,
    map: ScrewMap<S>,
    w: (&V, &V),
    x: (&V, &V),
) -> (V, V) {
    let (mut y, mut slope) = (x.0.clone(), x.1.clone());
    for (linear, angular) in orientations(mechanism) {
        let screw = |(values, slopes): (&V, &V)| {
            let part = |i: usize| Dual { value: entry(values, i), slope: entry(slopes, i) };
            let zero = Dual { value: S::zero(), slope: S::zero() };
            [0, 1, 2].map(|i| Dual { value: part(angular + i), slope: linear.map_or(zero, |first| part(first + i)) })
        };
        for (i, Dual { value, slope: moment }) in map(screw(w), screw(x)).into_iter().enumerate() {
            set(&mut y, angular + i, value.value);
            set(&mut slope, angular + i, value.slope);
            if let Some(linear) = linear {
                set(&mut y, linear + i, moment.value);
                set(&mut slope, linear + i, moment.slope);
            }
        }
    }
    (y, slope)
}

/// The joints with an orientation: the first of their linear velocities, if they have some, and of their angular ones.
pub(crate) fn orientations(mechanism: &impl Mechanism) -> impl Iterator<Item = (Option<usize>, usize)> {
    let kind = |velocity: usize| mechanism.coordinates_of_velocity(velocity);
    (0..mechanism.nv()).filter_map(move |velocity| {
        let VelocityCoordinates::Quaternion(first) = kind(velocity) else { return None };
        let before = velocity.checked_sub(1).map(kind);
        if before == Some(VelocityCoordinates::Quaternion(first)) {
            return None;
        }
        let has_position = first >= 3 && before == Some(VelocityCoordinates::Position(first - 3));
        Some((velocity.checked_sub(3).filter(|_| has_position), velocity))
    })
}

/// Sets element `index`, if there is one.
pub(crate) fn set<T, V: AsMut<[T]>>(vector: &mut V, index: usize, value: T) {
    if let Some(element) = vector.as_mut().get_mut(index) {
        *element = value;
    }
}

/// Whether the angle whose square is given is below 1 rad.
fn is_small<S: Real>(square: Dual<Dual<S>>) -> bool {
    square.value.value < S::one()
}

/// (1 − cos θ)/θ² and (θ − sin θ)/θ³ of θ²; of small angles by their power series, whose derivatives keep their digits, too.
fn coefficients<S: Real>(square: Dual<Dual<S>>) -> [Dual<Dual<S>>; 2] {
    if is_small(square) {
        // 1/2! − θ²/4! + …, 1/3! − θ²/5! + …: the first terms left out, θ¹⁸/20! and θ¹⁸/21!, are below 1e-18.
        let series = |first: u32| {
            (0..9).rev().fold(Dual::zero(), |rest: Dual<Dual<S>>, k| {
                let next = f64::from((first + 2 * k + 1) * (first + 2 * k + 2));
                Dual::one() - square * rest / Dual::from_f64(next)
            })
        };
        return [Dual::from_f64(0.5) * series(2), series(3) / Dual::from_f64(6.0)];
    }
    let angle = square.sqrt();
    let (sin, cos) = angle.sin_cos();
    [(Dual::one() - cos) / square, (Dual::one() - sin / angle) / square]
}

/// x + a w × x + b w × (w × x).
fn polynomial<T: Scalar>(w: [T; 3], x: [T; 3], a: T, b: T) -> [T; 3] {
    let once = cross(w, x);
    let [x0, x1, x2] = x;
    let ([y0, y1, y2], [z0, z1, z2]) = (once, cross(w, once));
    [x0 + a * y0 + b * z0, x1 + a * y1 + b * z1, x2 + a * y2 + b * z2]
}
