//! Integrals of functions of time.

/// The integral over an interval that is short beside the times in which the function changes, by the five points of Gauss
/// and Legendre: of order 10 (Abramowitz and Stegun, *Handbook of Mathematical Functions*, 25.4.30).
pub fn integral(function: impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let root = 2.0 * (10.0_f64 / 7.0).sqrt();
    let pairs = [
        ((5.0 - root).sqrt() / 3.0, 322.0 + 13.0 * 70.0_f64.sqrt()),
        ((5.0 + root).sqrt() / 3.0, 322.0 - 13.0 * 70.0_f64.sqrt()),
    ];
    let of_pair =
        |(at, weight): (f64, f64)| weight / 900.0 * (function(middle - half * at) + function(middle + half * at));
    half * (128.0 / 225.0 * function(middle) + pairs.map(of_pair).iter().sum::<f64>())
}
