//! What single values are: numbers and angles, finite and plausible.

use super::reader::Reader;
use crate::diagnostic::messages;
use crate::units::{self, NotAnAngle};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::RangeInclusive;
use toml::Spanned;
use toml::de::{DeInteger, DeValue};

/// A value and its place.
pub type Value<'a> = Spanned<DeValue<'a>>;

/// What a number other than zero may be, so that products of a mass and two lengths, and their reciprocals, are finite.
const MAGNITUDES: RangeInclusive<f64> = 1e-100..=1e100;

/// A radian value this close to a multiple of 90 deg, but not on it, was probably rounded by hand: 1.5708, 3.1416.
const NEARLY: f64 = 1e-5;

impl Reader<'_, '_> {
    /// A finite number.
    pub fn a_number(&mut self, path: &str, value: &Value<'_>) -> Option<f64> {
        let (number, text) = match value.get_ref() {
            DeValue::Float(float) => (float.as_str().parse().unwrap_or(f64::NAN), float.as_str()),
            DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(number) => (number as f64, integer.as_str()),
                Err(_) => {
                    let message = messages::integer_out_of_range(self.item(), path, integer.as_str(), rounded(integer));
                    return self.fault(value, message);
                }
            },
            _ => return self.wrong_type(path, value, "a number"),
        };
        self.finite(path, value, number, text)
    }

    /// An angle, in radians: a number, or one with a unit.
    pub fn an_angle(&mut self, path: &str, value: &Value<'_>) -> Option<f64> {
        self.turned(path, value, "")
    }

    /// A displacement of a joint, or that `per` something, as "/s": a number, or of a joint that turns also an angle
    /// with a unit, in radians. Unlike of an angle, more than a turn of it is nothing odd.
    pub fn displacement(&mut self, path: &str, value: &Value<'_>, turns: bool, per: &str) -> Option<f64> {
        match value.get_ref() {
            DeValue::String(_) if turns => self.turned(path, value, per),
            _ => self.a_number(path, value),
        }
    }

    /// An angle `per` something.
    fn turned(&mut self, path: &str, value: &Value<'_>, per: &str) -> Option<f64> {
        let DeValue::String(text) = value.get_ref() else {
            if !matches!(value.get_ref(), DeValue::Float(_) | DeValue::Integer(_)) {
                return self.wrong_type(path, value, "an angle");
            }
            let radians = self.a_number(path, value)?;
            self.doubt(path, value, radians);
            return Some(radians);
        };
        match units::angle(text, per) {
            Ok(radians) => self.finite(path, value, radians, text),
            Err(NotAnAngle::Number) => self.fault(value, messages::not_an_angle(self.item(), path, text)),
            Err(NotAnAngle::Unit(unit)) => self.fault(value, messages::bad_unit(self.item(), path, text, unit, per)),
        }
    }

    /// Warns of plain numbers that look like degrees, or like quarter turns rounded by hand.
    fn doubt(&mut self, path: &str, value: &Value<'_>, radians: f64) {
        let quarters = (radians / FRAC_PI_2).round();
        let (sin_twice, _) = crate::rotation::sin_cos(2.0 * radians);
        if radians.abs() > TAU * (1.0 + NEARLY) {
            self.warning(value.span(), messages::large_angle(self.item(), path, radians));
        } else if quarters != 0.0 && sin_twice != 0.0 && (radians - quarters * FRAC_PI_2).abs() < NEARLY {
            let message = messages::nearly_quarter_turn(self.item(), path, radians, 90.0 * quarters);
            self.warning(value.span(), message);
        }
    }

    fn finite(&mut self, path: &str, value: &Value<'_>, number: f64, text: &str) -> Option<f64> {
        if !number.is_finite() {
            return self.fault(value, messages::not_finite(self.manual, self.item(), path, text));
        }
        if number != 0.0 && !MAGNITUDES.contains(&number.abs()) {
            return self.fault(value, messages::out_of_range(self.item(), path, text, &MAGNITUDES));
        }
        Some(number)
    }

    /// Reports that a value is not of the kind `wanted`, a noun with its article. Always `None`.
    pub fn wrong_type<T>(&mut self, path: &str, value: &Value<'_>, wanted: &str) -> Option<T> {
        self.fault(value, messages::wrong_type(self.manual, self.item(), path, wanted, &described(value.get_ref())))
    }
}

/// The float nearest to an integer of any size, if there is one.
fn rounded(integer: &DeInteger<'_>) -> Option<f64> {
    let rounded = match integer.radix() {
        10 => integer.as_str().parse().ok(),
        radix => i128::from_str_radix(integer.as_str(), radix).ok().map(|integer| integer as f64),
    };
    rounded.filter(|rounded| rounded.is_finite())
}

/// A value in a few words, with its article.
fn described(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) if text.chars().count() > 40 => "a long string".into(),
        DeValue::String(text) => format!("the string \"{}\"", text.escape_debug()),
        DeValue::Integer(integer) => format!("the number {integer}"),
        DeValue::Float(float) => format!("the number {float}"),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(_) => "a date or time".into(),
        DeValue::Array(_) => "an array".into(),
        DeValue::Table(_) => "a table".into(),
    }
}
