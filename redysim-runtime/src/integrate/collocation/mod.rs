//! Collocation methods, of Gauss and of Radau.
//!
//! A step follows the polynomial u that starts at the state and satisfies the equation, u̇ = f(t, u), at the nodes
//! t + c_i h (E. Hairer, S. P. Nørsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd
//! ed., Springer (1993), section II.7). All stages depend on each other and are found by iteration; continued beyond
//! the end of the step, u is where the iteration of the next step begins.
//!
//! Between its ends u is of lower order than at them. For dense output, `bootstrap` makes a more accurate polynomial
//! for the methods of Gauss, and that of Radau takes two shorter steps.
//!
//! [`Gauss`] is for long conservative motion, [`Radau`] for stiff equations.

mod bootstrap;
pub(super) mod gauss;
pub(super) mod radau;
mod radau_tableau;
mod stage_solver;

pub use gauss::{GAUSS_LEGENDRE_2, GAUSS_LEGENDRE_3, Gauss, GaussTableau};
pub use radau::Radau;
pub use radau_tableau::{Eigenspace, RADAU_IIA_5, RadauTableau};

use super::step::{weighted_sum, without_constant};
use crate::{Real, Vector};

/// Writes u(1 + c_i r) − u(1), what the polynomial u(θ) = y + `scale` Σ p_k(θ) `stages`_k of the last step says of the
/// stages of the next one, to `starts`. The next step is r = `ratio` times as long, and the p_k have the coefficients
/// `dense`, of θ, θ², …
fn extrapolate<S: Real, Y: Vector<S>, const STAGES: usize>(
    (dense, nodes): (&[&[f64]; STAGES], &[f64; STAGES]),
    ratio: S,
    scale: S,
    stages: &[Y; STAGES],
    starts: &mut [Y; STAGES],
) {
    for (start, &node) in starts.iter_mut().zip(nodes) {
        let theta = S::one() + ratio * S::from_f64(node);
        let weight = |p: &&[f64]| scale * (without_constant(p, theta) - without_constant(p, S::one()));
        weighted_sum(dense.iter().map(weight), stages, start);
    }
}

/// c₁ x + c₂ x² + … and its derivative.
#[cfg(test)]
fn value_and_slope(coefficients: &[f64], x: f64) -> (f64, f64) {
    coefficients.iter().rfold((0.0, 0.0), |(value, slope), c| (x * (c + value), c + value + x * slope))
}
