//! What is drawn: the pages of `redysim animate` and `redysim show`, and the pictures of `redysim plot`.

#[path = "../common/mod.rs"]
mod common;

mod animate;
mod meshes;
mod pictures;
mod plot;
mod rover;
mod show;
mod viewer;
mod viewer_show;
