//! Where an explicit Runge-Kutta method is stable.

use crate::integrate::complex::Complex;
use crate::integrate::tableau::Tableau;

/// How much |R| may exceed 1: rounding, and a growth that no run is long enough to show.
const SLACK: f64 = 1e-6;
/// The distance between trials on a ray. Regions of stability have no narrower gaps.
const TRIAL: f64 = 0.02;

/// The stability function R of an explicit Runge-Kutta method: one step of ẏ = λ y multiplies y by R(h λ).
///
/// R(z) = 1 + z b·(I − z A)⁻¹ 1 = 1 + Σ z^(k+1) b·Aᵏ 1, a polynomial, since A is strictly lower triangular: E. Hairer
/// and G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., Springer (1996), section IV.2.
///
/// ```
/// use redysim_runtime::integrate::{stability::StabilityFunction, tableau::RUNGE_KUTTA_4};
///
/// let function = StabilityFunction::new(&RUNGE_KUTTA_4);
/// let (re, im) = function.at((-1.0, 0.0));
/// assert!((re - 0.375).abs() < 1e-15 && im == 0.0); // 1 − 1 + 1/2 − 1/6 + 1/24
/// assert!((function.reach((-1.0, 0.0)) - 2.785).abs() < 1e-3);
/// assert!((function.reach((0.0, 1.0)) - 8.0_f64.sqrt()).abs() < 1e-3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityFunction<const STAGES: usize> {
    /// Those of z⁰, z¹, …
    coefficients: [f64; STAGES],
}

impl<const STAGES: usize> StabilityFunction<STAGES> {
    /// That of the formula that goes on.
    pub fn new(tableau: &Tableau<STAGES>) -> Self {
        // Aᵏ 1, for the stages before the one at the end of the step, whose row of A is b.
        let mut powers = [1.0; STAGES];
        let mut coefficients = [0.0; STAGES];
        let mut next = 1.0;
        for coefficient in coefficients.iter_mut().take(tableau.main) {
            *coefficient = next;
            let products = tableau.rows.map(|row| row.iter().zip(&powers).map(|(a, power)| a * power).sum::<f64>());
            next = tableau.main.checked_sub(1).and_then(|last| products.get(last)).copied().unwrap_or(0.0);
            powers = products;
        }
        Self { coefficients }
    }

    /// Real and imaginary part of R(z) for those of z.
    pub fn at(&self, (re, im): (f64, f64)) -> (f64, f64) {
        let value = self.value(Complex { re, im });
        (value.re, value.im)
    }

    /// The largest r with |R(s z)| ≤ 1 for all s from 0 to r, up to 10⁻⁶ in |R|; at most 100.
    pub fn reach(&self, (re, im): (f64, f64)) -> f64 {
        let stable = |r: f64| self.value(Complex { re: r * re, im: r * im }).abs() <= 1.0 + SLACK;
        let size = Complex { re, im }.abs();
        let trial = |k: u32| TRIAL * f64::from(k) / size;
        let Some(unstable) = (1..=5000).find(|&k| !stable(trial(k))) else { return 100.0 / size };
        let (mut inside, mut outside) = (trial(unstable - 1), trial(unstable));
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            *if stable(middle) { &mut inside } else { &mut outside } = middle;
        }
        inside
    }

    fn value(&self, z: Complex<f64>) -> Complex<f64> {
        self.coefficients.iter().rfold(Complex::default(), |sum, &c| sum * z + Complex::real(c))
    }
}
