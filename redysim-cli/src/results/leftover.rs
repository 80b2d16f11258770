//! What runs that were killed have left beside their results: nothing deletes it, for only its user knows whether the part
//! of a run, or the result that was to be replaced, is still of use.

use std::fs;
use std::path::{Path, PathBuf};

/// How the names of what is there until a result is end, after the number of the process.
pub const DRAFT: &str = "draft";
pub const BEFORE: &str = "before";

/// What is left of a run.
enum Leftover {
    /// A part of its results.
    Draft,
    /// The earlier result, which it was replacing.
    Before,
}

/// A warning for each folder that a run to `target` has left, with what to do.
pub fn warnings(target: &Path) -> Vec<String> {
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = fs::read_dir(folder) else { return vec![] };
    let left = entries.flatten().filter_map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        Some((target.with_file_name(&name), left_by_a_killed_run(target, &name)?))
    });
    let mut left: Vec<(PathBuf, Leftover)> = left.collect();
    left.sort_by(|a, b| a.0.cmp(&b.0));
    let warning = |(path, what): (PathBuf, Leftover)| {
        let path = path.display();
        let what = match what {
            Leftover::Draft => "a run that was killed has left its draft",
            Leftover::Before => "a run that was killed while it replaced a result has left the earlier one",
        };
        format!("warning: {what}: {path}\n  = help: unless it is of use, delete it: rm -r \"{path}\"\n")
    };
    left.into_iter().map(warning).collect()
}

/// What `name` is beside `target`, if it is of a run that does not go on.
fn left_by_a_killed_run(target: &Path, name: &str) -> Option<Leftover> {
    let target = target.file_name()?.to_string_lossy();
    let (id, kind) = name.strip_prefix(&*target)?.strip_prefix('.')?.split_once('.')?;
    let id: u32 = id.parse().ok()?;
    let leftover = match kind.split_once('-').map_or(kind, |(kind, _)| kind) {
        DRAFT => Leftover::Draft,
        BEFORE => Leftover::Before,
        _ => return None,
    };
    (!goes_on(id)).then_some(leftover)
}

/// Whether another process with that number is this program and runs, as far as the system tells.
fn goes_on(id: u32) -> bool {
    let program = |id: &str| fs::read_to_string(format!("/proc/{id}/comm")).ok();
    // One that has ended stays until its parent takes notice, which some containers never do.
    let has_ended = |id: u32| {
        let status = fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
        status.lines().any(|line| line.starts_with("State:\tZ") || line.starts_with("State:\tX"))
    };
    let is_here = program(&id.to_string()).is_some_and(|other| Some(other) == program("self"));
    id != std::process::id() && is_here && !has_ended(id)
}
