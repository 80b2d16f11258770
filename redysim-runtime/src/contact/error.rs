//! Invalid parameters of contacts.

use core::fmt;

use crate::Real;

/// An invalid parameter, plane or frame of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ContactError<S> {
    /// A parameter of a law is outside its range.
    InvalidParameter {
        /// Its name, as the law calls it.
        parameter: &'static str,
        /// Its value.
        value: S,
        /// What it must be.
        rule: ContactRule,
    },
    /// The normal of a plane has no direction: its length is zero, infinite or not a number.
    InvalidNormal {
        /// The given normal.
        normal: [S; 3],
    },
    /// The point of a plane is not finite.
    InvalidPoint {
        /// The given point, m.
        point: [S; 3],
    },
    /// The mechanism does not have the frame of a contact.
    UnknownFrame {
        /// The contact, counted from 0.
        contact: usize,
        /// Its frame, counted from 0.
        frame: usize,
        /// How many frames the mechanism has.
        frames: usize,
    },
}

/// What a parameter of a law must be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactRule {
    /// Above zero and finite.
    Positive,
    /// Zero or above, and finite.
    NotNegative,
    /// One or above, and finite.
    AtLeastOne,
}

impl ContactRule {
    /// Checks the value of a parameter.
    ///
    /// # Errors
    /// If it violates the rule.
    pub fn check<S: Real>(self, parameter: &'static str, value: S) -> Result<(), ContactError<S>> {
        let is_in_range = match self {
            Self::Positive => value > S::zero(),
            Self::NotNegative => value >= S::zero(),
            Self::AtLeastOne => value >= S::one(),
        };
        if is_in_range && value.is_finite() {
            return Ok(());
        }
        Err(ContactError::InvalidParameter { parameter, value, rule: self })
    }
}

impl fmt::Display for ContactRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Positive => "positive and finite",
            Self::NotNegative => "zero or positive, and finite",
            Self::AtLeastOne => "1 or more, and finite",
        })
    }
}

impl<S: fmt::Debug> fmt::Display for ContactError<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InvalidParameter { parameter, value, rule } => {
                write!(f, "`{parameter}` of a contact must be {rule}, but it is {value:?}")
            }
            Self::InvalidNormal { normal } => write!(
                f,
                "the normal of the ground must have a finite length above zero, but it is {normal:?}; give the direction \
                 out of the ground, of any length, such as [0, 0, 1]"
            ),
            Self::InvalidPoint { point } => {
                write!(f, "the point of the ground must have finite coordinates, but it is {point:?}")
            }
            Self::UnknownFrame { contact, frame, frames } => write!(
                f,
                "contact {contact} (counted from 0) is of frame {frame}, but the mechanism has {frames} frames, counted \
                 from 0; add a table `[[frame]]` to the model, or name another"
            ),
        }
    }
}

impl<S: fmt::Debug> core::error::Error for ContactError<S> {}
