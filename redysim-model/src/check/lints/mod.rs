//! What is rarely meant in a model without errors, one idea a file.

mod dh;
mod gravity;
mod inertias;
mod springs;
mod units;

use crate::lint::Lint;
use crate::messages;
use crate::model::{Link, Model};
use crate::schema::{Document, LinkTable};
use crate::spatial::Vec3;
use redysim_toml::{Field, Findings, Message, Spanned};
use std::ops::Range;

/// Reports what is rarely meant in the model of a document.
pub(super) fn check(document: &Document, model: &Model, findings: &mut Findings) {
    let mut found = Vec::new();
    gravity::check(document, model, &mut found);
    units::check(document, model, &mut found);
    inertias::check(document, model, &mut found);
    dh::check(document, model, &mut found);
    springs::check(document, model, &mut found);
    for (lint, place, message) in found {
        report(findings, lint, place, message);
    }
}

/// A lint, where it stands, and its message.
type Found = Vec<(Lint, Range<usize>, Message)>;

/// Reports a lint, with the way to allow it.
pub(super) fn report(findings: &mut Findings, lint: Lint, place: Range<usize>, message: Message) {
    let message = messages::with_allow(message, lint);
    match lint.is_note() {
        true => findings.note(lint.name(), place, message),
        false => findings.lint(lint.name(), place, message),
    }
}

/// The place of a value, or of its link.
fn place_of<T>(link: &LinkTable, field: &Field<T>) -> Range<usize> {
    field.spanned().map_or(link.place(), Spanned::span)
}

/// The place of what places a link.
fn place_of_placement(link: &LinkTable) -> Range<usize> {
    let dh = link.dh.spanned().map(Spanned::span);
    let dh = dh.or_else(|| link.dh_standard.spanned().map(Spanned::span));
    dh.unwrap_or_else(|| place_of(link, &link.origin))
}

/// How far the mechanism reaches when it is stretched: the longest way from the ground over the origins of the links'
/// frames, or over the points of its cuts and springs.
fn size(model: &Model) -> f64 {
    let reach = |link| chain(model, link).map(|link| own_length(&model.links[link])).sum::<f64>();
    let ends = (0..model.links.len()).map(|link| reach(Some(link)));
    let sides = model.loops.iter().flat_map(|cut| [&cut.a, &cut.b]);
    let cuts = sides.map(|side| (side.link, side.point));
    let springs = model.springs.iter().flat_map(|spring| [spring.a, spring.b]).map(|end| (end.link, end.point));
    ends.chain(cuts.chain(springs).map(|(link, point)| reach(link) + length(point))).fold(0.0, f64::max)
}

/// A link and those that carry it, down to the ground.
fn chain(model: &Model, link: Option<usize>) -> impl Iterator<Item = usize> {
    std::iter::successors(link, |&link| model.links[link].parent)
}

/// The way from the frame of a link's parent to its own.
fn own_length(link: &Link) -> f64 {
    length(link.placement.position) + link.offset_along_axis().abs() + length(link.frame.position)
}

fn length(vector: Vec3<f64>) -> f64 {
    vector.dot(vector).sqrt()
}
