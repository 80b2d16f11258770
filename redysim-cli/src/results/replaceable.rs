//! What a new result may replace: nothing but another result.

use std::fs;
use std::path::Path;

use super::names::{RUN_FILE, is_written};
use super::run_file::is_of_a_run;
use crate::failure::Failure;
use crate::output::exists;

/// Whether a path is that of an empty folder.
pub fn is_empty(path: &Path) -> bool {
    let is_folder = fs::symlink_metadata(path).is_ok_and(|found| found.is_dir());
    is_folder && fs::read_dir(path).is_ok_and(|mut entries| entries.next().is_none())
}

/// Whether there is something at `target` that is to be replaced.
///
/// # Errors
/// If it is anything but an empty folder, and `force` is not given, or if it is not a result, or one with anything
/// beside what this program writes: notes would be lost.
pub fn replaces(target: &Path, force: bool) -> Result<bool, Failure> {
    // A path without metadata cannot be written either, and writing reports the reason.
    let Ok(found) = fs::symlink_metadata(target) else { return Ok(false) };
    if is_empty(target) {
        return Ok(true);
    }
    let kept = |why: &str, help: &str| {
        let message = format!("{} is not overwritten: {why}", target.display());
        Err(Failure::outside(message).help(help))
    };
    if !found.is_dir() {
        return kept(
            "it is not a folder of its own, but a file or a link",
            "write elsewhere with --output, or delete it yourself",
        );
    }
    if !force {
        return Err(exists(target));
    }
    let unreadable = |error| Failure::file("read", target, &error);
    let entries = fs::read_dir(target).map_err(unreadable)?.collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    let foreign = |entry: &fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        let is_ours = is_written(&name) && entry.file_type().is_ok_and(|kind| kind.is_file());
        (!is_ours).then_some(name)
    };
    let foreign = entries.iter().filter_map(foreign).min();
    if !fs::read_to_string(target.join(RUN_FILE)).is_ok_and(|text| is_of_a_run(&text)) {
        let why = format!("it is not a result, for it holds no {RUN_FILE} that a run has written");
        return kept(&why, "write elsewhere with --output, or delete it yourself");
    }
    match foreign {
        Some(name) => kept(
            &format!("it holds {name}, which is of no run"),
            "move that elsewhere first, or write elsewhere with --output",
        ),
        None => Ok(true),
    }
}
