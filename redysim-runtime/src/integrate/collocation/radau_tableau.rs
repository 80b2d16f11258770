//! The coefficients of the method Radau IIA with 3 stages.

use crate::integrate::complex::Complex;

const SQRT_6: f64 = 2.449_489_742_783_178;

/// The method Radau IIA of order 5: *Solving Ordinary Differential Equations II*, table IV.5.6, and in the form that is
/// computed with, by the eigenvectors of the inverse of its matrix (section IV.8).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadauTableau {
    /// c, the times of the stages in units of the step. The last stage is the end of the step.
    pub nodes: [f64; 3],
    /// a.
    pub matrix: [[f64; 3]; 3],
    /// The polynomials p_k of the collocation polynomial, u(t + θ h) = y + Σ p_k(θ) z_k through the stages y + z_k:
    /// coefficients of θ, θ², θ³.
    pub dense: [&'static [f64]; 3],
    /// The estimated error is (λ/h I − J)⁻¹ (f(t, y) + Σ e_k z_k / h), λ the real eigenvalue, with these e.
    pub error: [f64; 3],
    /// The real eigenvalue of a⁻¹.
    pub real: Eigenspace<f64>,
    /// The complex eigenvalue of a⁻¹ with the positive imaginary part.
    pub(super) complex: Eigenspace<Complex<f64>>,
}

/// A simple eigenvalue λ of a⁻¹ with w a⁻¹ = λ w and a⁻¹ v = λ v, w v = 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eigenspace<T> {
    /// λ.
    pub value: T,
    /// w.
    pub left: [T; 3],
    /// v.
    pub right: [T; 3],
}

/// Radau IIA of order 5.
pub const RADAU_IIA_5: RadauTableau = RadauTableau {
    nodes: [(4.0 - SQRT_6) / 10.0, (4.0 + SQRT_6) / 10.0, 1.0],
    matrix: [
        [(88.0 - 7.0 * SQRT_6) / 360.0, (296.0 - 169.0 * SQRT_6) / 1800.0, (-2.0 + 3.0 * SQRT_6) / 225.0],
        [(296.0 + 169.0 * SQRT_6) / 1800.0, (88.0 + 7.0 * SQRT_6) / 360.0, (-2.0 - 3.0 * SQRT_6) / 225.0],
        [(16.0 - SQRT_6) / 36.0, (16.0 + SQRT_6) / 36.0, 1.0 / 9.0],
    ],
    dense: [
        &[(13.0 + 7.0 * SQRT_6) / 3.0, -(23.0 + 22.0 * SQRT_6) / 3.0, (10.0 + 15.0 * SQRT_6) / 3.0],
        &[(13.0 - 7.0 * SQRT_6) / 3.0, -(23.0 - 22.0 * SQRT_6) / 3.0, (10.0 - 15.0 * SQRT_6) / 3.0],
        &[1.0 / 3.0, -8.0 / 3.0, 10.0 / 3.0],
    ],
    error: [-(13.0 + 7.0 * SQRT_6) / 3.0, -(13.0 - 7.0 * SQRT_6) / 3.0, -1.0 / 3.0],
    // 3 + ∛9 − ∛3; the other two are 3 − (∛9 − ∛3)/2 ± i (∛9 + ∛3) √3/2. The right vectors end in 1.
    real: Eigenspace {
        value: 3.637_834_252_744_496,
        left: [4.178_718_591_551_904, 0.327_682_820_761_062_37, 0.523_376_445_499_449_5],
        right: [0.094_438_762_488_975_24, 0.250_213_122_965_333_3, 1.0],
    },
    complex: Eigenspace {
        value: Complex { re: 2.681_082_873_627_752, im: 3.050_430_199_247_410_5 },
        left: [
            Complex { re: -2.089_359_295_775_952_6, im: -0.251_436_317_472_893_47 },
            Complex { re: -0.163_841_410_380_531_18, im: 1.285_963_474_927_802_6 },
            Complex { re: 0.238_311_777_250_275_22, im: -0.298_019_602_414_112_46 },
        ],
        right: [
            Complex { re: -0.141_255_295_020_954_2, im: 0.030_029_194_105_147_424 },
            Complex { re: 0.204_129_352_293_799_94, im: -0.382_942_112_757_261_9 },
            Complex { re: 1.0, im: 0.0 },
        ],
    },
};

