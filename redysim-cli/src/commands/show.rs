//! `redysim show MODEL`.

use std::path::PathBuf;

use crate::failure::Failure;
use crate::model;
use crate::output;
use crate::page::Page;

/// Make a page of HTML, complete in itself, that shows a model in 3D and moves its joints by sliders.
///
/// Link frames, frames of interest, joint axes, centres of mass and the ellipsoids of uniform density that have the links'
/// masses and inertias can be shown and hidden. Sliders go over the joints' ranges; without one, over a turn, or over the
/// length of the mechanism in either direction. Closed loops stay closed: the other joints follow.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim show models/kr5.toml -o kr5.html")]
pub struct Arguments {
    /// The model file.
    model: PathBuf,
    /// The page [default: named after the model, in the current folder].
    #[arg(long, short, value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// Overwrite a page that is there already.
    #[arg(long)]
    force: bool,
}

/// Makes the page.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let beside = || PathBuf::from(arguments.model.with_extension("html").file_name().unwrap_or_default());
    let path = arguments.output.clone().unwrap_or_else(beside);
    let loaded = model::load(&arguments.model, quiet)?;
    output::check_beside(&arguments.model, &path, arguments.force)?;
    Page::of_model(&loaded.model)?.write(&path, arguments.force, quiet)
}
