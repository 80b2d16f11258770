//! Files that are there whole or not at all, and what is printed.

use std::borrow::Cow;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use crate::failure::Failure;
use tempfile::NamedTempFile;

/// Writes `contents` to `path`: first beside it under another name, so that an interruption or a full disk leaves
/// nothing half-written. An existing file is kept unless `force` is given. Links are followed; a device or a pipe is
/// written directly.
///
/// # Errors
/// If the file is there and `force` is not given, or if it cannot be written.
pub fn write_file(path: &Path, contents: &[u8], force: bool) -> Result<(), Failure> {
    Draft::new(path, contents, force)?.publish()
}

/// Writes files that belong together to `folder`, which is made if it is not there. All files are first written in full under
/// temporary names, so that a full disk leaves none of them; then they are renamed one after the other.
///
/// # Errors
/// As [`write_file`].
pub fn write_together(folder: &Path, files: &[(PathBuf, &[u8])], force: bool) -> Result<(), Failure> {
    let missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    let made: Vec<&Path> = folder.ancestors().take_while(missing).collect();
    let drafts = make_folder(folder).and_then(|()| {
        let drafts = files.iter().map(|(path, contents)| Draft::new(path, contents, force));
        drafts.collect::<Result<Vec<Draft>, Failure>>()
    });
    if drafts.is_err() {
        // The first error is reported, also if a folder cannot be deleted.
        made.into_iter().for_each(|folder| drop(fs::remove_dir(folder)));
    }
    drafts?.into_iter().try_for_each(Draft::publish)
}

/// Writes what was made of the file `source`, as [`write_file`] does.
///
/// # Errors
/// As [`write_file`]; and if it would take the place of the source.
pub fn write_beside(source: &Path, path: &Path, contents: &[u8], force: bool) -> Result<(), Failure> {
    check_beside(source, path, force)?;
    write_file(path, contents, force)
}

/// Fails if [`write_beside`] would, as far as that is known before there is something to write.
///
/// # Errors
/// As [`check_place`]; and if it would take the place of the source.
pub fn check_beside(source: &Path, path: &Path, force: bool) -> Result<(), Failure> {
    if fs::canonicalize(path).is_ok_and(|path| fs::canonicalize(source).is_ok_and(|source| source == path)) {
        let message = format!("{} is what it would be made of", path.display());
        return Err(Failure::command_line(message).help("write elsewhere with --output"));
    }
    check_place(path, force)
}

/// Makes a folder and those around it, unless they are there.
///
/// # Errors
/// If they cannot be made.
pub fn make_folder(path: &Path) -> Result<(), Failure> {
    fs::create_dir_all(path).map_err(|error| Failure::file("make the folder", path, &error))
}

/// Fails if [`write_file`] would, as far as that is known before there is something to write.
///
/// # Errors
/// If the file is there and `force` is not given, or its path cannot be resolved.
pub fn check_place(path: &Path, force: bool) -> Result<(), Failure> {
    place(path, force).map(drop)
}

/// Prints what was asked for. A reader that has seen enough, as `head` does, is not a failure. A terminal obeys control
/// characters: there they are shown, while a file or another program gets the text as it is.
///
/// # Errors
/// If the output cannot be written.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    let text = if out.is_terminal() { visible(text) } else { Cow::Borrowed(text) };
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::outside(format!("cannot write the output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a line beside what was asked for on the standard output. A failure to print is ignored.
pub fn to_stdout(text: &str) {
    let _ = print(&format!("{}\n", visible(text)));
}

/// Prints a line on the standard error: a warning, or why something failed. A failure to print is ignored.
pub fn to_stderr(text: &str) {
    let _ = io::stderr().write_all(format!("{}\n", visible(text)).as_bytes());
}

/// A text of several lines for people: control characters, which names in a file may have and a terminal obeys, are
/// shown as `\u{1b}`.
pub fn visible(text: &str) -> Cow<'_, str> {
    shown(text, |c| c.is_control() && c != '\n' && c != '\t')
}

/// A name on one line for people, in which ends of lines are shown, too.
pub fn visible_name(name: &str) -> Cow<'_, str> {
    shown(name, char::is_control)
}

fn shown(text: &str, hides: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&hides) {
        return text.into();
    }
    text.chars().map(|c| if hides(c) { c.escape_debug().to_string() } else { c.into() }).collect()
}

/// What is there already, and must not be lost.
pub fn exists(path: &Path) -> Failure {
    Failure::outside(format!("{} is there already", path.display()))
        .help("write elsewhere with --output, or overwrite it with --force")
}

