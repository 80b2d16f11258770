//! The interval of integration.

use super::IntegrationError;
use crate::Real;

/// Two finite, different times, in the order in which integration meets them.
#[derive(Clone, Copy)]
pub(super) struct Interval<S> {
    pub from: S,
    pub to: S,
}

impl<S: Real> Interval<S> {
    pub fn new((from, to): (S, S)) -> Result<Self, IntegrationError<S>> {
        // The difference covers ends that are not finite, and finite ends too far apart.
        if from != to && (to - from).is_finite() {
            Ok(Self { from, to })
        } else {
            Err(IntegrationError::InvalidInterval { from, to })
        }
    }

    pub fn length(&self) -> S {
        (self.to - self.from).abs()
    }

    /// The time `size` after `t`, seen in the direction of integration.
    pub fn advance(&self, t: S, size: S) -> S {
        if self.to > self.from { t + size } else { t - size }
    }

    /// Whether `t` is `other` or comes after it, seen in the direction of integration. Never true of NaN.
    pub fn reaches(&self, t: S, other: S) -> bool {
        if self.to > self.from { t >= other } else { t <= other }
    }

    pub fn contains(&self, t: S) -> bool {
        self.reaches(t, self.from) && self.reaches(self.to, t)
    }

    /// The smallest step from `t`: 16 spacings of floating-point numbers, as in MATLAB, which is enough for the stages
    /// to differ in time. At t = 0, where the spacing vanishes, a part of the interval too small to matter takes over.
    pub fn smallest_step(&self, t: S) -> S {
        S::from_f64(16.0) * S::EPSILON * t.abs().maximum(S::EPSILON * self.length())
    }
}
