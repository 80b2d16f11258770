//! Loops: cut joints between two bodies of the tree.

use super::placement::unit_axis;
use super::tree;
use crate::messages;
use crate::model::{CutKind, CutSide, Loop};
use crate::schema::{CutSideTable, Document, LoopTable};
use crate::spatial::Vec3;
use redysim_toml::Findings;

/// The loops; `None` if one of them has a fault. `parents` has the parent of each link, if the tree has no fault.
pub(super) fn loops(
    document: &Document,
    parents: Option<&[Option<usize>]>,
    findings: &mut Findings,
) -> Option<Vec<Loop>> {
    // Collected in two steps, so that every loop is checked.
    let loops: Vec<_> = document.loops.iter().map(|table| one_loop(document, table, parents, findings)).collect();
    loops.into_iter().collect()
}

fn one_loop(
    document: &Document,
    table: &LoopTable,
    parents: Option<&[Option<usize>]>,
    findings: &mut Findings,
) -> Option<Loop> {
    let a = side(document, table, &table.a, findings);
    let b = side(document, table, &table.b, findings);
    let (a, b) = (a?, b?);
    let ends = [(&table.a.at, a.link), (&table.b.at, b.link)];
    let is_rigid = |link: usize| document.links[link].is_rigid();
    if let Some([link_a, link_b]) = parents.and_then(|parents| tree::on_one_body(ends, parents, is_rigid)) {
        let message = messages::loop_within_body(&table.item, link_a.get_ref(), link_b.get_ref(), document.locks());
        findings.error(link_b.span(), message);
    }
    Some(Loop { name: table.name.value()?.clone(), joint: *table.joint.value()?, a, b })
}

fn side(document: &Document, table: &LoopTable, side: &CutSideTable, findings: &mut Findings) -> Option<CutSide> {
    let link = tree::carrier(document, &table.item, side.at.link_key, &side.at.link, findings);
    let axis_allowed = axis_allowed(table, side, findings);
    let axis = unit_axis(&table.item, side.axis_key, &side.axis, axis_allowed, findings);
    Some(CutSide { link: link?, point: Vec3(side.at.point.value_or([0.0; 3])?), axis: axis? })
}

/// Only a revolute cut has an axis.
fn axis_allowed(table: &LoopTable, side: &CutSideTable, findings: &mut Findings) -> bool {
    let other = table.joint.value().filter(|kind| **kind != CutKind::Revolute);
    if let (Some(kind), Some(axis)) = (other, side.axis.spanned()) {
        findings.error(axis.span(), messages::axis_on_cut(&table.item, side.axis_key, kind.name()));
    }
    other.is_none()
}
