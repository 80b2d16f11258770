//! Precomputed joint trigonometry.

use crate::Scalar;

/// The coordinates of a mechanism with the sines and cosines of its angles. `joint_trig(&q)` of a compiled type computes
/// it, and its functions `…_with_trig` take it.
///
/// Half of the time of a small mechanism's inverse dynamics goes into sines and cosines. A controller that wants
/// inverse dynamics, mass matrix and kinematics at one position computes them once:
///
/// ```text
/// let trig = Kr5::joint_trig(&q);
/// let torques = Kr5::inverse_dynamics_with_trig(&trig, &v, &a);
/// let inertia = Kr5::mass_matrix_with_trig(&trig);
/// ```
///
/// `Q` is the number of coordinates, `A` that of angles: the joint angles with their offsets, and sums of them where
/// that is cheaper. Angles of single joints come first, in the order of the coordinates, then sums.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointTrig<S, const Q: usize, const A: usize> {
    /// The coordinates, rad or m.
    pub q: [S; Q],
    /// The sine of each angle.
    pub sin: [S; A],
    /// The cosine of each angle.
    pub cos: [S; A],
}

impl<S: Scalar, const Q: usize, const A: usize> JointTrig<S, Q, A> {
    /// The coordinates `q` with the sines and cosines that were computed from them.
    #[doc(hidden)]
    #[inline(always)]
    pub fn new(q: &[S; Q], sin: &[S; A], cos: &[S; A]) -> Self {
        JointTrig { q: S::apart(*q), sin: S::apart(*sin), cos: S::apart(*cos) }
    }
}
