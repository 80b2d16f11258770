//! Springs whose line has no direction, or always one length.

use super::{Found, length};
use crate::denoc::{Untraced, link_kinematics, neutral};
use crate::lint::Lint;
use crate::messages;
use crate::model::{LinkPoint, Model};
use crate::schema::Document;
use crate::spatial::{Mat3, Vec3};
use crate::tree::Tree;
use redysim_runtime::LinkState;

/// Positions beside the neutral one that are looked at: a length that is the same at all of them is so at every position.
const POSITIONS: usize = 3;
/// Lengths that differ by less than this part of the lengths around are the same.
const ROUNDOFF: f64 = 1e-12;

pub(super) fn check(document: &Document, model: &Model, found: &mut Found) {
    if model.springs.is_empty() {
        return;
    }
    let tree = Tree::new(model);
    let positions = (0..POSITIONS).map(|position| tree.sample(position));
    let states = std::iter::once(neutral(&tree)).chain(positions);
    let links: Vec<Vec<LinkState<f64>>> =
        states.map(|q| link_kinematics(&tree, &Untraced, &q, &vec![0.0; tree.nv()])).collect();
    for (spring, table) in model.springs.iter().zip(&document.springs) {
        let at = |links: &Vec<LinkState<f64>>| [spring.a, spring.b].map(|end| position(links, end));
        let size = links.iter().flat_map(at).map(length).fold(0.0, f64::max);
        let lengths: Vec<f64> = links.iter().map(at).map(|[a, b]| length(b - a)).collect();
        let place = || table.header.clone();
        if lengths.iter().all(|length| (length - lengths[0]).abs() <= ROUNDOFF * size) {
            found.push((Lint::SpringWithoutEffect, place(), messages::constant_length(&table.item, lengths[0])));
        } else if lengths[0] <= ROUNDOFF * size && spring.length > 0.0 {
            found.push((Lint::SpringDirection, place(), messages::no_direction(&table.item, spring.length)));
        }
    }
}

/// A point in the base frame.
fn position(links: &[LinkState<f64>], LinkPoint { link, point }: LinkPoint) -> Vec3<f64> {
    link.map_or(point, |link| Mat3(links[link].rotation) * point + Vec3(links[link].origin))
}
