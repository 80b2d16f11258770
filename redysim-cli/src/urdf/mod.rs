//! From a URDF to a model file, with what gets lost on the way.

mod comments;
mod document;
mod elements;
mod fixed;
mod inertial;
mod model_file;
mod notation;
mod origin;
mod robot;
mod spelling;
mod visuals;

use std::fs;
use std::path::Path;

use document::Document;
use model_file::ModelFile;
use redysim_model::{Diagnostic, Diagnostics, JointKind, Lint, Model};
use robot::Robot;
pub use visuals::Visual;

use crate::failure::{Failure, Fault};
use crate::number::{counted, rounded};

/// A model file, and what a person should know about it.
pub struct Imported {
    /// The text of the model file.
    pub text: String,
    /// The model.
    pub model: Model,
    /// The joints that move otherwise than in the URDF, and names that are probably misspelled.
    pub changes: Vec<String>,
    /// What is left out or written otherwise.
    pub notes: Vec<String>,
    /// What the checks of a model find odd.
    pub warnings: Vec<Diagnostic>,
}

impl Imported {
    /// What the checks of a model find odd, a line each, and at the end what `option` does about angles that are nearly
    /// multiples of 90°, if there are any.
    pub fn shown_warnings(&self, option: &str) -> Vec<String> {
        let (shown, more) = Diagnostics::shown(&self.warnings);
        let shown = shown.into_iter().map(|warning| format!("warning: {}", warning.title()));
        let mut shown: Vec<_> = shown.chain(more).collect();
        if self.warnings.iter().any(|warning| warning.lint() == Some(Lint::RoundedAngle.name())) {
            shown.push(format!("  = help: {option} makes angles that are nearly multiples of 90 deg exact"));
        }
        shown
    }
}

/// What is done with a robot beside writing it down.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Fixed links become parts of their parents.
    pub fuse_fixed: bool,
    /// Angles that are nearly multiples of 90° are made so.
    pub quarter_turns: bool,
    /// What the root link is.
    pub base: Base,
}

/// What the root link of a robot is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Base {
    /// The ground.
    #[default]
    Fixed,
    /// A link on a free joint `base`, which has no actuator.
    Free,
}

/// The text of the URDF file at `path`.
///
/// # Errors
/// If it cannot be read, or is not UTF-8.
pub fn read(path: &Path) -> Result<String, Failure> {
    text(fs::read(path).map_err(|error| Failure::file("read", path, &error))?, path)
}

/// The text of the bytes of the URDF file at `path`.
///
/// # Errors
/// If they are not UTF-8.
pub fn text(bytes: Vec<u8>, path: &Path) -> Result<String, Failure> {
    String::from_utf8(bytes).map_err(|error| {
        let byte = error.utf8_error().valid_up_to() + 1;
        Failure::input(format!("{} is not UTF-8 (byte {byte})", path.display())).help("save the file as UTF-8")
    })
}

/// The meshes with which the URDF file at `path` draws its links, numbered as in the imported model.
///
/// # Errors
/// If it cannot be read, or is not a URDF.
pub fn visuals(path: &Path) -> Result<Vec<Visual>, Failure> {
    Ok(Document::parse(&read(path)?, &path.display().to_string())?.visuals())
}

/// Imports the text of the URDF file at `path`.
///
/// # Errors
/// If the file is not a URDF, its robot is not a tree, or its values are impossible. Messages have the file's line.
pub fn import(text: &str, path: &Path, options: Options) -> Result<Imported, Failure> {
    let file = path.display().to_string();
    let document = Document::parse(text, &file)?;
    let mut robot = Robot::read(&document, options.base)?;
    if robot.name.trim().is_empty() {
        robot.name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        robot.notes.push(format!("the robot has no name: it is called `{}` after its file", robot.name));
    }
    if options.quarter_turns {
        robot = robot.with_quarter_turns();
    }
    robot = robot.without_reserved_name().without_massless_motion().with_possible_mimics().with_possible_limits();
    robot = robot.with_comments(&document);
    let remarks = robot.links.iter().flat_map(|link| &link.remarks).cloned();
    let changes: Vec<String> =
        document.unknown_version().into_iter().chain(document.misspelled()).chain(remarks).collect();
    if robot.links.iter().all(|link| link.kind == JointKind::Fixed) {
        return Err(document.fault(document.robot(), "every joint is fixed here: nothing of the robot moves"));
    }
    if options.fuse_fixed {
        robot = robot.fused();
    }
    let limited = robot.links.iter().filter(|link| link.limit.is_some()).count();
    if limited > 0 {
        robot.notes.push(format!(
            "the limits of {} do not limit the motion: they are kept as ranges or comments",
            counted(limited, "joint")
        ));
    }
    robot.notes.extend(
        document.left_out(comments::is_kept, comments::of_no_joint).into_iter().map(|what| format!("left out: {what}")),
    );
    let fused = robot.links.iter().flat_map(|link| &link.remarks).filter(|remark| !changes.contains(remark)).cloned();
    let notes = robot.notes.iter().cloned().chain(fused).collect();
    let written = model_file::write(&robot, &head(&robot, &changes, path));
    let loaded = Model::from_toml(written.text.clone(), file.clone()).map_err(|faults| {
        let (shown, more) = Diagnostics::shown(faults.errors());
        let shown = shown.into_iter().map(|error| Fault {
            line: error.position().map_or(1, |(line, _)| urdf_line(line, &written, &robot, &document)),
            column: None,
            title: error.title().into(),
            help: error.help().into(),
        });
        Failure::faults_of(&file, shown.collect(), &more)
    })?;
    Ok(Imported { text: written.text, model: loaded.model, changes, notes, warnings: loaded.warnings })
}

/// The line of the URDF from which a line of the model file comes: of the link for what it weighs, else of its joint.
fn urdf_line(line: usize, written: &ModelFile, robot: &Robot, document: &Document) -> u32 {
    let Some(index) = written.lines.iter().rposition(|&first| first <= line) else { return 1 };
    let text = written.text.lines().nth(line - 1).unwrap_or_default();
    let link = &robot.links[index];
    let weighs = ["name", "mass", "com", "inertia"].iter().any(|key| text.starts_with(key));
    if weighs || link.is_root {
        document.line_of("link", &link.name)
    } else {
        document.line_of("joint", &link.joint_name)
    }
}

/// What stands at the head of the model file.
fn head(robot: &Robot, changes: &[String], path: &Path) -> Vec<String> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let moving = robot.links.iter().filter(|link| link.kind != JointKind::Fixed).count();
    let first = format!(
        "From {name}, by redysim import: {}, {}, {} kg.",
        counted(robot.links.len(), "link"),
        counted(moving, "moving joint"),
        rounded(robot.mass())
    );
    let notes = changes.iter().chain(&robot.notes).map(|note| format!("- {note}"));
    [first, String::new()].into_iter().chain(notes).collect()
}
