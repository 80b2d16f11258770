//! Inertias that no link of the mechanism has, and those that are missing.

use super::{Found, length, own_length, place_of, size};
use crate::lint::Lint;
use crate::messages;
use crate::model::{Inertia, JointKind, Link, Model};
use crate::schema::Document;
use std::ops::RangeInclusive;

/// The radius of gyration of a link as a share of the mechanism's size.
const GYRATION: RangeInclusive<f64> = 1e-4..=2.0;
/// A radius of gyration that may be in other units is larger, m: a flywheel is larger than the arm that carries it.
const LARGE: f64 = 1.0;
/// The radius of gyration of a link as a share of [its own size](link_size), and the least, m, of which that is reported: a body
/// is larger than what its joints show of it, and a link that is fixed to another may stand for the whole of both.
const GYRATION_OF_LINK: f64 = 4.0;
const LARGE_OF_LINK: f64 = 0.2;
/// m/k³ of the densest link, kg/m³. A sphere has the least radius of gyration k for its mass, k² = 3/5 r², so m/k³ is 9 times
/// its density, of tungsten 1.7e5; with a factor of 30 for round numbers in textbooks. Grams are a factor of 1e3 or more.
const DENSEST: f64 = 5e6;
/// A link without inertia is heavy if it has this share of the largest mass with one.
const HEAVY: f64 = 0.2;

pub(super) fn check(document: &Document, model: &Model, found: &mut Found) {
    odd_radii(document, model, found);
    missing(document, model, found);
}

fn odd_radii(document: &Document, model: &Model, found: &mut Found) {
    let size = size(model);
    for (index, (link, table)) in model.links.iter().zip(&document.links).enumerate() {
        // The trace of the tensor about the centre of mass is 2 m k².
        let trace = link.inertia.xx + link.inertia.yy + link.inertia.zz;
        if trace <= 0.0 || link.mass <= 0.0 {
            continue;
        }
        let radius = (trace / (2.0 * link.mass)).sqrt();
        let (share, density) = (radius / size, link.mass / radius.powi(3));
        let own = link_size(model, index);
        let message = if size > 0.0 && share > *GYRATION.end() && radius > LARGE {
            messages::large_radius(&table.item, radius, size)
        } else if link.joint != JointKind::Fixed && own > 0.0 && radius > LARGE_OF_LINK.max(GYRATION_OF_LINK * own) {
            messages::large_radius_of_link(&table.item, radius, own)
        } else if density > DENSEST {
            messages::dense_link(&table.item, radius, link.mass)
        } else if size > 0.0 && share < *GYRATION.start() {
            messages::small_radius(&table.item, radius, size)
        } else {
            continue;
        };
        found.push((Lint::RadiusOfGyration, place_of(table, &table.inertia), message));
    }
}

/// How far a link's centre of mass, frames, joints, cuts and springs are from its own frame. Where its centre of mass alone
/// shows a size, which of a wheel is hardly any, it is as large as the way from its parent; 0 if nothing shows its size.
fn link_size(model: &Model, index: usize) -> f64 {
    let link = &model.links[index];
    let carried = model.links.iter().filter(|link| link.parent == Some(index)).map(own_length);
    let frames =
        model.frames.iter().filter(|frame| frame.link == Some(index)).map(|frame| length(frame.placement.position));
    let cuts = model.loops.iter().flat_map(|cut| [&cut.a, &cut.b]).map(|side| (side.link, side.point));
    let springs = model.springs.iter().flat_map(|spring| [spring.a, spring.b]).map(|end| (end.link, end.point));
    let points = cuts.chain(springs).filter(|(link, _)| *link == Some(index)).map(|(_, point)| length(point));
    let attached = carried.chain(frames).chain(points).fold(0.0, f64::max);
    let shown = if attached > 0.0 { attached } else { own_length(link) };
    shown.max(length(link.com))
}

/// Links on joints that move; a link that is fixed to another may well be a payload of which the mass is known.
fn missing(document: &Document, model: &Model, found: &mut Found) {
    let without = |link: &Link| link.inertia == Inertia::default();
    let with_inertia = model.links.iter().filter(|link| !without(link));
    let Some(heaviest) = with_inertia.max_by(|a, b| a.mass.total_cmp(&b.mass)) else {
        if model.mass() > 0.0 {
            found.push((Lint::PointMasses, document.place.clone(), messages::point_masses(&model.name)));
        }
        return;
    };
    for (link, table) in model.links.iter().zip(&document.links) {
        if link.joint != JointKind::Fixed && without(link) && link.mass > 0.0 && link.mass >= HEAVY * heaviest.mass {
            let message = messages::missing_inertia(&table.item, link.mass, &heaviest.name);
            found.push((Lint::MissingInertia, place_of(table, &table.mass), message));
        }
    }
}