/// Where the solution within a step is known beside its end, in units of the step. Of a stiff equation the slopes have
/// the order of the stages, 3; with these nodes that costs less than the collocation polynomial errs there, and where
/// the equation is not stiff the interpolation of degree 6 errs by 1.2·10⁻⁷ y⁽⁷⁾ h⁷ at most.
pub(super) const WITHIN_NODES: [f64; 2] = [1.0 / 4.0, 5.0 / 8.0];

/// Where the interpolation is compared with the solution, in units of the step: about where both the interpolation and
/// what the slopes err have their largest effect.
pub(super) const CHECKED_NODE: f64 = 1.0 / 12.0;

/// The polynomials of θ, without constant terms, that are 1 at one of the [`WITHIN_NODES`] or at 1, and those whose
/// slope is 1 there; the values and slopes at the others are 0.
pub(super) const WITHIN: [&[f64]; 6] = [
    &[0.0, 6400.0 / 81.0, -33280.0 / 81.0, 21248.0 / 27.0, -53248.0 / 81.0, 16384.0 / 81.0],
    &[4096.0 / 405.0, -8192.0 / 75.0, 167936.0 / 405.0, -1359872.0 / 2025.0, 65536.0 / 135.0, -262144.0 / 2025.0],
    &[250.0 / 81.0, -3025.0 / 81.0, 4520.0 / 27.0, -27856.0 / 81.0, 26368.0 / 81.0, -1024.0 / 9.0],
    &[-400.0 / 81.0, 3680.0 / 81.0, -12304.0 / 81.0, 19264.0 / 81.0, -14336.0 / 81.0, 4096.0 / 81.0],
    &[-256.0 / 81.0, 14848.0 / 405.0, -12544.0 / 81.0, 118784.0 / 405.0, -20480.0 / 81.0, 32768.0 / 405.0],
    &[-25.0 / 81.0, 305.0 / 81.0, -1384.0 / 81.0, 2896.0 / 81.0, -2816.0 / 81.0, 1024.0 / 81.0],
];

#[cfg(test)]
mod tests {
    use super::super::value_and_slope;
    use super::*;

    fn real(re: f64) -> Complex<f64> {
        Complex { re, im: 0.0 }
    }

    fn near(found: Complex<f64>, expected: Complex<f64>) {
        let Complex { re, im } = found - expected;
        assert!(re.hypot(im) < 1e-14, "{found:?} instead of {expected:?}");
    }

    fn dot(a: impl IntoIterator<Item = Complex<f64>>, b: [Complex<f64>; 3]) -> Complex<f64> {
        a.into_iter().zip(b).fold(real(0.0), |sum, (a, b)| sum + a * b)
    }

    /// λ w a = w, a v = v/λ and w v = 1; the vectors of different eigenvalues are orthogonal.
    #[test]
    fn the_eigenvectors_are_those_of_the_matrix() {
        let RadauTableau { matrix, real: r, complex: c, .. } = RADAU_IIA_5;
        let r = Eigenspace { value: real(r.value), left: r.left.map(real), right: r.right.map(real) };
        for Eigenspace { value, left, right } in [r, c] {
            for k in 0..3 {
                near(value * dot(matrix.map(|row| real(row[k])), left), left[k]);
                near(value * dot(matrix[k].map(real), right), right[k]);
            }
            near(dot(left, right), real(1.0));
        }
        near(dot(r.left, c.right), real(0.0));
        near(dot(c.left, r.right), real(0.0));
    }

    /// The characteristic polynomial of a⁻¹ is λ³ − 9 λ² + 36 λ − 60.
    #[test]
    fn the_eigenvalues_are_the_poles_of_the_stability_function() {
        for value in [real(RADAU_IIA_5.real.value), RADAU_IIA_5.complex.value] {
            near(((value - real(9.0)) * value + real(36.0)) * value * real(1.0 / 60.0), real(1.0));
        }
    }

    #[test]
    fn the_polynomials_within_a_step_have_their_values_and_slopes_at_the_nodes() {
        let nodes = [WITHIN_NODES[0], WITHIN_NODES[1], 1.0];
        for (k, coefficients) in WITHIN.iter().enumerate() {
            for (j, x) in nodes.into_iter().enumerate() {
                let (value, slope) = value_and_slope(coefficients, x);
                let expected = [f64::from(u8::from(k == j)), f64::from(u8::from(k == j + 3))];
                assert!((value - expected[0]).abs() < 1e-11 && (slope - expected[1]).abs() < 1e-11, "{k} at {x}");
            }
        }
    }
}
