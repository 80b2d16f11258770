//! Loops: cut joints between two bodies of the tree.

use super::placement::unit_axis;
use super::tree;
use crate::messages;
use crate::model::{CutSide, Loop};
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
    let [on_a, on_b] = table.joint.value().map_or([true, true], |kind| kind.has_axes());
    let a = side(document, table, &table.a, on_a, findings);
    let b = side(document, table, &table.b, on_b, findings);
    let (a, b) = (a?, b?);
    let ends = [(&table.a.at, a.link), (&table.b.at, b.link)];
    let is_rigid = |link: usize| document.links[link].is_rigid();
    if let Some([link_a, link_b]) = parents.and_then(|parents| tree::on_one_body(ends, parents, is_rigid)) {
        let message = messages::loop_within_body(&table.item, link_a.get_ref(), link_b.get_ref(), document.locks());
        findings.error(link_b.span(), message);
    }
    Some(Loop { name: table.name.value()?.clone(), joint: *table.joint.value()?, a, b })
}

/// A side of the cut. `has_axis` is whether the cut's kind takes an axis on that side.
fn side(
    document: &Document,
    table: &LoopTable,
    side: &CutSideTable,
    has_axis: bool,
    findings: &mut Findings,
) -> Option<CutSide> {
    let link = tree::carrier(document, &table.item, side.at.link_key, &side.at.link, findings);
    if let (false, Some(kind), Some(axis)) = (has_axis, table.joint.value(), side.axis.spanned()) {
        findings.error(axis.span(), messages::axis_on_cut(&table.item, side.axis_key, *kind));
    }
    let axis = unit_axis(&table.item, side.axis_key, &side.axis, has_axis, findings);
    Some(CutSide { link: link?, point: Vec3(side.at.point.value_or([0.0; 3])?), axis: axis? })
}
