//! Numbers as people read them.

/// Four digits.
pub fn rounded(value: f64) -> String {
    let short: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if short != 0.0 && !(1e-4..1e6).contains(&short.abs()) { format!("{short:e}") } else { format!("{short}") }
}
