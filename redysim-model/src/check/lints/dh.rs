//! Denavit-Hartenberg parameters of the other convention.
//!
//! A row (a, alpha) is the way from one axis to the next. By Khalil and Kleinfinger's convention it is that from the joint
//! before, so the first row depends on how the base frame is chosen, along axis 1 as a rule, where it is zero. By the
//! standard convention it is that to the next joint, so the last row depends on the frame of the tool, which is mostly
//! that of the flange, turned about and slid along the last axis: zero. Rows of one convention under the other thus have
//! two consecutive revolute joints about one axis, of which one alone would do, at the end of the chain or at its start;
//! and the row at the opposite end, which would be the zero one, is not.

use super::{Found, chain, place_of};
use crate::lint::Lint;
use crate::messages;
use crate::model::{JointKind, Model};
use crate::schema::{Document, LinkTable};

/// Lengths, m, and sines of angles below this are zero.
const ZERO: f64 = 1e-9;
/// Joints of a chain that has a convention to be seen.
const SHORTEST: usize = 3;

/// The way between two axes.
#[derive(Clone, Copy)]
struct Row {
    a: f64,
    alpha: f64,
}

impl Row {
    fn dh(link: &LinkTable) -> Option<Row> {
        link.dh.value().map(|row| Row { a: row.a, alpha: row.alpha })
    }

    fn standard(link: &LinkTable) -> Option<Row> {
        link.dh_standard.value().map(|row| Row { a: row.a, alpha: row.alpha })
    }

    /// Whether the two axes are one.
    fn vanishes(self) -> bool {
        self.a.abs() < ZERO && self.alpha.sin().abs() < ZERO
    }
}

pub(super) fn check(document: &Document, model: &Model, found: &mut Found) {
    let mut reported = Vec::new();
    for chain in chains(document, model) {
        let rows =
            |row: fn(&LinkTable) -> Option<Row>| chain.iter().map(|link| row(link)).collect::<Option<Vec<Row>>>();
        let one_axis = |a: &LinkTable, b: &LinkTable| [a, b].iter().all(|link| joint(link) == JointKind::Revolute);
        let [first, second, before, last] = [chain[0], chain[1], chain[chain.len() - 2], chain[chain.len() - 1]];
        let [standard, modified] = [rows(Row::dh), rows(Row::standard)];
        let looks = if standard.is_some_and(|rows| !rows[0].vanishes() && rows[rows.len() - 1].vanishes()) {
            one_axis(before, last)
                .then(|| (last, place_of(last, &last.dh), messages::standard_rows(&last.item, name(before))))
        } else if modified.is_some_and(|rows| rows[0].vanishes() && !rows[rows.len() - 1].vanishes()) {
            let message = messages::modified_rows(&first.item, name(second));
            one_axis(first, second).then(|| (first, place_of(first, &first.dh_standard), message))
        } else {
            None
        };
        // Branches have their first rows in common.
        if let Some((link, place, message)) = looks.filter(|(link, ..)| !reported.contains(&link.place())) {
            reported.push(link.place());
            found.push((Lint::DhConvention, place, message));
        }
    }
}

/// The links on moving joints from the ground to each that carries no other such link, without those between which a
/// joint is fixed. Locks are no part of a convention.
fn chains<'a>(document: &'a Document, model: &Model) -> impl Iterator<Item = Vec<&'a LinkTable>> {
    let links = &document.links;
    let moves = |link: &usize| joint(&links[*link]) != JointKind::Fixed;
    let path = |tip: usize| {
        let mut path: Vec<usize> = chain(model, Some(tip)).collect();
        path.reverse();
        path
    };
    // Those that carry a moving link, whose own carriers are marked once.
    let mut is_inner = vec![false; links.len()];
    for link in (0..links.len()).filter(moves) {
        for carrier in chain(model, model.links[link].parent) {
            if std::mem::replace(&mut is_inner[carrier], true) {
                break;
            }
        }
    }
    let tips = (0..links.len()).filter(moves).filter(move |&link| !is_inner[link]);
    let to_tips = tips.map(path);
    let from_first = to_tips.map(move |path| path.into_iter().skip_while(|link| !moves(link)).collect::<Vec<_>>());
    let whole = from_first.filter(move |chain| chain.len() >= SHORTEST && chain.iter().all(moves));
    whole.map(move |chain| chain.into_iter().map(|link| &links[link]).collect())
}

fn joint(link: &LinkTable) -> JointKind {
    link.joint.value().copied().unwrap_or(JointKind::Fixed)
}

fn name(link: &LinkTable) -> &str {
    link.name.value().map_or("", String::as_str)
}
