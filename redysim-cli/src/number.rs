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

/// So many digits, with an exponent only for very large and very small numbers.
fn with_digits(value: f64, digits: usize) -> String {
    let short: f64 = format!("{value:.*e}", digits - 1).parse().unwrap_or(value);
    if short != 0.0 && !(1e-4..1e6).contains(&short.abs()) { format!("{short:e}") } else { format!("{short}") }
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
    }
}
