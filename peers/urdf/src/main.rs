//! Dynamics of a model file at given states, by redysim's generic path: `redysim-evaluate MODEL.toml < STATES`.
//! What it reads and prints is described at [`redysim_evaluate::answer`].

use redysim::generic::{GenericMechanism, Model};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which model file?")?;
    redysim_evaluate::answer(&GenericMechanism::new(Model::load(path)?.model))
}
