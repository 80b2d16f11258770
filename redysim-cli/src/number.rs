//! Numbers as people read them.

use std::fmt::Display;

/// Four digits.
pub fn rounded(value: f64) -> String {
    with_digits(value, 4)
}

/// Two digits: enough for how large something is.
pub fn size(value: f64) -> String {
    with_digits(value, 2)
}

/// So many digits.
fn with_digits(value: f64, digits: usize) -> String {
    all_digits(format!("{value:.*e}", digits - 1).parse().unwrap_or(value))
}

/// The number itself, with an exponent only where it is very large or very small.
pub fn all_digits(value: f64) -> String {
    if value != 0.0 && !(1e-4..1e6).contains(&value.abs()) { format!("{value:e}") } else { format!("{value}") }
}

/// "1 joint", "2 joints".
pub fn counted<N: From<u8> + PartialEq + Display>(count: N, noun: &str) -> String {
    format!("{count} {noun}{}", if count == N::from(1) { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_ordinary_size_have_no_exponent() {
        for (value, text) in [(22.1, "22"), (0.58, "0.58"), (-312.0, "-310"), (0.0, "0"), (9.96, "10")] {
            assert_eq!(size(value), text);
        }
        for (value, text) in [(2.04e-9, "2e-9"), (8.44e-5, "8.4e-5"), (3.0e6, "3e6"), (f64::INFINITY, "inf")] {
            assert_eq!(size(value), text);
        }
        assert_eq!(rounded(2.0 / 3.0), "0.6667");
        for (value, text) in [(1e-60, "1e-60"), (0.1 + 0.2, "0.30000000000000004"), (3.0, "3"), (-2.5e7, "-2.5e7")] {
            assert_eq!(all_digits(value), text);
        }
    }
}
