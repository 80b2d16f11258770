//! Coordinates with the sines and cosines that are computed from them.

use crate::Scalar;

/// Coordinates of a mechanism with the sines and cosines of its angles: what a compiled type computes by `posture(&q)`,
/// and its functions `…_at` take.
///
/// Half of the time of a small mechanism's inverse dynamics goes into sines and cosines. A controller that wants
/// inverse dynamics, mass matrix and kinematics at one position computes them once:
///
/// ```text
/// let at = Kr5::posture(&q);
/// let torques = Kr5::inverse_dynamics_at(&at, &v, &a);
/// let inertia = Kr5::mass_matrix_at(&at);
/// ```
///
/// `Q` is the number of coordinates, `A` that of angles: the joint angles with their offsets, and sums of them where
/// that is cheaper. Angles of single joints come first, in the order of the coordinates, then sums.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posture<S, const Q: usize, const A: usize> {
    /// The coordinates, rad or m.
    pub q: [S; Q],
    /// The sine of each angle.
    pub sin: [S; A],
    /// The cosine of each angle.
    pub cos: [S; A],
}

impl<S: Scalar, const Q: usize, const A: usize> Posture<S, Q, A> {
    /// The coordinates `q` with the sines and cosines that were computed from them.
    #[doc(hidden)]
    #[inline(always)]
    pub fn new(q: &[S; Q], sin: &[S; A], cos: &[S; A]) -> Self {
        Posture { q: S::apart(*q), sin: S::apart(*sin), cos: S::apart(*cos) }
    }
}
