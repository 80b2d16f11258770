//! Derivatives by arithmetic: dual numbers.

use core::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

use crate::mechanism::Arguments;
use crate::vector::entry;
use crate::{ConfigurationSpace, ForwardDynamics, InverseDynamics, Scalar, Vector};

/// A number a + b ε with ε² = 0: a value and its derivative along one direction.
///
/// A function over [`Scalar`] that is given x + ẋ ε returns f(x) + f′(x) ẋ ε, exact but for roundoff: forward-mode
/// differentiation (A. Griewank, A. Walther, *Evaluating Derivatives*, 2nd ed., SIAM (2008), chapter 3).
///
/// ```
/// use redysim_runtime::{Dual, Scalar};
///
/// // d/dx (x² sin x) at 2
/// let x = Dual { value: 2.0_f64, slope: 1.0 };
/// let y = x * x * x.sin_cos().0;
/// assert!((y.slope - (4.0 * 2.0_f64.sin() + 4.0 * 2.0_f64.cos())).abs() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dual<S> {
    /// The value a.
    pub value: S,
    /// Its derivative b.
    pub slope: S,
}

impl<S: Scalar> Add for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Dual { value: self.value + other.value, slope: self.slope + other.slope }
    }
}

impl<S: Scalar> Sub for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Dual { value: self.value - other.value, slope: self.slope - other.slope }
    }
}

impl<S: Scalar> Mul for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Dual { value: self.value * other.value, slope: self.slope.mul_add(other.value, self.value * other.slope) }
    }
}

impl<S: Scalar> Div for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Dual { value, slope: (self.slope - value * other.slope) / other.value }
    }
}

impl<S: Scalar> Neg for Dual<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dual { value: -self.value, slope: -self.slope }
    }
}

impl<S: Scalar> AddAssign for Dual<S> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<S: Scalar> SubAssign for Dual<S> {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl<S: Scalar> Scalar for Dual<S> {
    const AT_ONCE: bool = S::AT_ONCE;

    #[inline(always)]
    fn from_f64(value: f64) -> Self {
        Dual { value: S::from_f64(value), slope: S::zero() }
    }

    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (Dual { value: sin, slope: cos * self.slope }, Dual { value: cos, slope: -(sin * self.slope) })
    }

    #[inline]
    fn sin_cos_all<const N: usize>(angles: [Self; N]) -> ([Self; N], [Self; N]) {
        let (sin, cos) = S::sin_cos_all(angles.map(|angle| angle.value));
        let dual = |values: &[S; N], slopes: &[S; N], sign: fn(S) -> S| {
            core::array::from_fn(|i| Dual { value: values[i], slope: sign(slopes[i] * angles[i].slope) })
        };
        (dual(&sin, &cos, |slope| slope), dual(&cos, &sin, |slope| -slope))
    }

    #[inline]
    fn without_turns<const N: usize>(angles: [Self; N]) -> [Self; N] {
        let values = S::without_turns(angles.map(|angle| angle.value));
        core::array::from_fn(|i| Dual { value: values[i], ..angles[i] })
    }

    #[inline]
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        Dual { value: root, slope: self.slope / (root + root) }
    }
}

/// The vector of `values` + `slopes` ε.
fn dual<S: Scalar, V: Vector<S>, W: Vector<Dual<S>>>(values: &V, slopes: &V) -> W {
    W::from_fn(values.as_ref().len(), |i| Dual { value: entry(values, i), slope: entry(slopes, i) })
}

fn slopes<S: Scalar, V: Vector<S>, W: Vector<Dual<S>>>(duals: &W) -> V {
    V::from_fn(duals.as_ref().len(), |i| entry(duals, i).slope)
}

/// The derivative of N(q) v of `mechanism` along `dq` at constant v, by dual numbers: an implementation of
/// [`ConfigurationSpace::coordinate_rates_tangent`] for mechanisms that are generic over scalars.
pub fn coordinate_rates_tangent<S: Scalar, M>(
    mechanism: &M,
    q: &<M as ConfigurationSpace<S>>::Coordinates,
    v: &<M as ConfigurationSpace<S>>::Velocities,
    dq: &<M as ConfigurationSpace<S>>::Coordinates,
) -> <M as ConfigurationSpace<S>>::Coordinates
where
    M: ConfigurationSpace<S> + ConfigurationSpace<Dual<S>>,
{
    let v = Vector::from_fn(v.as_ref().len(), |i| Dual { value: entry(v, i), slope: S::zero() });
    slopes(&ConfigurationSpace::<Dual<S>>::coordinate_rates(mechanism, &dual(q, dq), &v))
}

/// The derivative of the accelerations of `mechanism` along `(dq, dv, dtau)`, by dual numbers: an
/// implementation of [`ForwardDynamics::forward_dynamics_tangent`] for mechanisms that are generic over scalars.
pub fn forward_dynamics_tangent<S: Scalar, M>(
    mechanism: &M,
    (q, v, tau): Arguments<'_, S, M>,
    (dq, dv, dtau): Arguments<'_, S, M>,
) -> <M as ConfigurationSpace<S>>::Velocities
where
    M: ConfigurationSpace<S> + ForwardDynamics<Dual<S>>,
{
    slopes(&ForwardDynamics::<Dual<S>>::forward_dynamics(mechanism, &dual(q, dq), &dual(v, dv), &dual(tau, dtau)))
}

/// The derivative of the joint forces of `mechanism` along `(dq, dv, da)`, by dual numbers: an
/// implementation of [`InverseDynamics::inverse_dynamics_tangent`] for mechanisms that are generic over scalars.
pub fn inverse_dynamics_tangent<S: Scalar, M>(
    mechanism: &M,
    (q, v, a): Arguments<'_, S, M>,
    (dq, dv, da): Arguments<'_, S, M>,
) -> <M as ConfigurationSpace<S>>::Velocities
where
    M: ConfigurationSpace<S> + InverseDynamics<Dual<S>>,
{
    slopes(&InverseDynamics::<Dual<S>>::inverse_dynamics(mechanism, &dual(q, dq), &dual(v, dv), &dual(a, da)))
}
