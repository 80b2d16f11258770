//! What carries the links of a model.

use redysim_model::{JointKind, Link, Model};

/// A link and those that carry it, down to the ground.
pub fn carriers(model: &Model, link: Option<usize>) -> impl Iterator<Item = usize> {
    std::iter::successors(link, |&link| model.links[link].parent)
}

/// Whether nothing that moves carries a link.
pub fn stands_on_ground(model: &Model, link: &Link) -> bool {
    carriers(model, link.parent).all(|carrier| model.links[carrier].joint == JointKind::Fixed)
}
