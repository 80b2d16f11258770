//! What a model file says, checked rule by rule. Every rule reports all it finds; none stops another.

mod closed;
mod cut;
mod frame;
mod inertia;
mod lints;
mod massless;
mod mimic;
mod mobility;
mod names;
mod options;
mod physics;
mod placement;
mod singular;
mod spring;
mod tree;

use crate::messages;
use crate::model::{JointKind, Link, Model};
use crate::options::CodegenOptions;
use crate::schema::{Document, LinkTable};
use crate::spatial::Vec3;
pub(crate) use names::BASE;
use placement::Placed;
use redysim_toml::{Findings, Message, Spanned};

/// The model and what is asked of it, unless an error is found, or was found while reading.
pub(crate) fn check(document: &Document, findings: &mut Findings) -> Option<(Model, CodegenOptions)> {
    let options = options::check(document, findings);
    names::check(document, findings);
    something_moves(document, findings);
    let parents = tree::parents(document, findings);
    let links: Vec<_> = document.links.iter().map(|table| link(table, findings)).collect();
    inertia::check(document, &links, parents.as_deref(), findings);
    let loops = cut::loops(document, parents.as_deref(), findings);
    let frames = frame::frames(document, findings);
    let springs = spring::springs(document, parents.as_deref(), findings);
    let mimics = mimic::mimics(document, findings);
    let parents = parents?;
    let massless = massless::check(document, &parents);
    if document.loops.is_empty() {
        // Loops may hold what has no mass; whether they do shows in a model without faults.
        report(document, &massless, findings);
    }

    let mut links = placed(document, links.into_iter().collect::<Option<_>>()?, &parents);
    for (link, mimic) in links.iter_mut().zip(mimics?) {
        link.mimic = mimic.filter(|_| link.joint != JointKind::Fixed);
    }
    let gravity = Vec3(*document.gravity.value()?);
    let mut options = options;
    let name = document.name.value()?.clone();
    let model = Model { name, gravity, links, loops: loops?, frames: frames?, springs: springs? };
    if findings.errors() > 0 {
        return None;
    }
    let unmoved = if massless.is_empty() { singular::check(&model) } else { massless };
    if let Some((link, _)) = unmoved.first() {
        if closed::is_well_posed(&model) {
            options::without_dynamics_of_tree(document, &model.links[*link], options.as_mut(), findings);
        } else {
            report(document, &unmoved, findings);
        }
    }
    if findings.errors() > 0 {
        return None;
    }
    for (lint, cut, message) in mobility::check(&model) {
        let table = cut.and_then(|cut| document.loops.get(cut)).and_then(|table| table.name.spanned());
        let message = messages::with_locks(message, &document.locks());
        lints::report(findings, lint, table.map_or(document.place.clone(), Spanned::span), message);
    }
    lints::check(document, &model, findings);
    Some((model, options?))
}

/// The links on their parents, with joints locked.
fn placed(document: &Document, mut links: Vec<Link>, parents: &[Option<usize>]) -> Vec<Link> {
    for ((link, table), parent) in links.iter_mut().zip(&document.links).zip(parents) {
        link.parent = *parent;
        if let Some(values) = &table.locked {
            link.lock(values);
        }
    }
    links
}

/// Reports links whose joints meet no inertia.
fn report(document: &Document, links: &[(usize, Message)], findings: &mut Findings) {
    for (link, message) in links {
        let message = messages::with_locks(message.clone(), &document.locks());
        findings.error(document.links.get(*link).map_or(document.place.clone(), LinkTable::place), message);
    }
}

/// One link by itself, still without its parent and without what it mimics.
fn link(table: &LinkTable, findings: &mut Findings) -> Option<Link> {
    let placed = placement::place(table, findings);
    let physics = physics::check(table, findings);
    let Placed { placement, axis, offset, frame } = placed?;
    Some(Link {
        name: table.name.value()?.clone(),
        joint_name: table.joint_name()?.get_ref().clone(),
        parent: None,
        joint: *table.joint.value()?,
        placement,
        axis,
        frame,
        offset,
        pitch: table.pitch.value_or(0.0)?,
        coordinates: if table.coordinates.is_missing() { None } else { Some(*table.coordinates.value()?) },
        mass: *table.mass.value()?,
        com: Vec3(table.com.value_or([0.0; 3])?),
        inertia: table.inertia.value_or(Default::default())?,
        physics: physics?,
        mimic: None,
        actuated: table.actuated.value_or(true.into())?,
        range: table.range.value_or(Vec::new())?,
    })
}

/// There are links, and at least one joint that moves.
fn something_moves(document: &Document, findings: &mut Findings) {
    if !document.links_complete {
        return;
    }
    let Some(first) = document.links.first() else {
        findings.error(document.place.clone(), messages::no_links(&document.item));
        return;
    };
    let fixed = |link: &LinkTable| link.joint.value() == Some(&JointKind::Fixed);
    let locks = &document.options.locked;
    if let Some(last) = locks.value.last()
        && document.links.iter().all(LinkTable::is_rigid)
    {
        let message = messages::nothing_moves_unlocked(&document.item);
        findings.within(locks.text, |findings| findings.error(last.place.clone(), message));
    } else if document.links.iter().all(fixed) {
        let place = first.joint.spanned().map_or(first.place(), Spanned::span);
        findings.error(place, messages::nothing_moves(&document.item));
    }
}
