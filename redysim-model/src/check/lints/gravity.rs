//! Gravity in other units, and gravity that points up.

use super::{Found, length};
use crate::lint::Lint;
use crate::messages;
use crate::model::Model;
use crate::schema::Document;
use redysim_toml::Spanned;
use std::ops::RangeInclusive;

/// Gravity on Earth, m/s², from the equator to the poles with some room.
const EARTH: RangeInclusive<f64> = 9.7..=9.9;
/// Gravity where people go, m/s²: from less than that of Ceres to more than that of Jupiter, and less than 32.2 (ft/s²).
const PLANETS: RangeInclusive<f64> = 0.1..=30.0;

pub(super) fn check(document: &Document, model: &Model, found: &mut Found) {
    let place = document.gravity.spanned().map_or(document.place.clone(), Spanned::span);
    let size = length(model.gravity);
    let mut add = |lint, message| found.push((lint, place.clone(), message));
    if size == 0.0 {
        add(Lint::NoGravity, messages::no_gravity(&model.name));
    } else if !PLANETS.contains(&size) {
        add(Lint::GravityUnits, messages::gravity_units(&model.name, size));
    } else if !EARTH.contains(&size) {
        add(Lint::OtherGravity, messages::other_gravity(&model.name, size));
    }
    let [_, y, z] = model.gravity.0;
    // Most of it, so that a base which is only tilted passes.
    let up = [("y", y), ("z", z)].into_iter().find(|(_, component)| *component > 0.9 * size && size > 0.0);
    if let Some((axis, _)) = up {
        add(Lint::GravityUp, messages::gravity_up(&model.name, axis));
    }
}
