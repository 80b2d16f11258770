//! Numbers of a robot that are given at run time.

use crate::{Dual, Real, Scalar};
use core::fmt;

/// A number of a robot in a computation over the scalar `S`.
///
/// A mechanism with run-time parameters, `X<P>`, has its numbers in `P` and implements the traits of its functions for
/// every scalar into which they can be lifted: `X<f64>` for any scalar, `X<f32>` for `f32` and its derivatives, and
/// a mechanism over lanes, with a robot of its own in each lane, for these lanes.
pub trait Lift<S>: Copy {
    /// The number as `S`.
    fn lift(self) -> S;
}

impl<S: Scalar> Lift<S> for f64 {
    #[inline(always)]
    fn lift(self) -> S {
        S::from_f64(self)
    }
}

/// Implements [`Lift`] for scalars other than `f64`: to themselves, and to numbers with a derivative, which is zero.
macro_rules! lift {
    ($($scalar:ty),*) => {$(
        impl Lift<$scalar> for $scalar {
            #[inline(always)]
            fn lift(self) -> Self {
                self
            }
        }

        impl Lift<Dual<$scalar>> for $scalar {
            #[inline(always)]
            fn lift(self) -> Dual<Self> {
                Dual { value: self, slope: <$scalar as Scalar>::zero() }
            }
        }
    )*};
}

lift!(f32);
#[cfg(feature = "lanes")]
lift!(
    crate::lanes::F64x2,
    crate::lanes::F64x4,
    crate::lanes::F64x8,
    crate::lanes::F32x4,
    crate::lanes::F32x8,
    crate::lanes::F32x16
);

impl<S: Scalar> Lift<Dual<S>> for Dual<S> {
    #[inline(always)]
    fn lift(self) -> Dual<S> {
        self
    }
}

impl<S: Scalar> Lift<Dual<Dual<S>>> for Dual<S> {
    #[inline(always)]
    fn lift(self) -> Dual<Dual<S>> {
        Dual { value: self, slope: Dual::zero() }
    }
}

/// The condition on the value of a run-time parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ParameterRule {
    /// It is a finite number.
    Finite,
    /// It is finite and not negative.
    NotNegative,
    /// It is finite and positive.
    Positive,
    /// It is an element of an inertia tensor about the centre of mass: xx, yy, zz, xy, yz, xz follow each other. The
    /// second moments of the mass, ½ tr(J) 1 − J, are positive semidefinite: principal moments are not negative, and
    /// none is larger than the sum of the others.
    Inertia,
    /// It is an element of a quaternion: x, y, z, w follow each other, and are not all zero.
    Quaternion,
}

/// A run-time parameter that violates its rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterError {
    /// Index of the parameter.
    pub index: usize,
    /// Its name.
    pub name: &'static str,
    /// The value given.
    pub value: f64,
    /// The rule that it violates.
    pub rule: ParameterRule,
}

impl fmt::Display for ParameterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ParameterError { name, value, rule, .. } = self;
        if !value.is_finite() {
            return write!(f, "parameter `{name}` is {value:?}: give a finite number");
        }
        match rule {
            ParameterRule::Finite => write!(f, "parameter `{name}` is {value:?}: give a finite number"),
            ParameterRule::NotNegative => write!(f, "parameter `{name}` is {value:?}: it must not be negative"),
            ParameterRule::Positive => write!(f, "parameter `{name}` is {value:?}: it must be positive"),
            ParameterRule::Inertia => write!(
                f,
                "the inertia tensor with `{name}` = {value:?} is not that of a body: its principal moments must not \
                 be negative, and none may be larger than the sum of the others"
            ),
            ParameterRule::Quaternion => {
                write!(f, "parameter `{name}` begins a quaternion of zeros: one of its four numbers must not be zero")
            }
        }
    }
}

impl core::error::Error for ParameterError {}

/// Roundoff allowed in the inequalities of a tensor, relative to its trace.
const DEFINITE: f64 = 1e-9;

/// Checks the values of run-time parameters, each with its name and rule.
///
/// # Errors
///
/// The first parameter that violates its rule; of an inertia tensor or a quaternion, its first element.
pub fn check_parameters<T: Real>(
    values: &[T],
    names: &[&'static str],
    rules: &[ParameterRule],
) -> Result<(), ParameterError> {
    let checked = || values.iter().zip(names).zip(rules).enumerate();
    let error = |index: usize, value: &T, name: &'static str, rule: ParameterRule| {
        Err(ParameterError { index, name, value: value.to_f64(), rule })
    };
    // All numbers first, so that a tensor is not reported for an element that is not a number.
    if let Some((index, ((value, &name), &rule))) = checked().find(|(_, ((value, _), _))| !value.is_finite()) {
        return error(index, value, name, rule);
    }
    let (mut element, mut component) = (0, 0);
    for (index, ((value, &name), &rule)) in checked() {
        let holds = match rule {
            ParameterRule::Finite => true,
            ParameterRule::NotNegative => *value >= T::zero(),
            ParameterRule::Positive => *value > T::zero(),
            ParameterRule::Inertia => {
                element = (element + 1) % 6;
                element != 1 || values.get(index..index + 6).is_none_or(is_inertia)
            }
            ParameterRule::Quaternion => {
                component = (component + 1) % 4;
                let is_zero = |quaternion: &[T]| quaternion.iter().all(|&component| component == T::zero());
                component != 1 || !values.get(index..index + 4).is_some_and(is_zero)
            }
        };
        if !holds {
            return error(index, value, name, rule);
        }
    }
    Ok(())
}

