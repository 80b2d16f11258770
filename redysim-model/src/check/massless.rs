//! Every joint moves something: the structural reason for a singular mass matrix. The numerical one is in
//! [`super::singular`].

use crate::messages;
use crate::model::Inertia;
use crate::schema::{Document, LinkTable};
use redysim_toml::Message;

/// Each moving link that has neither mass nor inertia and carries none, and whose joint does not have an armature, with
/// its message: its row of the mass matrix is zero.
pub(super) fn check(document: &Document, parents: &[Option<usize>]) -> Vec<(usize, Message)> {
    let mut carries = vec![false; document.links.len()];
    for (i, link) in document.links.iter().enumerate() {
        let mut at = Some(i).filter(|_| has_mass(link));
        while let Some(link) = at.filter(|&link| !carries[link]) {
            carries[link] = true;
            at = parents[link];
        }
    }
    let weightless = document.links.iter().enumerate().zip(carries).filter(|(_, carries)| !carries);
    let moving = weightless.map(|(link, _)| link).filter(|(_, link)| link.joint.value().is_some() && !link.is_rigid());
    let moving = moving.filter(|(_, link)| matches!(link.physics.armature.value_or(0.0), Some(0.0)));
    moving
        .filter_map(|(index, link)| Some((index, messages::massless(&link.item, link.joint_name()?.get_ref()))))
        .collect()
}

/// Mass or inertia; a faulty entry counts, since it may have been meant so.
fn has_mass(link: &LinkTable) -> bool {
    link.mass.value() != Some(&0.0) || link.inertia.value_or(Inertia::default()) != Some(Inertia::default())
}
