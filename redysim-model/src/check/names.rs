//! Names: there, usable, and used once.

use crate::messages;
use crate::schema::Document;
use redysim_toml::{Field, Findings, Spanned};
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// The name of the ground.
pub(crate) const BASE: &str = "base";

pub(super) fn check(document: &Document, findings: &mut Findings) {
    not_blank(&document.item, "name", &document.name, findings);
    for link in &document.links {
        not_blank(&link.item, "name", &link.name, findings);
        not_blank(&link.item, "joint_name", &link.joint_name, findings);
        if let Some(name) = link.name.spanned().filter(|name| name.get_ref() == BASE) {
            findings.error(name.span(), messages::reserved_name());
        }
    }
    for entry in &document.loops {
        not_blank(&entry.item, "name", &entry.name, findings);
    }
    for frame in &document.frames {
        not_blank(&frame.item, "name", &frame.name, findings);
    }
    for spring in &document.springs {
        not_blank(&spring.item, "name", &spring.name, findings);
    }

    unique("link", document.links.iter().filter_map(|link| link.name.spanned()), findings);
    unique("loop", document.loops.iter().filter_map(|entry| entry.name.spanned()), findings);
    unique("frame", document.frames.iter().filter_map(|frame| frame.name.spanned()), findings);
    unique("spring", document.springs.iter().filter_map(|spring| spring.name.spanned()), findings);
    joints_unique(document, findings);
}

/// Whether each link has a name of its own.
pub(super) fn are_usable(document: &Document) -> bool {
    let mut seen = HashSet::new();
    let is_usable = |name: &String| name != BASE && !name.trim().is_empty();
    document.links.iter().all(|link| link.name.value().is_some_and(|name| is_usable(name) && seen.insert(name)))
}

fn not_blank(item: &str, key: &str, name: &Field<String>, findings: &mut Findings) {
    if let Some(name) = name.spanned().filter(|name| name.get_ref().trim().is_empty()) {
        findings.error(name.span(), messages::blank_name(item, key));
    }
}

fn unique<'a>(what: &str, names: impl Iterator<Item = &'a Spanned<String>>, findings: &mut Findings) {
    let mut seen = HashMap::<&str, Range<usize>>::new();
    for name in names {
        match seen.get(name.get_ref().as_str()) {
            Some(first) => {
                let message = messages::duplicate_name(what, name.get_ref(), findings.line(first));
                findings.error(name.span(), message);
            }
            None => _ = seen.insert(name.get_ref(), name.span()),
        }
    }
}

/// Moving joints have names of their own. Where two links share a name, that was reported, and their joints are not.
fn joints_unique(document: &Document, findings: &mut Findings) {
    let moving = document.links.iter().filter(|link| link.joint.value().is_none_or(|joint| joint.dof() > 0));
    let (mut links_seen, mut named) = (HashSet::new(), Vec::new());
    for link in moving {
        let (Some(name), Some(joint_name)) = (link.name.value(), link.joint_name()) else {
            continue;
        };
        if link.joint_name.is_missing() && links_seen.contains(name) {
            continue;
        }
        links_seen.insert(name);
        named.push(joint_name);
    }
    unique("joint", named.into_iter(), findings);
}
