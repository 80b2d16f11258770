//! Joints that mimic others: known, of one coordinate, and not led back to themselves.

use crate::messages;
use crate::model::{JointKind, Mimic};
use crate::schema::{Document, LinkTable, MimicTable, keys, mimicked};
use redysim_toml::{Findings, Spanned};
use std::ops::Range;

/// For each link, what its joint mimics; `None` for the whole if something is invalid.
pub(super) fn mimics(document: &Document, findings: &mut Findings) -> Option<Vec<Option<Mimic>>> {
    let before = findings.errors();
    let all: Vec<_> = document.links.iter().map(|link| mimic(document, link, findings)).collect();
    for (index, link) in document.links.iter().enumerate() {
        if let (Some(path), Some(given)) = (path_to_itself(&all, index), link.mimic.spanned()) {
            let names: Vec<&str> = path.iter().filter_map(|&link| joint_name(&document.links[link])).collect();
            findings.error(given.span(), messages::mimics_itself(&link.item, &names));
        }
    }
    (findings.errors() == before).then_some(all)
}

fn mimic(document: &Document, link: &LinkTable, findings: &mut Findings) -> Option<Mimic> {
    let given = link.mimic.spanned()?;
    let MimicTable { joint, multiplier, multiplier_place, offset } = given.get_ref();
    if let Some(kind) = link.joint.value().filter(|kind| kind.dof() != 1) {
        findings.error(given.span(), messages::mimic_of_joint_without_one_coordinate(&link.item, *kind));
    }
    for (key, place) in [(keys::ACTUATED, place_of(&link.actuated)), (keys::RANGE, place_of(&link.range))] {
        if let Some(place) = place {
            findings.error(place, messages::beside_mimic(&link.item, key.name));
        }
    }
    if *multiplier == 0.0 {
        let place = multiplier_place.clone().unwrap_or(given.span());
        findings.error(place, messages::zero_multiplier(&link.item));
    }
    let joint = joint.as_ref()?;
    let Some(followed) = mimicked(&document.links, joint.get_ref()) else {
        unknown(document, link, joint, findings);
        return None;
    };
    let kind = document.links[followed].joint.value().copied();
    if let Some(kind) = kind.filter(|kind: &JointKind| kind.dof() != 1) {
        findings.error(joint.span(), messages::mimicked_without_one_coordinate(&link.item, joint.get_ref(), kind));
    }
    Some(Mimic { link: followed, multiplier: *multiplier, offset: *offset })
}

fn place_of<T>(field: &redysim_toml::Field<T>) -> Option<Range<usize>> {
    field.spanned().map(Spanned::span)
}

/// Reports a joint that is not known, unless a name is unreadable: that one may be meant.
fn unknown(document: &Document, link: &LinkTable, joint: &Spanned<String>, findings: &mut Findings) {
    let readable = document.links.iter().all(|link| link.name.value().is_some() && link.joint_name().is_some());
    if document.links_complete && readable {
        let of_one = document.links.iter().filter(|link| link.joint.value().is_some_and(|kind| kind.dof() == 1));
        let joints: Vec<&str> = of_one.filter_map(joint_name).collect();
        findings.error(joint.span(), messages::unknown_mimicked(&link.item, joint.get_ref(), &joints));
    }
}

fn joint_name(link: &LinkTable) -> Option<&str> {
    link.joint_name().map(|name| name.get_ref().as_str())
}

/// The links from `first` along the joints that they mimic back to it, if they lead there.
fn path_to_itself(mimics: &[Option<Mimic>], first: usize) -> Option<Vec<usize>> {
    let mut path = vec![first];
    while let Some(Mimic { link, .. }) = mimics[*path.last()?] {
        path.push(link);
        if link == first {
            return Some(path);
        }
        if path.len() > mimics.len() {
            return None;
        }
    }
    None
}
