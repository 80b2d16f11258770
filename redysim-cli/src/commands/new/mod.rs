//! `redysim new NAME`: a crate with a robot, a program that computes its dynamics, and a test.

mod checkout;
mod name;
mod program;
mod robot;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::output::to_stderr;
use robot::Robot;

/// Make a crate with a robot, a program that prints its inverse and forward dynamics, and a test.
///
/// The crate has the robot's model file, which redysim! compiles: what is wrong in it is a compile error. The program of
/// a robot with closed loops begins where they are closed.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  redysim new arm
  redysim new panda-dynamics --robot panda.urdf
  redysim new linkage --robot models/slider_crank.toml")]
pub struct Arguments {
    /// The folder to make; its name is that of the crate.
    #[arg(value_name = "NAME")]
    folder: PathBuf,
    /// The robot: kr5 (an arm), gripper (a tree) or fourbar (a closed loop), a model file, or a URDF.
    #[arg(long, value_name = "ROBOT", default_value = "kr5")]
    robot: PathBuf,
    /// The checkout of redysim on which the crate depends [default: the one that this command is built from, or if it
    /// is gone, the published version].
    #[arg(long, value_name = "FOLDER")]
    redysim: Option<PathBuf>,
}

/// Makes the crate.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let folder = &arguments.folder;
    let name = name::of(folder)?;
    if folder.symlink_metadata().is_ok() {
        let message = format!("{} exists already", folder.display());
        return Err(Failure::outside(message).help("choose another name: nothing is overwritten"));
    }
    let parent = folder.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !parent.exists() {
        let message = format!("{} cannot be made: the folder {} does not exist", folder.display(), parent.display());
        return Err(Failure::outside(message).help("make that folder first, or choose another name"));
    }
    let parent = fs::canonicalize(parent).map_err(|error| Failure::file("read the folder", parent, &error))?;
    let built_from = Path::new(env!("CARGO_MANIFEST_DIR")).parent();
    let redysim = checkout::dependency(arguments.redysim.as_deref(), built_from, quiet)?;
    let robot = Robot::named(&arguments.robot, quiet)?;
    let files = [
        ("Cargo.toml", manifest(&name, &redysim, &parent)),
        ("README.md", readme(&name, &robot)),
        (".gitignore", "/target\n".to_string()),
        ("src/main.rs", program::of(&robot)?),
        (&robot.path(), robot.text.clone()),
    ];
    write(&parent, folder, &files).map_err(|error| Failure::file("make the folder", folder, &error))?;
    if !quiet {
        to_stderr(&format!("The crate is in {0}: cd {0}, then cargo run and cargo test", folder.display()));
    }
    Ok(())
}

/// Makes the folder with all of the files, or nothing.
fn write(parent: &Path, folder: &Path, files: &[(&str, String)]) -> io::Result<()> {
    let draft = tempfile::Builder::new().prefix(".redysim-new-").tempdir_in(parent)?;
    let made = draft.path().join("crate");
    for (path, text) in files {
        let path = made.join(path);
        fs::create_dir_all(path.parent().unwrap_or(&made))?;
        fs::write(path, text)?;
    }
    fs::rename(made, parent.join(folder.file_name().unwrap_or_default()))
}

fn manifest(name: &str, redysim: &str, parent: &Path) -> String {
    let in_workspace = parent.ancestors().any(|folder| folder.join("Cargo.toml").exists());
    let workspace =
        if in_workspace { "\n# Not a member of a workspace in the folders above.\n[workspace]\n" } else { "" };
    format!(
        "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\npublish = false\n\n[dependencies]\n\
         redysim = {redysim}\n{workspace}"
    )
}

fn readme(name: &str, robot: &Robot) -> String {
    format!(
        "# {name}\n\nInverse and forward dynamics of {}, by redysim: `cargo run`, then `cargo test`. The robot is \
         `{}`, the program `src/main.rs`.\n",
        robot.title(),
        robot.path()
    )
}
