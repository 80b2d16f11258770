//! A folder that is there whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::output::{exists, write_file};

/// The file that every result has.
pub const RUN_FILE: &str = "run.toml";

/// A folder under a draft's name, which goes away unless it is finished.
pub struct Folder {
    target: PathBuf,
    draft: PathBuf,
    /// Folders that were made for it, the innermost first.
    made: Vec<PathBuf>,
    finished: bool,
}

impl Folder {
    /// Begins the folder `target`.
    ///
    /// # Errors
    /// If it cannot be made, if it is there already and `force` is not given, or if it holds something else than a
    /// result.
    pub fn draft(target: PathBuf, force: bool) -> Result<Folder, Failure> {
        let Some(name) = target.file_name() else {
            let message = format!("{} is no name for a new folder", target.display());
            return Err(Failure::outside(message).help("name one with --output, as in --output results/trial"));
        };
        if target.exists() {
            if !force {
                return Err(exists(&target));
            }
            if !replaceable(&target) {
                let message =
                    format!("{} is not overwritten: it holds no {RUN_FILE}, so it is no result", target.display());
                return Err(Failure::outside(message).help("write elsewhere with --output, or delete it yourself"));
            }
        }
        let draft = target.with_file_name(named(name, "draft"));
        let parent = target.parent().unwrap_or(Path::new(""));
        let missing = parent.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let mut folder = Folder { draft, made: missing.map(Path::to_owned).collect(), target, finished: false };
        fs::create_dir_all(&folder.draft).map_err(|error| {
            // Of what could not be made nothing is to be taken away but what was.
            folder.made.retain(|made| made.exists());
            Failure::file("make the folder", &folder.target, &error)
        })?;
        Ok(folder)
    }

    /// Writes a file in it.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Failure> {
        write_file(&self.draft.join(name), contents, false)
    }

    /// Copies a file into it.
    pub fn copy(&self, name: &str, from: &Path) -> Result<(), Failure> {
        self.write(name, &fs::read(from).map_err(|error| Failure::file("read", from, &error))?)
    }

    /// Gives it its name, and returns it. What was there before goes away only then.
    pub fn finish(mut self) -> Result<PathBuf, Failure> {
        let failed = |error: &std::io::Error| Failure::file("write", &self.target, error);
        let before = self.target.with_file_name(named(self.target.file_name().unwrap_or_default(), "before"));
        let replaces = self.target.exists();
        if replaces {
            fs::rename(&self.target, &before).map_err(|error| failed(&error))?;
        }
        if let Err(error) = fs::rename(&self.draft, &self.target) {
            if replaces {
                // If this fails, too, the earlier result is still there under the other name.
                let _ = fs::rename(&before, &self.target);
            }
            return Err(failed(&error));
        }
        self.finished = true;
        if replaces {
            fs::remove_dir_all(&before).map_err(|error| Failure::file("remove", &before, &error))?;
        }
        Ok(self.target.clone())
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.finished {
            // There is nobody left to tell if this fails; a folder that is not empty stays.
            let _ = fs::remove_dir_all(&self.draft);
            for made in &self.made {
                let _ = fs::remove_dir(made);
            }
        }
    }
}

fn named(name: &std::ffi::OsStr, what: &str) -> std::ffi::OsString {
    let mut name = name.to_os_string();
    name.push(format!(".{}.{what}", std::process::id()));
    name
}

/// Whether a folder is a result, or empty.
fn replaceable(folder: &Path) -> bool {
    folder.join(RUN_FILE).is_file() || fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_none())
}
