//! Angles written with a unit: `"90 deg"`, `"1.5 rad"`.

use crate::decimal::with_decimal_points;
use std::f64::consts::FRAC_PI_2;

/// Why a text is not an angle.
#[derive(Debug, PartialEq)]
pub(crate) enum NotAnAngle<'a> {
    /// There is no number in front.
    Number,
    /// The number is followed by this instead of a unit; empty if nothing follows.
    Unit(&'a str),
    /// The number has a decimal comma; with a point it is this.
    Comma(String),
}

/// Reads an angle with a unit, in radians. Multiples of 90 deg become k · π/2 to the last bit. What the angle is
/// `per`, as "/s", may follow the unit.
pub(crate) fn angle<'t>(text: &'t str, per: &str) -> Result<f64, NotAnAngle<'t>> {
    let text = text.trim();
    if let Some(written) = with_decimal_points(text) {
        return Err(NotAnAngle::Comma(written));
    }
    let digits = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE".contains(c))).unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let number: f64 = number.parse().map_err(|_| NotAnAngle::Number)?;
    let unit = unit.trim_start();
    match unit.strip_suffix(per).unwrap_or(unit) {
        "deg" if number % 90.0 == 0.0 => Ok(number / 90.0 * FRAC_PI_2),
        "deg" => Ok(number.to_radians()),
        "rad" => Ok(number),
        _ => Err(NotAnAngle::Unit(unit)),
    }
}

/// An angle with a unit, in radians, as [`Reader::parse_angle`](crate::Reader::parse_angle) reads it; with `per`, such as
/// "/s", also a rate. Returns `None` if the text is not an angle with a unit.
///
/// ```
/// use redysim_toml::radians;
///
/// assert_eq!(radians("180 deg", ""), Some(std::f64::consts::PI));
/// assert_eq!(radians("2 rad/s", "/s"), Some(2.0));
/// assert_eq!(radians("180", ""), None);
/// ```
pub fn radians(text: &str, per: &str) -> Option<f64> {
    angle(text, per).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn angles_have_a_unit() {
        assert_eq!(angle("90 deg", ""), Ok(FRAC_PI_2));
        assert_eq!(angle(" -270deg ", ""), Ok(-3.0 * FRAC_PI_2));
        assert_eq!(angle("1.8e2 deg", ""), Ok(PI));
        assert_eq!(angle("30 deg", ""), Ok(30_f64.to_radians()));
        assert_eq!(angle("1.5 rad", ""), Ok(1.5));
        assert_eq!(angle("90 °", ""), Err(NotAnAngle::Unit("°")));
        assert_eq!(angle("90 grad", ""), Err(NotAnAngle::Unit("grad")));
        assert_eq!(angle("90", ""), Err(NotAnAngle::Unit("")));
        assert_eq!(angle("1,5 deg", ""), Err(NotAnAngle::Comma("1.5 deg".into())));
        assert_eq!(angle("90 deg/s", ""), Err(NotAnAngle::Unit("deg/s")));
        for text in ["", "deg", "nan deg", "ninety deg", "1.2.3 deg", "π rad"] {
            assert_eq!(angle(text, ""), Err(NotAnAngle::Number), "{text}");
        }
    }

    #[test]
    fn rates_may_have_a_unit_per_second() {
        assert_eq!(angle("90 deg/s", "/s"), Ok(FRAC_PI_2));
        assert_eq!(angle("90 deg", "/s"), Ok(FRAC_PI_2));
        assert_eq!(angle("2 rad/s^2", "/s^2"), Ok(2.0));
        assert_eq!(angle("2 rad/s^2", "/s"), Err(NotAnAngle::Unit("rad/s^2")));
    }
}
