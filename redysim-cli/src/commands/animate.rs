//! `redysim animate RESULTS`.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::output;
use crate::page::{Camera, Page};
use crate::recorded::Recorded;
use crate::results::names::{PAGE, is_written};

/// Make a page of HTML, complete in itself, that plays a run in 3D beside its curves.
///
/// If the scenario's model is a URDF, the links have its meshes (STL, DAE and OBJ, without textures), up to 20 MB.
#[derive(clap::Args)]
#[command(
    after_help = "Examples:\n  redysim animate results/kuka/forward -o kuka.html\n  redysim animate results/kuka/forward --camera fixed"
)]
pub struct Arguments {
    /// The folder of results.
    results: PathBuf,
    /// The page [default: animation.html in the results' folder].
    #[arg(long, short, value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// Whether the camera follows a moving base, on a free or planar joint to the ground, or stands still; the page has a
    /// box to change it [default: follow where the base travels farther than the mechanism reaches beside its way].
    #[arg(long, value_name = "HOW")]
    camera: Option<Camera>,
    /// Overwrite a page that is there already.
    #[arg(long)]
    force: bool,
}

/// Makes the page.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let recorded = Recorded::open(&arguments.results)?;
    let path = arguments.output.clone().unwrap_or_else(|| recorded.folder().join(PAGE));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = |folder: &Path| path.parent().is_some_and(|parent| same(parent, folder));
    if name != PAGE && is_written(&name) && beside(recorded.folder()) {
        let message = format!("{} is a file of the results", path.display());
        return Err(Failure::command_line(message).help("write elsewhere with --output, as in --output page.html"));
    }
    // Before what takes its time.
    output::check_place(&path, arguments.force)?;
    Page::of_run(&recorded, arguments.camera)?.write(&path, arguments.force, quiet)
}

/// Whether two paths lead to the same folder.
fn same(a: &Path, b: &Path) -> bool {
    let real = |path: &Path| std::fs::canonicalize(if path.as_os_str().is_empty() { Path::new(".") } else { path });
    real(a).is_ok_and(|a| real(b).is_ok_and(|b| a == b))
}
