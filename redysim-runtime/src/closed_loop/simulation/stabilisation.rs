//! What keeps loops closed while a simulation runs.

use crate::Real;
use crate::closed_loop::LoopError;

/// From here on, the product of Baumgarte's α and the step h is known to blow up (the classical Runge-Kutta method, and
/// with it the others here, loses stability for a double root −α at α h = 2.8; with the nonlinear loops, from 1.3).
const LARGEST_PRODUCT: f64 = 1.3;

/// How a simulation keeps its loops closed against the errors of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Stabilisation<S> {
    /// After each accepted step, position and velocity go to the nearest ones that close the loops: at the ends of
    /// steps the residual stays at rounding size. At times within a step it is as small as the method is accurate;
    /// where that matters, [`ClosedLoop::project`](crate::ClosedLoop::project) closes a state.
    #[default]
    Projection,
    /// Baumgarte's feedback, critically damped: J a = −J̇ q̇ − 2 α J q̇ − α² r. It changes no state, and leaves a
    /// residual that depends on α and the step. Steps with α h ≥ 1.3 are refused. It is not for motion through singular
    /// positions: there it goes wrong, and the smaller the steps, the sooner; nor backward in time, where feedback
    /// drives apart what it should hold.
    Baumgarte {
        /// α, 1/s.
        alpha: S,
    },
    /// Nothing (plain index-1 integration): the loops drift apart. For comparison.
    None,
}

impl<S: Real> Stabilisation<S> {
    /// Checks whether steps of size `step`, s, are known to be unstable.
    ///
    /// # Errors
    /// [`LoopError::InvalidAlpha`] and [`LoopError::UnstableBaumgarte`].
    pub fn check(&self, step: S) -> Result<(), LoopError<S>> {
        match *self {
            Self::Baumgarte { alpha } if !(alpha > S::zero() && alpha.is_finite()) => {
                Err(LoopError::InvalidAlpha { alpha })
            }
            Self::Baumgarte { alpha } if alpha * step.abs() < S::from_f64(LARGEST_PRODUCT) => Ok(()),
            Self::Baumgarte { alpha } => Err(LoopError::UnstableBaumgarte { alpha, step }),
            Self::Projection | Self::None => Ok(()),
        }
    }
}
