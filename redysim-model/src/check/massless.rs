//! Every joint moves something: the structural reason for a singular mass matrix. The numerical one is in
//! [`super::singular`].

use crate::diagnostic::{Findings, messages};
use crate::model::Inertia;
use crate::schema::{Document, LinkTable};

/// Reports each moving link that has neither mass nor inertia and carries none: its row of the mass matrix is zero.
pub(super) fn check(document: &Document, parents: &[Option<usize>], findings: &mut Findings) {
    let mut carries = vec![false; document.links.len()];
    for (i, link) in document.links.iter().enumerate() {
        let mut at = Some(i).filter(|_| has_mass(link));
        while let Some(link) = at.filter(|&link| !carries[link]) {
            carries[link] = true;
            at = parents[link];
        }
    }
    for (link, _) in document.links.iter().zip(carries).filter(|(_, carries)| !carries) {
        let moves = link.joint.value().is_some() && !link.is_rigid();
        if let Some(joint) = link.joint_name().filter(|_| moves) {
            findings.error(link.place(), messages::massless(&link.item, joint.get_ref()));
        }
    }
}

/// Mass or inertia; a faulty entry counts, since it may have been meant so.
fn has_mass(link: &LinkTable) -> bool {
    link.mass.value() != Some(&0.0) || link.inertia.value_or(Inertia::default()) != Some(Inertia::default())
}
