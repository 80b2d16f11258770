//! Whether the camera of a page moves along with the mechanism, and with which of its links.

use redysim_model::{JointKind, Link, Model};
use serde::Serialize;

use crate::carriers::{carriers, stands_on_ground};
use crate::failure::Failure;

/// How the camera moves while a run is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Camera {
    /// Along with the base that moves.
    Follow,
    /// Not at all.
    Fixed,
}

impl Camera {
    /// # Errors
    /// If it is to follow a base and none moves.
    pub fn check(self, model: &Model) -> Result<(), Failure> {
        if self == Camera::Fixed || moving_base(model).is_some() {
            return Ok(());
        }
        let message = format!(
            "the camera cannot follow `{}`: it follows a base, a link on a `free` or `planar` joint to the ground, and \
             finds {}",
            model.name,
            joints_to_ground(model)
        );
        Err(Failure::command_line(message).help("leave --camera out, or take --camera fixed"))
    }
}

/// The number of the link that the camera can follow, which a `free` or `planar` joint ties to the ground: of several
/// the one that carries the most links.
pub fn moving_base(model: &Model) -> Option<usize> {
    let bases = (0..model.links.len()).filter(|&link| is_base(model, &model.links[link]));
    let carried =
        |base: usize| (0..model.links.len()).filter(|&link| carriers(model, Some(link)).any(|by| by == base)).count();
    // `max_by_key` takes the last of equals, and the first one is meant.
    bases.rev().max_by_key(|&base| carried(base))
}

/// Whether a link moves freely over the ground or in space.
fn is_base(model: &Model, link: &Link) -> bool {
    matches!(link.joint, JointKind::Free | JointKind::Planar) && stands_on_ground(model, link)
}

/// The kinds of the joints that tie links to the ground, each once.
fn joints_to_ground(model: &Model) -> String {
    let mut kinds: Vec<_> = Vec::new();
    for link in model.links.iter().filter(|link| link.joint != JointKind::Fixed && stands_on_ground(model, link)) {
        let kind = format!("`{}`", link.joint.name());
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    if kinds.is_empty() { "none".into() } else { format!("{} alone", kinds.join(", ")) }
}
