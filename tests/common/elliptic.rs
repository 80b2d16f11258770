//! Jacobi's elliptic functions.

/// sn, cn and dn of `u`, where `complement` is k' = √(1 − k²), by the arithmetic-geometric mean (Abramowitz and Stegun,
/// *Handbook of Mathematical Functions*, 16.4).
pub fn jacobi(u: f64, complement: f64) -> [f64; 3] {
    let k_squared = 1.0 - complement * complement;
    let (mut a, mut b) = (1.0_f64, complement);
    let mut ratios = Vec::new();
    // Each step squares the difference of the two: seven are enough for k' = 0.03.
    for _ in 0..7 {
        let (mean, half_difference) = (0.5 * (a + b), 0.5 * (a - b));
        (b, a) = ((a * b).sqrt(), mean);
        ratios.push(half_difference / mean);
    }
    let turned = f64::from(1_u32 << ratios.len()) * a * u;
    let amplitude = ratios.iter().rev().fold(turned, |phi, ratio| 0.5 * (phi + (ratio * phi.sin()).asin()));
    let (sn, cn) = amplitude.sin_cos();
    [sn, cn, (complement * complement + k_squared * cn * cn).sqrt()]
}
