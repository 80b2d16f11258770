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
///
/// Of a URDF, the page shows the model that `redysim import` makes, and the meshes of its links (STL, DAE and OBJ, without
/// textures), up to 20 MB. Files of `package://` are looked for above the URDF's folder, on ROS_PACKAGE_PATH and on
/// AMENT_PREFIX_PATH.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim show models/kr5.toml -o kr5.html")]
pub struct Arguments {
    /// The model file, or a URDF.
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
    let read = model::read(&arguments.model, quiet)?;
    output::check_beside(&arguments.model, &path, arguments.force)?;
    Page::of_model(&read.model, read.urdf.as_deref())?.write(&path, arguments.force, quiet)
}
