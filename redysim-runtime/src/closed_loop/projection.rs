//! Back to closed loops after a step of integration.

use super::closing::Closing;
use super::linear::largest;
use super::linearised::Metric;
use super::{ClosedLoop, LoopError};
use crate::vector::entry;
use crate::{LoopClosure, MassMatrix, Real, Vector};

/// A handful of iterations are enough from near; where the mechanism is singular, each only halves the error.
const ITERATIONS: usize = 20;

/// A position and a velocity that keep the loops closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection<S, Q, V> {
    /// Joint coordinates.
    pub q: Q,
    /// Joint velocities.
    pub v: V,
    /// The largest component of the residual that is left, m (or a sine).
    pub gap: S,
    /// How many rows are independent there.
    pub rank: usize,
}

impl<M, C> ClosedLoop<'_, M, C> {
    /// The nearest position and velocity, in the metric of M, that keep the loops closed.
    ///
    /// Positions by Newton's method, δq = −M⁻¹Jᵀ (J M⁻¹ Jᵀ)⁺ r, until the residual r is below 10⁻¹⁴ of the mechanism's
    /// size or shrinks no more; velocities by v − M⁻¹Jᵀ (J M⁻¹ Jᵀ)⁺ J v. The pseudo-inverse leaves alone what a
    /// singular position does not determine.
    ///
    /// # Errors
    /// [`LoopError::NoConvergence`] if more than 10⁻⁶ of the mechanism's size (3·10⁻³ in `f32`) stays open;
    /// [`LoopError::SingularInertia`] and [`LoopError::NotFinite`].
    pub fn project<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
    ) -> Result<Projection<S, M::Coordinates, M::Velocities>, LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let (closing, v) = self.nearest(q, v)?;
        Ok(Projection { q: closing.q, v, gap: closing.gap, rank: closing.at.space.rank() })
    }

    /// The projection, and the loops there.
    #[allow(clippy::type_complexity, reason = "the sizes come from the types")]
    pub(super) fn nearest<S: Real>(
        &self,
        q: &M::Coordinates,
        v: &M::Velocities,
    ) -> Result<(Closing<S, M, C>, M::Velocities), LoopError<S>>
    where
        M: MassMatrix<S>,
        C: LoopClosure<S, M>,
    {
        let closing = self.close(Metric::Mass, q.clone(), &[], ITERATIONS)?;
        let open = S::from_f64(1e-6).maximum(S::from_f64(10.0) * S::EPSILON.sqrt());
        if closing.gap > open * closing.at.scale() {
            return Err(LoopError::NoConvergence { gap: closing.gap, row: closing.row });
        }
        // A velocity that a `Vec` lacks is NaN, and seen to be.
        let apart = closing.at.pulling_apart(v);
        let v = M::Velocities::from_fn(self.mechanism.nv(), |i| entry(v, i) - entry(&apart, i));
        if !largest(v.as_ref().iter().copied()).0.is_finite() {
            return Err(LoopError::NotFinite);
        }
        Ok((closing, v))
    }
}
