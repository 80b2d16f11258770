//! What tolerances mean.

use super::IntegrationError;
use crate::{Real, Vector};

/// How far from roundoff an iteration may stop, in roundoff units.
const ROUNDOFF_UNITS: f64 = 1024.0;

/// |e_i| ≤ max(rtol |y_i|, atol_i).
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S: serde::Serialize", deserialize = "S: serde::Deserialize<'de>"))
)]
pub struct Tolerances<'a, S> {
    pub(super) relative: S,
    pub(super) absolute: Absolute<'a, S>,
}

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S: serde::Serialize", deserialize = "S: serde::Deserialize<'de>"))
)]
pub(super) enum Absolute<'a, S> {
    All(S),
    // A borrowed list has no owner when it is read.
    #[cfg_attr(feature = "serde", serde(skip_deserializing))]
    Each(&'a [S]),
}

impl<S> Tolerances<'_, S> {
    /// The relative tolerance, and one absolute tolerance for all components, in the units of the state.
    pub fn new(relative: S, absolute: S) -> Self {
        Self { relative, absolute: Absolute::All(absolute) }
    }
}

impl<S: Real> Tolerances<'_, S> {
    /// What steps of a given size solve by iteration, they solve nearly to roundoff. Components below 1 count as 1: one
    /// that comes to rest has the rounding errors of others in it, and differences of the derivative need some room.
    pub(super) fn roundoff() -> Self {
        let relative = S::from_f64(ROUNDOFF_UNITS) * S::EPSILON;
        Self::new(relative, relative)
    }

    /// rtol.
    pub fn relative(&self) -> S {
        self.relative
    }

    /// The smallest relative tolerance that steps can keep: 100 roundoff units.
    pub fn smallest_relative() -> S {
        S::from_f64(100.0) * S::EPSILON
    }

    /// Checks the tolerances for a state of `len` components.
    pub fn check(&self, len: usize) -> Result<(), IntegrationError<S>> {
        let smallest = Self::smallest_relative();
        if !(self.relative >= smallest && self.relative.is_finite()) {
            return Err(IntegrationError::InvalidRelativeTolerance { value: self.relative, smallest });
        }
        let bad = |value: S| !(value > S::zero() && value.is_finite());
        match self.absolute {
            Absolute::All(value) if bad(value) => {
                Err(IntegrationError::InvalidAbsoluteTolerance { component: None, value })
            }
            Absolute::Each(values) if values.len() != len => {
                Err(IntegrationError::WrongToleranceCount { given: values.len(), needed: len })
            }
            Absolute::Each(values) => match values.iter().position(|&value| bad(value)) {
                Some(component) => Err(IntegrationError::InvalidAbsoluteTolerance {
                    component: Some(component),
                    value: values[component],
                }),
                None => Ok(()),
            },
            Absolute::All(_) => Ok(()),
        }
    }

    /// max_i |x_i| / max(|y_i|, |z_i|, atol_i / rtol): as large as rtol where x just meets the tolerance. Infinite if
    /// any part of it is not a finite number.
    pub fn norm<Y: Vector<S>>(&self, x: &Y, y: &Y, z: &Y) -> S {
        let sizes = y.as_ref().iter().zip(z.as_ref()).map(|(y, z)| y.abs().maximum(z.abs()));
        let norm = x
            .as_ref()
            .iter()
            .zip(sizes)
            .enumerate()
            .fold(S::zero(), |norm, (component, (x, size))| norm.maximum(self.weighed(component, *x, size)));
        finite(norm)
    }

    /// The error `x` of a component whose magnitude is `size`, |x| / max(size, atol_i / rtol).
    pub(crate) fn weighed(&self, component: usize, x: S, size: S) -> S {
        x.abs() / size.maximum(self.threshold(component))
    }

    /// The size below which the absolute tolerance of a component is the larger one.
    pub(crate) fn threshold(&self, component: usize) -> S {
        match self.absolute {
            Absolute::All(value) => value / self.relative,
            Absolute::Each(values) => values.get(component).map_or(S::zero(), |&value| value / self.relative),
        }
    }
}

/// `norm`, or infinity where it is not a finite number.
pub(crate) fn finite<S: Real>(norm: S) -> S {
    if norm.is_finite() { norm } else { S::from_f64(f64::INFINITY) }
}
