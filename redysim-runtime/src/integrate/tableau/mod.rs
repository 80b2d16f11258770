//! Coefficients of explicit Runge-Kutta methods.

mod dormand_prince_853;

pub use dormand_prince_853::DORMAND_PRINCE_853;

/// An explicit Runge-Kutta method of `STAGES` stages with an error estimate and a continuous extension.
///
/// Stage k evaluates f_k = f(t + c_k h, y + h Σ_j a_kj f_j). The last main stage is taken at the end of the step, so
/// that its row of a gives the new state and its derivative is the first stage of the next step ("first same as last").
/// Every explicit method can be written so: one whose last stage lies elsewhere gets its weights b as one more row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tableau<const STAGES: usize> {
    /// a, below the diagonal: row k has k entries.
    pub rows: [&'static [f64]; STAGES],
    /// c, the times of the stages in units of the step.
    pub nodes: [f64; STAGES],
    /// How many stages a step takes. Those after them are evaluated only for a step within which the solution is asked
    /// for.
    pub main: usize,
    /// How the error of a step is estimated.
    pub error: ErrorEstimate<STAGES>,
    /// The power of the step size that the estimated error goes with.
    pub error_exponent: u32,
    /// How far the method is stable on the negative real axis: the largest z with |R(−z)| ≤ 1.
    pub stable_to: f64,
    /// The polynomials b_k of the continuous extension, y(t + θ h) ≈ y + h Σ b_k(θ) f_k: coefficients of θ, θ², …
    pub dense: [&'static [f64]; STAGES],
}

/// How the error of a step follows from its stages.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ErrorEstimate<const STAGES: usize> {
    /// h Σ d_k f_k, the difference from an embedded formula of lower order.
    Embedded([f64; STAGES]),
    /// e² / √(e² + 0.01 ẽ²) of the differences e and ẽ from two embedded formulas. The one of lower order guards
    /// against an e that is small by chance: E. Hairer, S. P. Nørsett and G. Wanner, *Solving Ordinary Differential
    /// Equations I*, 2nd ed., Springer (1993), section II.10.
    Stretched {
        /// d of the formula of higher order.
        higher: [f64; STAGES],
        /// d of the formula of lower order.
        lower: [f64; STAGES],
    },
}

/// The pair of orders 5 and 4 of Dormand and Prince.
///
/// J. R. Dormand and P. J. Prince, *A family of embedded Runge-Kutta formulae*, J.
/// Comput. Appl. Math. 6 (1980), table 2, with the continuous extension of order 4 of L. F. Shampine, *Some practical
/// Runge-Kutta formulas*, Math. Comp. 46 (1986).
pub const DORMAND_PRINCE: Tableau<7> = Tableau {
    rows: [
        &[],
        &[1.0 / 5.0],
        &[3.0 / 40.0, 9.0 / 40.0],
        &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
        &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
        &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
        &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
    ],
    nodes: [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0],
    main: 7,
    error: ErrorEstimate::Embedded([
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ]),
    error_exponent: 5,
    stable_to: 3.3066,
    dense: [
        &[1.0, -183.0 / 64.0, 37.0 / 12.0, -145.0 / 128.0],
        &[],
        &[0.0, 1500.0 / 371.0, -1000.0 / 159.0, 1000.0 / 371.0],
        &[0.0, -125.0 / 32.0, 125.0 / 12.0, -375.0 / 64.0],
        &[0.0, 9477.0 / 3392.0, -729.0 / 106.0, 25515.0 / 6784.0],
        &[0.0, -11.0 / 7.0, 11.0 / 3.0, -55.0 / 28.0],
        &[0.0, 3.0 / 2.0, -4.0, 5.0 / 2.0],
    ],
};

/// The classical method of order 4 of Kutta.
///
/// W. Kutta, *Beitrag zur näherungsweisen Integration totaler Differentialgleichungen*, Z. Math. Phys. 46 (1901), with
/// the derivative at the end of the step as fifth stage. The continuous extension is the cubic Hermite polynomial through
/// both ends. The method does not estimate its error.
pub const RUNGE_KUTTA_4: Tableau<5> = Tableau {
    rows: [&[], &[1.0 / 2.0], &[0.0, 1.0 / 2.0], &[0.0, 0.0, 1.0], &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]],
    nodes: [0.0, 1.0 / 2.0, 1.0 / 2.0, 1.0, 1.0],
    main: 5,
    error: ErrorEstimate::Embedded([0.0; 5]),
    error_exponent: 4,
    stable_to: 2.7853,
    dense: [
        &[1.0, -3.0 / 2.0, 2.0 / 3.0],
        &[0.0, 1.0, -2.0 / 3.0],
        &[0.0, 1.0, -2.0 / 3.0],
        &[0.0, 1.0 / 2.0, -1.0 / 3.0],
        &[0.0, -1.0, 1.0],
    ],
};
