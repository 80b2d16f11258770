//! A folder that is there whole or not at all.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::leftover::{BEFORE, DRAFT};
use super::replaceable::{is_empty, replaces};
use crate::failure::Failure;
use crate::interrupt;
use crate::output::{to_stderr, write_file};

/// For so long a draft is taken away from a run that goes on writing.
const TRIES: u32 = 500;
const PAUSE: Duration = Duration::from_millis(1);

/// A folder under a draft's name, which goes away unless it is finished.
pub struct Folder {
    target: PathBuf,
    /// Whether a result that is there is replaced.
    force: bool,
    draft: Draft,
    finished: bool,
}

/// What is there until the folder is.
#[derive(Clone)]
struct Draft {
    path: PathBuf,
    /// Folders that were made for it, the innermost first.
    made: Vec<PathBuf>,
}

impl Folder {
    /// Begins the folder `target`.
    ///
    /// # Errors
    /// If it cannot be made, or if something is there already that must not be replaced.
    pub fn draft(target: PathBuf, force: bool) -> Result<Folder, Failure> {
        if target.file_name().is_none() {
            let message = format!("{} cannot be the name of a new folder", target.display());
            return Err(Failure::outside(message).help("name one with --output, as in --output results/trial"));
        }
        replaces(&target, force)?;
        let parent = target.parent().unwrap_or(Path::new(""));
        let missing = parent.ancestors().take_while(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        let mut draft = Draft { path: PathBuf::new(), made: missing.map(Path::to_owned).collect() };
        // One that is there already is of a run that was killed, and its files are not this run's.
        let made = fs::create_dir_all(parent).and_then(|()| {
            let own = |count: u64| if count == 1 { String::new() } else { format!("-{count}") };
            let names = (1..).map(|count| beside(&target, &format!(".{}.{DRAFT}{}", std::process::id(), own(count))));
            first_free(names, |path| fs::create_dir(path))
        });
        draft.path = made.map_err(|error| {
            draft.discard_parents();
            Failure::file("make the folder", &target, &error)
        })?;
        let leftover = draft.clone();
        interrupt::before_end(move || leftover.discard());
        Ok(Folder { target, force, draft, finished: false })
    }

    /// Where its files are until it is finished.
    pub fn path(&self) -> &Path {
        &self.draft.path
    }

    /// Begins a file in it.
    pub fn create(&self, name: &str) -> Result<fs::File, Failure> {
        let path = self.draft.path.join(name);
        fs::File::create(&path).map_err(|error| Failure::file("write", &path, &error))
    }

    /// Writes a file in it.
    pub fn write(&self, name: &str, contents: &[u8]) -> Result<(), Failure> {
        write_file(&self.draft.path.join(name), contents, false)
    }

    /// Gives it its name, and returns it. What was there before goes away only then, and only for what is `complete`: a
    /// part of a run stands beside it.
    ///
    /// # Errors
    /// If something is there by now that must not be replaced, or the name cannot be given: the folder then gets
    /// another, and the failure names it.
    pub fn finish(mut self, complete: bool) -> Result<PathBuf, Failure> {
        interrupt::undisturbed(|| {
            let replaces = replaces(&self.target, self.force);
            self.finished = true;
            if !complete && replaces.as_ref().is_ok_and(|replaces| *replaces) && !is_empty(&self.target) {
                let failed = |error| Failure::file("rename", &self.draft.path, &error);
                return self.aside().map_err(failed);
            }
            let named = replaces.and_then(|replaces| self.name(replaces));
            named.map_err(|failure| match self.aside() {
                Ok(path) => failure.and(&format!("; what was computed is in {}", path.display())),
                Err(error) => {
                    let path = self.draft.path.display();
                    failure.and(&format!("; what was computed is left in {path}, which cannot be renamed: {error}"))
                }
            })?;
            Ok(self.target.clone())
        })
    }

    /// Moves it to its place; `replaces` what is there.
    fn name(&self, replaces: bool) -> Result<(), Failure> {
        let failed = |error| Failure::file("write", &self.target, &error);
        let before = beside(&self.target, &format!(".{}.{BEFORE}", std::process::id()));
        if replaces {
            fs::rename(&self.target, &before).map_err(failed)?;
        }
        if let Err(error) = fs::rename(&self.draft.path, &self.target) {
            if replaces {
                // If this fails, too, the earlier result is still there under the other name.
                let _ = fs::rename(&before, &self.target);
            }
            return Err(failed(error));
        }
        if replaces && let Err(error) = fs::remove_dir_all(&before) {
            // The result is in its place: this is not a failure.
            to_stderr(&format!("warning: the result that was replaced is left in {}: {error}", before.display()));
        }
        Ok(())
    }

    /// Moves it beside its place, to the first free of `<name>-2`, `<name>-3`, …
    fn aside(&self) -> std::io::Result<PathBuf> {
        let names = (2..).map(|count: u64| beside(&self.target, &format!("-{count}")));
        first_free(names, |path| fs::rename(&self.draft.path, path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if !self.finished {
            interrupt::undisturbed(|| self.draft.discard());
        }
    }
}

impl Draft {
    fn discard(&self) {
        // A run that is ended at once may be writing into it meanwhile, until it is gone; if it stays, that cannot be
        // reported any more.
        for _ in 0..TRIES {
            if fs::remove_dir_all(&self.path).is_ok() || !self.path.exists() {
                break;
            }
            std::thread::sleep(PAUSE);
        }
        self.discard_parents();
    }

    fn discard_parents(&self) {
        for made in &self.made {
            let _ = fs::remove_dir(made);
        }
    }
}

/// The first of `names` that is free, once `taken`; another run may take one meanwhile.
fn first_free(
    names: impl Iterator<Item = PathBuf>,
    take: impl Fn(&Path) -> std::io::Result<()>,
) -> std::io::Result<PathBuf> {
    for path in names {
        if fs::symlink_metadata(&path).is_ok() {
            continue;
        }
        match take(&path) {
            Err(_) if fs::symlink_metadata(&path).is_ok() => {}
            taken => return taken.map(|()| path),
        }
    }
    Err(std::io::ErrorKind::AlreadyExists.into())
}

/// A path whose last name has `more` at its end.
fn beside(path: &Path, more: &str) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(more);
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As of a run that was killed, whose process had the same number.
    #[test]
    fn a_draft_that_is_left_does_not_hinder_another_run() {
        let folder = tempfile::tempdir().unwrap();
        let drafts = [1, 2].map(|_| Folder::draft(folder.path().join("run"), false).unwrap());
        assert_ne!(drafts[0].draft.path, drafts[1].draft.path);
        drop(drafts);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    /// Files come one after the other, until there is no folder for them.
    #[test]
    fn a_draft_goes_away_while_it_is_written() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("draft");
        fs::create_dir(&path).unwrap();
        (0..500).for_each(|k| fs::write(path.join(format!("{k}.dat")), "0\n").unwrap());
        let folder = path.clone();
        let writer = std::thread::spawn(move || {
            for k in 0.. {
                std::thread::sleep(Duration::from_micros(20));
                if fs::write(folder.join(format!("{k}.csv")), "t [s]\n").is_err() {
                    break;
                }
            }
        });
        while !path.join("0.csv").exists() {
            std::thread::yield_now();
        }
        Draft { path: path.clone(), made: vec![] }.discard();
        assert!(!path.exists());
        writer.join().unwrap();
    }
}
