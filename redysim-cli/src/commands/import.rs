//! `redysim import ROBOT.urdf`: a model file from a URDF.

use std::path::PathBuf;

use crate::failure::Failure;
use crate::model::is_urdf;
use crate::output::{print, to_stderr, write_beside};
use crate::urdf::{Base, Imported, Options, import, read};

/// Make a model file from a URDF, and report what changes.
///
/// Joints keep their order, names, origins and axes. The root link becomes the ground, or with `--base free` a link on a
/// free joint `base` without an actuator. Inertias are turned into the links' axes. Continuous joints become revolute.
/// Floating joints become free, and planar ones stay planar, both without an actuator. Spherical joints stay spherical.
/// Joints that mimic others do so here if both have one coordinate. Joints that move no mass become fixed, unless
/// one that moves with them moves some. Limits of positions and velocity become a `range`. Damping and friction are kept, but of floating and planar joints as comments. Other
/// numbers, such as transmission ratios, other limits and what a joint that becomes fixed had, stay as comments beside their
/// links; those of the root stay in the model's head. Visuals and collisions are left out. Whatever changes or is left out is reported, here and in the model's head.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  redysim import panda.urdf -o panda.toml
  redysim import ur5.urdf --fuse-fixed | less
  redysim import satellite.urdf --base free -o satellite.toml
  xacro robot.urdf.xacro > robot.urdf && redysim import robot.urdf -o robot.toml && redysim check robot.toml")]
pub struct Arguments {
    /// The URDF file.
    robot: PathBuf,
    /// Write to this file instead of printing.
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// What the root link is: the ground, or a link that floats on a free joint.
    #[arg(long, value_enum, default_value_t)]
    base: Base,
    /// Keep fixed links as links of their own (the default).
    #[arg(long, conflicts_with = "fuse_fixed")]
    keep_fixed: bool,
    /// Make fixed links parts of the links that carry them; their frames are lost.
    #[arg(long)]
    fuse_fixed: bool,
    /// Make angles that are nearly multiples of 90 deg, such as 1.5708 and 3.14, exact: compiled code gets shorter.
    #[arg(long)]
    quarter_turns: bool,
    /// Overwrite a file that is there already.
    #[arg(long)]
    force: bool,
}

/// Imports the robot.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let path = &arguments.robot;
    if let Some(output) = arguments.output.as_deref().filter(|output| is_urdf(output)) {
        let failure =
            Failure::command_line(format!("the output is a model file, but {} ends with .urdf", output.display()));
        return Err(failure.help("name a file that ends with .toml"));
    }
    let &Arguments { fuse_fixed, quarter_turns, base, .. } = arguments;
    let options = Options { fuse_fixed, quarter_turns, base };
    let imported = import(&read(path)?, path, options)?;
    let Imported { text, changes, notes, .. } = &imported;
    match &arguments.output {
        Some(output) => write_beside(path, output, text.as_bytes(), arguments.force)?,
        None => print(text)?,
    }
    if !quiet {
        changes.iter().for_each(|change| to_stderr(&format!("warning: {change}")));
        notes.iter().for_each(|note| to_stderr(&format!("note: {note}")));
        imported.shown_warnings("--quarter-turns").iter().for_each(|line| to_stderr(line));
        if let Some(output) = &arguments.output {
            to_stderr(&format!("\nThe model is in {0}: redysim check {0}", output.display()));
        }
    }
    Ok(())
}
