//! A spring with a damper between two points of bodies.

use crate::joint::sum;
use crate::parameter::{Parameter, ParameterIn, acting};
use crate::roundoff::exact_one;
use crate::spatial::Vec3;
use redysim_runtime::Scalar;

/// A spring with a damper between the points a and b, at the distance ℓ.
///
/// It pulls the points together with f = k (ℓ − ℓ₀) + c ℓ̇ along the line between them, with the stiffness k, the free
/// length ℓ₀ and the damping c. The joint force that a motion takes against it is (∂ℓ/∂q)ᵀ f, part of the bias; its
/// energy is ½ k (ℓ − ℓ₀)².
///
/// Where the points coincide, the line has no direction. With ℓ₀ = 0 and c = 0 the force k d along the vector d between
/// the points needs none. All others have √(ℓ² + ε²) with ε = 1e-15 m in place of ℓ, which changes no digit beyond
/// 1e-7 m and makes the force of coinciding points zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodySpring<P = f64> {
    /// One end.
    pub a: BodyPoint,
    /// The other end.
    pub b: BodyPoint,
    /// Stiffness k, N/m.
    pub stiffness: P,
    /// Damping c, N s/m.
    pub damping: P,
    /// Free length ℓ₀, m.
    pub length: P,
}

/// A point on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyPoint {
    /// The body in [`Tree::bodies`](crate::Tree::bodies); `None` is the ground.
    pub body: Option<usize>,
    /// The point, in the body's frame, m.
    pub point: Vec3<f64>,
}

/// ε², m²: below the roundings of coordinates, and within the range of `f32`.
const LEAST_SQUARE: f64 = 1e-30;

impl<P: Scalar> BodySpring<P> {
    /// Applies `f` to stiffness, damping and free length.
    pub fn map<Q>(&self, f: impl Fn(P) -> Q) -> BodySpring<Q> {
        let BodySpring { a, b, stiffness, damping, length } = *self;
        BodySpring { a, b, stiffness: f(stiffness), damping: f(damping), length: f(length) }
    }

    /// Its two ends, to be changed.
    pub(crate) fn ends_mut(&mut self) -> [&mut BodyPoint; 2] {
        [&mut self.a, &mut self.b]
    }
}

impl<P: Parameter> BodySpring<P> {
    /// Whether its force is not known to be zero.
    pub fn acts(&self) -> bool {
        [self.stiffness, self.damping].into_iter().any(|part| part.number() != Some(0.0))
    }

    /// The spring in the unit of length `unit`, m, and the unit of mass 1/`unit`² kg.
    pub(crate) fn in_unit(&self, unit: f64) -> Self {
        let times = |value: P, factor: f64| value * P::from_f64(factor);
        let end = |BodyPoint { body, point }| BodyPoint { body, point: Vec3(point.0.map(|x| exact_one(x / unit))) };
        BodySpring {
            a: end(self.a),
            b: end(self.b),
            stiffness: times(self.stiffness, unit * unit),
            damping: times(self.damping, unit * unit),
            length: times(self.length, 1.0 / unit),
        }
    }

    /// ℓ² of the square of the vector between its ends.
    fn regular<S: Scalar>(&self, square: S) -> S {
        match (self.length.number(), self.damping.number()) {
            (Some(0.0), Some(0.0)) => square,
            _ => square + S::from_f64(LEAST_SQUARE),
        }
    }

    /// The force for a unit of length, f/ℓ = k (1 − ℓ₀/ℓ) + c (ℓ ℓ̇)/ℓ², N/m, where `square` is that of the vector
    /// between its ends and `half_rate` is half of its rate, ℓ ℓ̇; `None` if it is known to be zero.
    pub(crate) fn force_density<S: Scalar>(&self, square: S, half_rate: impl FnOnce() -> S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        let square = self.regular(square);
        let elastic = acting(self.stiffness).map(|stiffness: S| match acting(self.stiffness * self.length) {
            Some(preload) => stiffness - preload / square.sqrt(),
            None => stiffness,
        });
        let viscous = acting(self.damping).map(|damping: S| damping * half_rate() / square);
        sum([elastic, viscous])
    }

    /// c ℓ̇², the power that its damper takes; `None` if it is known to be zero.
    pub(crate) fn dissipated_power<S: Scalar>(&self, square: S, half_rate: impl FnOnce() -> S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        acting(self.damping).map(|damping: S| {
            let half_rate = half_rate();
            damping * (half_rate * half_rate) / self.regular(square)
        })
    }

    /// Twice its energy, k (ℓ − ℓ₀)², J; `None` if it is known to be zero.
    pub(crate) fn twice_energy<S: Scalar>(&self, square: S) -> Option<S>
    where
        P: ParameterIn<S>,
    {
        acting(self.stiffness).map(|stiffness: S| match acting(self.length) {
            None => stiffness * square,
            Some(length) => {
                let stretch: S = self.regular(square).sqrt() - length;
                stiffness * (stretch * stretch)
            }
        })
    }
}
