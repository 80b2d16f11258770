//! Numbers as people read them.

/// Four digits.
pub fn rounded(value: f64) -> String {
    let short: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    if short != 0.0 && !(1e-4..1e6).contains(&short.abs()) { format!("{short:e}") } else { format!("{short}") }
}

/// "1 joint", "2 joints".
pub fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
