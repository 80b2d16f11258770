//! Slips of units: millimetres, grams, degrees.

use super::{Found, chain, length, own_length, place_of, place_of_placement, size};
use crate::lint::Lint;
use crate::messages;
use crate::model::{Link, Model};
use crate::schema::Document;
use redysim_toml::Spanned;

/// Hardly a mechanism reaches further, m.
const REACH: f64 = 200.0;
/// Hardly a mechanism of more than `LONG`, m, is lighter for its reach, kg/m.
const LIGHT: f64 = 0.3;
const LONG: f64 = 10.0;
/// A length that may be in millimetres is beyond `LONG`, and so many times the next shorter one.
const LENGTH_RATIO: f64 = 100.0;
/// A centre of mass that may be in millimetres is further from its frame, m, and so many times as far as the mechanism
/// reaches; the free length of a spring likewise.
const FAR: f64 = 5.0;
const FAR_RATIO: f64 = 30.0;
/// Beyond this, the heaviest link that moves is suspiciously heavier than the lightest.
const MASS_RATIO: f64 = 1e5;
/// Mass by the cube of its reach, kg/m³, that hardly a chain of so many links has: three solid cubes of steel have 870, robots
/// 10 to 50.
const SOLID: f64 = 3000.0;
const CHAIN: usize = 3;
/// Hardly a joint turns further, rad: eight turns, less than 90 degrees are.
const TURNS: f64 = 50.0;

pub(super) fn check(document: &Document, model: &Model, found: &mut Found) {
    let size = size(model);
    if !uneven_lengths(document, model, found) && is_too_long(size, model.mass()) {
        let message = messages::far_reach(&model.name, size, model.mass());
        found.push((Lint::LengthUnits, document.place.clone(), message));
    }
    heavy_chain(document, model, size, found);
    far_coms(document, model, size, found);
    long_springs(document, model, size, found);
    mass_ratio(document, model, found);
    ranges(document, model, found);
}

fn is_too_long(size: f64, mass: f64) -> bool {
    size > REACH || (size > LONG && mass > 0.0 && mass < LIGHT * size)
}

/// The shortest of the lengths that are longer than the others by so much that their units may differ; whether there is one.
fn uneven_lengths(document: &Document, model: &Model, found: &mut Found) -> bool {
    let mut lengths: Vec<(f64, usize)> =
        model.links.iter().map(own_length).zip(0..).filter(|(length, _)| *length > 0.0).collect();
    lengths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let jump = lengths.windows(2).find(|pair| pair[1].0 > LONG && pair[1].0 > LENGTH_RATIO * pair[0].0);
    if let Some([(short, other), (long, link)]) = jump {
        let message =
            messages::uneven_lengths([(&model.links[*link].name, *long), (&model.links[*other].name, *short)]);
        found.push((Lint::LengthUnits, place_of_placement(&document.links[*link]), message));
    }
    jump.is_some()
}

/// Arms that would weigh less if they were of solid steel, even without their heaviest link, of which other lints tell.
fn heavy_chain(document: &Document, model: &Model, size: f64, found: &mut Found) {
    let is_of_arm = |link: &Link| link.joint.dof() == 1 && own_length(link) > 0.0;
    let links_of_arm = |tip| chain(model, Some(tip)).filter(|&link| is_of_arm(&model.links[link])).count();
    let longest = (0..model.links.len()).map(links_of_arm).max();
    let masses = || model.links.iter().filter(|link| link.joint.dof() == 1).map(|link| link.mass);
    let (mass, heaviest) = (masses().sum::<f64>(), masses().fold(0.0, f64::max));
    if longest.is_some_and(|count| count >= CHAIN) && mass - heaviest > SOLID * size.powi(3) {
        let message = messages::heavy_chain(&model.name, mass, size);
        found.push((Lint::MassUnits, document.place.clone(), message));
    }
}

/// Centres of mass that are further from their frames than the mechanism reaches; without a reach, than the others.
fn far_coms(document: &Document, model: &Model, size: f64, found: &mut Found) {
    for (index, (link, table)) in model.links.iter().zip(&document.links).enumerate() {
        let others =
            model.links.iter().enumerate().filter(|(other, _)| *other != index).map(|(_, link)| length(link.com));
        let around = if size > 0.0 { size } else { others.fold(0.0, f64::max) };
        let distance = length(link.com);
        if around > 0.0 && distance > FAR && distance > FAR_RATIO * around {
            let message = messages::far_com(&table.item, distance, around);
            found.push((Lint::LengthUnits, place_of(table, &table.com), message));
        }
    }
}

/// Springs whose free length is further than the mechanism reaches.
fn long_springs(document: &Document, model: &Model, size: f64, found: &mut Found) {
    for (spring, table) in model.springs.iter().zip(&document.springs) {
        if spring.length > FAR && spring.length > FAR_RATIO * size {
            let place = table.length.spanned().map_or(table.header.clone(), Spanned::span);
            found.push((Lint::LengthUnits, place, messages::long_spring(&table.item, spring.length, size)));
        }
    }
}

/// Of links on joints that move; what is fixed to a link may be as small as a mark on it.
fn mass_ratio(document: &Document, model: &Model, found: &mut Found) {
    let with_mass = || model.links.iter().enumerate().filter(|(_, link)| link.mass > 0.0 && link.joint.dof() > 0);
    let by_mass = |a: &(usize, &Link), b: &(usize, &Link)| a.1.mass.total_cmp(&b.1.mass);
    let (Some((_, light)), Some((index, heavy))) = (with_mass().min_by(by_mass), with_mass().max_by(by_mass)) else {
        return;
    };
    if heavy.mass > MASS_RATIO * light.mass {
        let message = messages::mass_ratio([(&heavy.name, heavy.mass), (&light.name, light.mass)]);
        let table = &document.links[index];
        found.push((Lint::MassUnits, place_of(table, &table.mass), message));
    }
}

fn ranges(document: &Document, model: &Model, found: &mut Found) {
    for (link, table) in model.links.iter().zip(&document.links).filter(|(link, _)| link.joint.turns()) {
        let farthest = link.range.iter().flat_map(|range| range.position).map(f64::abs).fold(0.0, f64::max);
        if farthest > TURNS {
            let message = messages::wide_range(&table.item, farthest);
            found.push((Lint::RangeUnits, place_of(table, &table.range), message));
        }
    }
}
