//! The largest angle that numbers of 64 bits resolve.

use std::ops::Range;

use redysim_toml::{KeyPath, MOST_ANGLE, Message, Reader};

/// An angle at `place`, or an error where it is too large to be resolved.
pub fn resolved(reader: &mut Reader<'_, '_>, place: Range<usize>, path: &KeyPath, angle: f64) -> Option<f64> {
    if angle.abs() <= MOST_ANGLE {
        return Some(angle);
    }
    let title = format!("{}: `{path}` is {angle:?} rad, and an angle is at most {MOST_ANGLE:e} rad", reader.item());
    reader.error_at(place, Message::new(title, "too many turns", unresolved("leave whole turns out")))
}

/// The help for angles that are not resolved.
pub fn unresolved(remedy: &str) -> String {
    format!("{remedy}: beyond {MOST_ANGLE:e} rad neighbouring numbers are more than 1e-7 rad apart")
}