/// Where a path leads.
enum Place {
    /// To a device or a pipe.
    Open,
    /// To a file, whether it is there or not.
    File(PathBuf),
}

/// Names of what this program has open itself, be it a file.
const OPEN: [&str; 4] = ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc/self/fd"];

/// As many links as Linux follows.
const LINKS: usize = 40;

fn place(path: &Path, force: bool) -> Result<Place, Failure> {
    match fs::metadata(path) {
        Ok(_) if OPEN.iter().any(|open| path.starts_with(open)) => return Ok(Place::Open),
        Ok(found) if !found.is_file() && !found.is_dir() => return Ok(Place::Open),
        Ok(_) if !force => return Err(exists(path)),
        Ok(found) if found.is_dir() => {
            let message = format!("cannot write {}: it is a folder", path.display());
            return Err(Failure::outside(message).help("write elsewhere with --output"));
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(Failure::file("write", path, &error)),
        _ => {}
    }
    // A link may lead to a file that is yet to be made, which `canonicalize` does not know.
    let next = |link: &PathBuf| fs::read_link(link).ok().map(|to| link.with_file_name("").join(to));
    let target = std::iter::successors(Some(path.to_owned()), next).take(LINKS).last();
    Ok(Place::File(target.unwrap_or_else(|| path.to_owned())))
}

fn write_into(path: &Path, contents: &[u8]) -> io::Result<()> {
    match fs::OpenOptions::new().append(true).open(path)?.write_all(contents) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        written => written,
    }
}

/// A file to be written. A regular file is written in full under a temporary name, and deleted unless it is published.
struct Draft<'a> {
    path: &'a Path,
    /// Whether a file that is there is overwritten.
    force: bool,
    state: State<'a>,
}

enum State<'a> {
    /// The contents for a device or pipe.
    Waiting(&'a [u8]),
    /// The temporary file, and the path that it is renamed to.
    Written(NamedTempFile, PathBuf),
}

impl<'a> Draft<'a> {
    fn new(path: &'a Path, contents: &'a [u8], force: bool) -> Result<Draft<'a>, Failure> {
        let state = match place(path, force)? {
            Place::Open => State::Waiting(contents),
            Place::File(target) => {
                let file = beside(&target, contents).map_err(|error| Failure::file("write", path, &error))?;
                State::Written(file, target)
            }
        };
        Ok(Draft { path, force, state })
    }

    /// Renames the temporary file, or writes to the device.
    fn publish(self) -> Result<(), Failure> {
        let published = match self.state {
            State::Waiting(contents) => write_into(self.path, contents),
            State::Written(file, target) if self.force => file.persist(target).map(drop).map_err(io::Error::from),
            // It may have appeared meanwhile.
            State::Written(file, target) => match file.persist_noclobber(target) {
                Err(failed) if failed.error.kind() == io::ErrorKind::AlreadyExists => return Err(exists(self.path)),
                other => other.map(drop).map_err(io::Error::from),
            },
        };
        published.map_err(|error| Failure::file("write", self.path, &error))
    }
}

/// A file beside another one, with its permissions.
fn beside(target: &Path, contents: &[u8]) -> io::Result<NamedTempFile> {
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = drafts().tempfile_in(folder)?;
    if let Ok(before) = fs::metadata(target) {
        file.as_file().set_permissions(before.permissions())?;
    }
    file.write_all(contents)?;
    file.as_file().sync_all()?;
    Ok(file)
}

/// Drafts with the permissions of any new file.
#[cfg(unix)]
fn drafts() -> tempfile::Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;
    let mut drafts = tempfile::Builder::new();
    drafts.suffix(".draft").permissions(fs::Permissions::from_mode(0o666));
    drafts
}

#[cfg(not(unix))]
fn drafts() -> tempfile::Builder<'static, 'static> {
    let mut drafts = tempfile::Builder::new();
    drafts.suffix(".draft");
    drafts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn control_characters_are_shown_and_other_characters_stay() {
        assert_eq!(visible("\u{1b}[2J a\tb\r\n"), "\\u{1b}[2J a\tb\\r\n");
        assert_eq!(visible("\u{9b}1m\u{7f}"), "\\u{9b}1m\\u{7f}");
        assert_eq!(visible_name("a\nb\tc"), "a\\nb\\tc");
        for text in ["Σ ω̇ “ä” '\"\\", ""] {
            assert!(matches!(visible(text), Cow::Borrowed(same) if same == text));
        }
    }
}
