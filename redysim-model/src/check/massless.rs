//! Every joint moves something: the structural reason for a singular mass matrix. The numerical one is in
//! [`super::singular`].

use crate::messages;
use crate::model::Inertia;
use crate::schema::{Document, LinkTable, mimicked};
use redysim_toml::Message;
use std::collections::BTreeSet;

/// Each moving link that has neither mass nor inertia and carries none, and some velocity of whose joint has no armature, with
/// its message: its row of the mass matrix is zero. Joints that mimic one another have one row together.
pub(super) fn check(document: &Document, parents: &[Option<usize>]) -> Vec<(usize, Message)> {
    let mut carries = vec![false; document.links.len()];
    for (i, link) in document.links.iter().enumerate() {
        let mut at = Some(i).filter(|_| has_mass(link));
        while let Some(link) = at.filter(|&link| !carries[link]) {
            carries[link] = true;
            at = parents[link];
        }
    }
    let links = || document.links.iter().enumerate();
    let meets_inertia = |(index, link): &(usize, &LinkTable)| carries[*index] || has_rotors(link);
    let resisted: BTreeSet<usize> = links().filter(meets_inertia).map(|(index, _)| followed(document, index)).collect();
    let idle = links().filter(|(index, _)| !resisted.contains(&followed(document, *index)));
    idle.filter(|(_, link)| link.joint.value().is_some() && !link.is_rigid())
        .filter_map(|(index, link)| Some((index, messages::massless(&link.item, link.joint_name()?.get_ref()))))
        .collect()
}

/// The link whose joint moves that of a link in the end, as far as it can be read: itself, unless its joint mimics another.
fn followed(document: &Document, link: usize) -> usize {
    let next = |link: &usize| {
        let mimic = document.links[*link].mimic.value()?;
        mimicked(&document.links, mimic.joint.as_ref()?.get_ref())
    };
    // Mimics that lead back to themselves have been reported.
    std::iter::successors(Some(link), next).take(document.links.len()).last().unwrap_or(link)
}

/// Whether there is a rotor for each velocity of the joint; a faulty entry counts, since it may have been meant so.
fn has_rotors(link: &LinkTable) -> bool {
    let armature = link.physics.armature.value_or(0.0.into());
    armature.is_none_or(|armature| armature.values().iter().all(|armature| *armature > 0.0))
}

/// Mass or inertia; a faulty entry counts, since it may have been meant so.
fn has_mass(link: &LinkTable) -> bool {
    link.mass.value() != Some(&0.0) || link.inertia.value_or(Inertia::default()) != Some(Inertia::default())
}
