//! Springs between two points: numbers that a spring can have, on links that move against each other.

use super::tree;
use crate::messages;
use crate::model::{JointKind, LinkPoint, Spring};
use crate::schema::{Document, PointTable, SpringTable, keys};
use crate::spatial::Vec3;
use redysim_toml::Findings;

/// The springs; `None` if one of them has a fault. `parents` has the parent of each link, if the tree has no fault.
pub(super) fn springs(
    document: &Document,
    parents: Option<&[Option<usize>]>,
    findings: &mut Findings,
) -> Option<Vec<Spring>> {
    // Collected in two steps, so that every spring is checked.
    let springs: Vec<_> = document.springs.iter().map(|table| spring(document, table, parents, findings)).collect();
    springs.into_iter().collect()
}

fn spring(
    document: &Document,
    table: &SpringTable,
    parents: Option<&[Option<usize>]>,
    findings: &mut Findings,
) -> Option<Spring> {
    let SpringTable { item, stiffness, damping, length, .. } = table;
    let numbers = [(&keys::SPRING_STIFFNESS, stiffness), (&keys::SPRING_DAMPING, damping), (&keys::LENGTH, length)];
    for (key, field) in numbers {
        if let Some(given) = field.spanned().filter(|given| *given.get_ref() < 0.0) {
            findings.error(given.span(), messages::negative_of_spring(item, key.name, *given.get_ref()));
        }
    }
    if stiffness.is_missing() && damping.is_missing() {
        findings.error(table.header.clone(), messages::spring_without_force(item));
    } else if let Some(given) = length.spanned().filter(|_| stiffness.is_missing()) {
        let message = messages::physics_without(item, keys::LENGTH.name, keys::SPRING_STIFFNESS.name);
        findings.error(given.span(), message);
    }
    let a = point(document, table, &table.a, findings);
    let b = point(document, table, &table.b, findings);
    let (a, b) = (a?, b?);
    // Joints that the options lock may be rigid, too: a spring between them stays, and has no effect.
    let is_fixed = |link: usize| document.links[link].joint.value() == Some(&JointKind::Fixed);
    let ends = [(&table.a, a.link), (&table.b, b.link)];
    if let Some([link_a, link_b]) = parents.and_then(|parents| tree::on_one_body(ends, parents, is_fixed)) {
        let message = messages::spring_within_body(item, link_a.get_ref(), link_b.get_ref());
        findings.error(link_b.span(), message);
    }
    Some(Spring {
        name: if table.name.is_missing() { None } else { Some(table.name.value()?.clone()) },
        a,
        b,
        stiffness: stiffness.value_or(0.0)?,
        damping: damping.value_or(0.0)?,
        length: length.value_or(0.0)?,
    })
}

fn point(document: &Document, table: &SpringTable, end: &PointTable, findings: &mut Findings) -> Option<LinkPoint> {
    let link = tree::carrier(document, &table.item, end.link_key, &end.link, findings);
    Some(LinkPoint { link: link?, point: Vec3(end.point.value_or([0.0; 3])?) })
}