/// Whether a body can have the tensor xx, yy, zz, xy, yz, xz about its centre of mass: whether no principal minor of
/// ½ tr(J) 1 − J is negative.
fn is_inertia<T: Real>(tensor: &[T]) -> bool {
    let &[xx, yy, zz, xy, yz, xz] = tensor else { return true };
    let [xx, yy, zz, xy, yz, xz] = [xx, yy, zz, xy, yz, xz].map(T::to_f64);
    let trace = xx + yy + zz;
    if trace == 0.0 {
        return [xx, yy, zz, xy, yz, xz].iter().all(|&element| element == 0.0);
    }
    // Scaled, so that minors do not underflow.
    let [a, b, c] = [xx, yy, zz].map(|moment| 0.5 - moment / trace);
    let [ab, bc, ac] = [xy, yz, xz].map(|product| -product / trace);
    let determinant = a * (b * c - bc * bc) - ab * (ab * c - bc * ac) + ac * (ab * bc - b * ac);
    let roundoff = DEFINITE.max(8.0 * T::EPSILON.to_f64());
    let minors = [a, b, c, a * b - ab * ab, b * c - bc * bc, a * c - ac * ac, determinant];
    trace > 0.0 && minors.iter().all(|&minor| minor >= -roundoff)
}

#[cfg(test)]
mod tests {
    extern crate std;

    use super::*;
    use std::string::ToString;

    const NAMES: [&str; 6] = ["i.xx", "i.yy", "i.zz", "i.xy", "i.yz", "i.xz"];

    fn refused<T: Real>(tensor: [T; 6]) -> bool {
        check_parameters(&tensor, &NAMES, &[ParameterRule::Inertia; 6]).is_err()
    }

    #[test]
    fn rods_discs_and_points_have_inertias() {
        for [xx, yy, zz] in [[0.0; 3], [1.0, 1.0, 0.0], [1.0, 1.0, 2.0], [1e-9; 3]] {
            let tensor = [xx, yy, zz, 0.0, 0.0, 0.0];
            assert!(!refused(tensor) && !refused(tensor.map(|x| x as f32)), "{tensor:?}");
        }
    }

    #[test]
    fn tensors_that_no_body_has_are_refused() {
        let tensors = [
            [1.0, 1.0, 2.1, 0.0, 0.0, 0.0],
            [-1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 1.0, 1.5, 0.0, 0.0],
            [1.0, 1.0, 1.0, 0.4, 0.4, 0.4],
            [0.0, 0.0, 0.0, 0.1, 0.0, 0.0],
            [f64::NAN, 1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 1.0, 0.0, f64::INFINITY, 0.0],
        ];
        for tensor in tensors {
            assert!(refused(tensor), "{tensor:?}");
        }
    }

    #[test]
    fn quaternions_of_zeros_are_refused() {
        let (names, rules) = (["q.x", "q.y", "q.z", "q.w"].repeat(2), [ParameterRule::Quaternion; 8]);
        let check = |values: [f64; 8]| check_parameters(&values, &names, &rules);
        assert!(check([0.0, 0.0, 0.0, 1.0, -1e-300, 0.0, 0.0, 0.0]).is_ok());
        assert_eq!(check([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0]).unwrap_err().index, 4);
        let message = check([0.0; 8]).unwrap_err().to_string();
        assert!(message.starts_with("parameter `q.x` begins a quaternion of zeros"), "{message}");
    }

    #[test]
    fn errors_name_the_parameter_its_value_and_the_rule() {
        let rules = [ParameterRule::NotNegative, ParameterRule::Positive, ParameterRule::Finite];
        let error = |values: [f64; 3]| check_parameters(&values, &["tool.mass", "f", "g"], &rules).unwrap_err();
        assert_eq!(error([-1.0, 1.0, 0.0]).to_string(), "parameter `tool.mass` is -1.0: it must not be negative");
        assert_eq!(error([1.0, 0.0, 0.0]).to_string(), "parameter `f` is 0.0: it must be positive");
        assert_eq!(error([1.0, 1.0, f64::NAN]).to_string(), "parameter `g` is NaN: give a finite number");
        assert_eq!(error([1.0, 1.0, f64::NAN]).index, 2);
        let tensor = [1.0, 1.0, 1.0, 0.0, f64::INFINITY, 0.0];
        assert_eq!(check_parameters(&tensor, &NAMES, &[ParameterRule::Inertia; 6]).unwrap_err().name, "i.yz");
    }
}
