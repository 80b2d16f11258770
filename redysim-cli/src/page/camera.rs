//! Whether the camera of a page moves along with the mechanism.

use redysim_model::{JointKind, Model};
use serde::Serialize;

use crate::failure::Failure;

/// How the camera moves while a run is played.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Camera {
    /// Along with the base that floats.
    Follow,
    /// Not at all.
    Fixed,
}

impl Camera {
    /// # Errors
    /// If it is to follow a base that does not float.
    pub fn check(self, model: &Model) -> Result<(), Failure> {
        let floats = model.links.iter().any(|link| link.parent.is_none() && link.joint == JointKind::Free);
        if self == Camera::Fixed || floats {
            return Ok(());
        }
        let message = format!("the camera cannot follow `{}`: none of its links floats on a `free` joint", model.name);
        Err(Failure::command_line(message).help("leave --camera out, or take --camera fixed"))
    }
}
