//! Single values: numbers and angles, finite and plausible.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::RangeInclusive;

use toml::Spanned;
use toml::de::{DeArray, DeInteger, DeTable, DeValue};

use crate::decimal::with_decimal_points;
use crate::diagnostic::Message;
use crate::key::KeyPath;
use crate::messages;
use crate::units::{self, NotAnAngle};

/// A value and its place.
pub type Value<'a> = Spanned<DeValue<'a>>;

/// A table.
pub type Table<'a> = DeTable<'a>;

/// An array.
pub type Array<'a> = DeArray<'a>;

/// The range of a number other than zero: products of a mass and two lengths, and their reciprocals, are finite.
const MAGNITUDES: RangeInclusive<f64> = 1e-100..=1e100;

/// The largest angle that numbers of 64 bits resolve, rad. Neighbouring numbers are 1.2e-7 rad apart there, a tenth of the
/// default absolute tolerance of a motion, and farther apart beyond.
pub const MOST_ANGLE: f64 = 1e9;

/// A radian value this close to a multiple of 90 deg, but not on it, was probably rounded by hand: 1.5708, 3.1415.
const NEARLY_QUARTER_TURN: f64 = 1e-4;

/// The scales of two and three decimals, to which multiples of 90 deg are often rounded: 1.57, 3.142.
const FEW_DECIMALS: [f64; 2] = [100.0, 1000.0];

/// The number of quarter turns that an angle, in radians, is nearly but not exactly: one that was probably rounded by hand, by
/// less than 10⁻⁴, or to two or three decimals; zero for a small angle. `None` for a multiple of 90 deg, and for other angles.
///
/// ```
/// use redysim_toml::rounded_quarter_turns;
///
/// assert_eq!([1.5708, -1.57, 3.142].map(rounded_quarter_turns), [Some(1.0), Some(-1.0), Some(2.0)]);
/// assert_eq!([1.0, 1.56, 11.0, std::f64::consts::FRAC_PI_2].map(rounded_quarter_turns), [None; 4]);
/// ```
pub fn rounded_quarter_turns(radians: f64) -> Option<f64> {
    let quarters = (radians / FRAC_PI_2).round();
    let exact = quarters * FRAC_PI_2;
    let off = (radians - exact).abs();
    let rounded = |decimals: f64| (exact * decimals).round() / decimals;
    // Of many turns, to few decimals, other angles are the nearest as well.
    let is_near = off < NEARLY_QUARTER_TURN || quarters.abs() <= 4.0 && FEW_DECIMALS.map(rounded).contains(&radians);
    (is_near && off > f64::EPSILON * radians.abs()).then_some(quarters)
}

/// The name of the warning about a plain number that is an angle of more than a turn.
pub const LARGE_ANGLE: &str = "angle-units";

/// The name of the warning about a plain number that is nearly a multiple of 90 deg.
pub const ROUNDED_ANGLE: &str = "rounded-angle";

/// A value, and what messages call it: its item and its path.
#[derive(Clone, Copy)]
pub(crate) struct Named<'v, 'a> {
    pub(crate) item: &'v str,
    pub(crate) path: &'v KeyPath,
    pub(crate) value: &'v Value<'a>,
}

/// An angle, in radians, with a warning if it is implausible.
pub(crate) struct Angle {
    pub(crate) radians: f64,
    pub(crate) warning: Option<(&'static str, Message)>,
}

impl Named<'_, '_> {
    /// A finite number.
    pub(crate) fn number(self) -> Result<f64, Message> {
        let Named { item, path, value } = self;
        match value.get_ref() {
            DeValue::Float(float) => self.finite(float.as_str().parse().unwrap_or(f64::NAN), float.as_str()),
            DeValue::Integer(integer) => match i64::from_str_radix(integer.as_str(), integer.radix()) {
                Ok(number) => self.finite(number as f64, integer.as_str()),
                Err(_) => Err(messages::integer_out_of_range(item, path, integer.as_str(), nearest(integer))),
            },
            DeValue::String(text) => Err(self.comma(text).unwrap_or_else(|| self.wrong_type("a number"))),
            _ => Err(self.wrong_type("a number")),
        }
    }

    /// The error of a number that is a string for its decimal comma.
    fn comma(self, text: &str) -> Option<Message> {
        let written = with_decimal_points(text).filter(|written| written.trim().parse::<f64>().is_ok())?;
        Some(messages::decimal_comma(self.item, self.path, text, written.trim()))
    }

    /// An angle `per` something, as "/s": a number, or one with a unit.
    pub(crate) fn angle(self, per: &str) -> Result<Angle, Message> {
        let Named { item, path, value } = self;
        match value.get_ref() {
            DeValue::String(text) => match units::angle(text, per) {
                Ok(radians) => Ok(Angle { radians: self.finite(radians, text)?, warning: None }),
                Err(NotAnAngle::Comma(written)) => {
                    Err(messages::decimal_comma(item, path, text, &format!("\"{written}\"")))
                }
                Err(NotAnAngle::Number) => Err(messages::not_an_angle(item, path, text)),
                Err(NotAnAngle::Unit(unit)) => Err(messages::bad_unit(item, path, text, unit, per)),
            },
            DeValue::Float(_) | DeValue::Integer(_) => {
                let radians = self.number()?;
                Ok(Angle { radians, warning: self.doubt(radians) })
            }
            _ => Err(self.wrong_type("an angle")),
        }
    }

    /// A warning about a plain number that looks like degrees, or like quarter turns rounded by hand.
    fn doubt(self, radians: f64) -> Option<(&'static str, Message)> {
        let Named { item, path, .. } = self;
        if radians.abs() > TAU * (1.0 + NEARLY_QUARTER_TURN) {
            return Some((LARGE_ANGLE, messages::large_angle(item, path, radians)));
        }
        // A small angle is not zero, rounded.
        let quarters = rounded_quarter_turns(radians).filter(|quarters| *quarters != 0.0)?;
        Some((ROUNDED_ANGLE, messages::nearly_quarter_turn(item, path, radians, 90.0 * quarters)))
    }

    fn finite(self, number: f64, text: &str) -> Result<f64, Message> {
        if !number.is_finite() {
            Err(messages::not_finite(self.item, self.path, text))
        } else if number != 0.0 && !MAGNITUDES.contains(&number.abs()) {
            Err(messages::out_of_range(self.item, self.path, text, &MAGNITUDES))
        } else {
            Ok(number)
        }
    }

    /// The error of a value that is not of the type `wanted`, a noun with its article.
    pub(crate) fn wrong_type(self, wanted: &str) -> Message {
        messages::wrong_type(self.item, self.path, wanted, &described(self.value.get_ref()))
    }
}

/// The float nearest to an integer of any size, if there is one.
fn nearest(integer: &DeInteger<'_>) -> Option<f64> {
    let nearest = match integer.radix() {
        10 => integer.as_str().parse().ok(),
        radix => i128::from_str_radix(integer.as_str(), radix).ok().map(|integer| integer as f64),
    };
    nearest.filter(|nearest| nearest.is_finite())
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
