//! Files that are there whole or not at all, and what is printed.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Writes `contents` to `path`: first beside it under another name, so that an interruption or a full disk leaves nothing
/// half-written. A file that is there already stays, unless `force`.
///
/// # Errors
/// If the file is there and `force` is not given, or if it cannot be written.
pub fn write_file(path: &Path, contents: &[u8], force: bool) -> Result<(), Failure> {
    if path.exists() && !force {
        return Err(exists(path));
    }
    let draft = draft_of(path);
    let written = write_all(&draft, contents).and_then(|()| fs::rename(&draft, path));
    written.map_err(|error| {
        // What is left of the draft is of no use to anybody, and if even this fails there is no more to do.
        let _ = fs::remove_file(&draft);
        Failure::file("write", path, &error)
    })
}

/// Prints what was asked for. A reader that has seen enough, as `head` does, is no failure.
///
/// # Errors
/// If the output cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::outside(format!("cannot write the output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Says something beside what was asked for: that it cannot be said is no reason to end.
pub fn say(text: &str) {
    let _ = print(&format!("{text}\n"));
}

/// What is there already, and must not be lost.
pub fn exists(path: &Path) -> Failure {
    Failure::outside(format!("{} is there already", path.display()))
        .help("write elsewhere with --output, or overwrite it with --force")
}

/// The name under which a file is written before it is whole.
fn draft_of(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.draft", std::process::id()));
    path.with_file_name(name)
}

fn write_all(path: &Path, contents: &[u8]) -> io::Result<()> {
    let mut file = fs::File::create(path)?;
    file.write_all(contents)?;
    file.sync_all()
}
