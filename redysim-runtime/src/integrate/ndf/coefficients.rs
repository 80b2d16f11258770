//! Coefficients of the numerical differentiation formulas.

use crate::Real;

/// The highest order there are formulas of; those of BDF from order 7 on are not stable.
pub const HIGHEST_ORDER: usize = 5;

/// κ of the numerical differentiation formulas of orders 1 to 5, which allow steps larger than those of BDF by 26, 26,
/// 26, 12 and 0 %, with hardly less stability: L. F. Shampine, M. W. Reichelt, *The MATLAB ODE Suite*, SIAM J. Sci.
/// Comput. 18 (1997), table 1.
pub const NUMERICAL_DIFFERENTIATION: [f64; HIGHEST_ORDER] = [-0.1850, -1.0 / 9.0, -0.0823, -0.0415, 0.0];

/// κ = 0: the backward differentiation formulas.
pub const BACKWARD_DIFFERENTIATION: [f64; HIGHEST_ORDER] = [0.0; HIGHEST_ORDER];

/// γ_k = Σ_{j=1}^k 1/j.
pub const GAMMA: [f64; HIGHEST_ORDER] = [1.0, 3.0 / 2.0, 11.0 / 6.0, 25.0 / 12.0, 137.0 / 60.0];

/// The formula of one order k for the end of a step, in backward differences ∇ of constant step size h.
///
/// Σ_{m=1}^k (1/m) ∇^m y_{n+1} − h f(t_{n+1}, y_{n+1}) − κ γ_k (y_{n+1} − ŷ) = 0 with ŷ = Σ_{m=0}^k ∇^m y_n.
///
/// In the correction d = y_{n+1} − ŷ = ∇^{k+1} y_{n+1} it is (1 − κ) γ_k d + Σ_{m=1}^k γ_m ∇^m y_n = h f(t_{n+1}, ŷ +
/// d) (section 2.1 of the paper).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// (1 − κ) γ_k, which d is multiplied by.
    pub leading: f64,
    /// κ γ_k + 1/(k + 1): the error of the step is this times ∇^{k+1} y.
    pub error: f64,
}

impl Coefficients {
    /// The formula of `order` with the κ of `kappas`; `None` if `kappas` has no entry for that order.
    pub fn new(kappas: &[f64], order: usize) -> Option<Self> {
        let index = order.checked_sub(1)?;
        let (&kappa, &gamma) = kappas.get(index).zip(GAMMA.get(index))?;
        Some(Self { leading: (1.0 - kappa) * gamma, error: kappa * gamma + 1.0 / (order as f64 + 1.0) })
    }
}

/// x (x + 1) … (x + j − 1) / j!: the polynomial that belongs to ∇^j y_n where one interpolates to t_n + x h.
pub fn newton_polynomial<S: Real>(j: usize, x: S) -> S {
    (0..j).map(|m| m as f64).fold(S::one(), |product, m| product * (x + S::from_f64(m)) / S::from_f64(m + 1.0))
}

/// The polynomials of [`newton_polynomial`], j = 1 to 5, by coefficients of x, x², …
const W1: &[f64] = &[1.0];
const W2: &[f64] = &[1.0 / 2.0, 1.0 / 2.0];
const W3: &[f64] = &[1.0 / 3.0, 1.0 / 2.0, 1.0 / 6.0];
const W4: &[f64] = &[1.0 / 4.0, 11.0 / 24.0, 1.0 / 4.0, 1.0 / 24.0];
const W5: &[f64] = &[1.0 / 5.0, 5.0 / 12.0, 7.0 / 24.0, 1.0 / 12.0, 1.0 / 120.0];

/// For each order k the polynomials in θ that ∇y_n, …, ∇^k y_n and ∇^{k+1} y_{n+1} are multiplied by in
/// y(t_n + θ h) − y_n, the polynomial of degree k through y_{n+1}, y_n, …, y_{n+1−k}. It has
/// ∇^k y_{n+1} = ∇^k y_n + ∇^{k+1} y_{n+1}, so that the last one is the one before it once more.
pub const DENSE: [&[&[f64]]; HIGHEST_ORDER] =
    [&[W1, W1], &[W1, W2, W2], &[W1, W2, W3, W3], &[W1, W2, W3, W4, W4], &[W1, W2, W3, W4, W5, W5]];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_is_the_harmonic_sum() {
        for (k, gamma) in (1..).zip(GAMMA) {
            let sum: f64 = (1..=k).map(|j| 1.0 / f64::from(j)).sum();
            assert!((gamma - sum).abs() < 1e-15, "γ_{k} = {gamma}, not {sum}");
        }
    }

    /// The paper's table 1: by how much a step may be larger for the same error, (bdf / ndf)^(1/(k+1)) − 1.
    #[test]
    fn steps_are_larger_than_those_of_bdf_by_the_published_percentages() {
        for (order, percent) in (1..).zip([26.0, 26.0, 26.0, 12.0, 0.0]) {
            let [ndf, bdf] = [NUMERICAL_DIFFERENTIATION, BACKWARD_DIFFERENTIATION]
                .map(|kappas| Coefficients::new(&kappas, order).unwrap().error);
            let gain = 100.0 * (libm::pow(bdf / ndf, 1.0 / (order as f64 + 1.0)) - 1.0);
            assert!((gain - percent).abs() < 0.5, "order {order}: {gain} % instead of {percent} %");
        }
    }

    #[test]
    fn there_are_formulas_of_the_given_orders_only() {
        assert!(Coefficients::new(&NUMERICAL_DIFFERENTIATION, 0).is_none());
        assert!(Coefficients::new(&NUMERICAL_DIFFERENTIATION, 6).is_none());
        assert!(Coefficients::new(&NUMERICAL_DIFFERENTIATION[..2], 3).is_none());
    }

    #[test]
    fn the_weights_within_a_step_are_newtons_polynomials() {
        for (order, weights) in (1..).zip(DENSE) {
            assert_eq!(weights.len(), order + 1);
            for (j, weight) in (1..).zip(weights.iter()) {
                for theta in [-1.0, 0.0, 0.3, 1.0, 2.0] {
                    let value = weight.iter().rfold(0.0, |sum, c| theta * (c + sum));
                    let expected = newton_polynomial(j.min(order), theta);
                    assert!((value - expected).abs() < 1e-15, "order {order}, {j}: {value} instead of {expected}");
                }
            }
        }
    }
}
