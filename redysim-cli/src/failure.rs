//! Why a command ends without doing what it was asked for.

use std::fmt;
use std::io;
use std::path::Path;
use std::process::ExitCode;

use redysim_toml::{similar_file, why_missing};

/// One clear message, what to do about it, and the exit code that scripts see. Its `Display` is what the command prints.
#[derive(Clone, Debug)]
pub struct Failure {
    kind: Kind,
    message: String,
    help: Option<String>,
    /// The parts of the message that have a place.
    faults: Vec<Fault>,
}

/// A fault at a place in a file; lines and columns count from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    pub line: u32,
    pub column: Option<u32>,
    pub title: String,
    /// What to do; may be empty.
    pub help: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A file that was given is at fault.
    Input,
    /// An argument or option is.
    CommandLine,
    /// The world outside is.
    Outside,
    /// Ctrl-C.
    Interrupted,
}

impl Failure {
    /// The exit code of what Ctrl-C has ended.
    pub(crate) const INTERRUPTED: u8 = 130;

    fn new(kind: Kind, message: impl fmt::Display) -> Self {
        Self { kind, message: message.to_string(), help: None, faults: Vec::new() }
    }

    /// The faults of `file`, and the lines `more` about those that are not shown.
    pub(crate) fn faults_of(file: &str, faults: Vec<Fault>, more: &[String]) -> Self {
        let shown = faults.iter().map(|Fault { line, column, title, help }| {
            let column = column.map_or(String::new(), |column| format!(":{column}"));
            let help = if help.is_empty() { String::new() } else { format!("\n  = help: {help}") };
            format!("{file}:{line}{column}: {title}{help}")
        });
        let mut message = shown.collect::<Vec<_>>().join("\nerror: ");
        more.iter().for_each(|line| message += &format!("\n{line}"));
        Self { faults, ..Self::input(message) }
    }

    /// The faults of a file, each with its own help or else with that of the failure; empty if no place is known.
    pub(crate) fn faults(&self) -> impl Iterator<Item = (&Fault, &str)> {
        self.faults.iter().map(|fault| (fault, if fault.help.is_empty() { self.advice() } else { &fault.help }))
    }

    /// A model, scenario or table is at fault.
    pub(crate) fn input(message: impl fmt::Display) -> Self {
        Self::new(Kind::Input, message)
    }

    /// An argument or option of the command line is at fault.
    pub(crate) fn command_line(message: impl fmt::Display) -> Self {
        Self::new(Kind::CommandLine, message)
    }

    /// Something outside the program is at fault.
    pub(crate) fn outside(message: impl fmt::Display) -> Self {
        Self::new(Kind::Outside, message)
    }

    /// Somebody pressed Ctrl-C.
    pub(crate) fn interrupted(message: impl fmt::Display) -> Self {
        Self::new(Kind::Interrupted, message)
    }

    /// A file or folder could not be read or written (`doing`: "read", "write", "make the folder").
    pub(crate) fn file(doing: &str, path: &Path, error: &io::Error) -> Self {
        let error_text = error.to_string();
        let why = error_text.split(" (os error").next().unwrap_or_default();
        let failure = |why: &str| Self::outside(format!("cannot {doing} {}: {why}", path.display()));
        let folder = path.parent().unwrap_or(path);
        if error.kind() == io::ErrorKind::NotFound && doing == "read" {
            let similar = similar_file(path, &[folder, Path::new("")]);
            let similar = similar.map(|file| format!("did you mean `{}`?", file.display()));
            let failure = failure(&why_missing(folder));
            let asked = similar.unwrap_or_else(|| IS_IT_RIGHT.into());
            return failure.help(asked + &taken_from(path));
        }
        let failure = failure(why);
        match error.kind() {
            io::ErrorKind::NotFound => failure.help(IS_IT_RIGHT.to_owned() + &taken_from(path)),
            io::ErrorKind::PermissionDenied => failure.help("its permissions forbid it"),
            io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
                failure.help("make room on the disk, or write elsewhere with --output")
            }
            io::ErrorKind::IsADirectory => failure.help("it is a folder: name a file"),
            io::ErrorKind::AlreadyExists | io::ErrorKind::NotADirectory => {
                failure.help("a part of the path is a file: name a folder")
            }
            _ => failure,
        }
    }

    /// Whether Ctrl-C is the reason.
    pub(crate) fn is_interruption(&self) -> bool {
        self.kind == Kind::Interrupted
    }

    /// What is wrong, without what to do.
    pub fn message(&self) -> &str {
        self.message.trim_end()
    }

    /// Prefixes the file that is at fault, unless the message begins with its own severity: that one has places.
    pub(crate) fn in_file(mut self, file: &str) -> Self {
        if !self.has_severity() {
            self.message = format!("{file}: {}", self.message);
        }
        self
    }

    /// Whether the message begins with its own severity, as the faults of a text do: a warning where one stands first in the
    /// file.
    fn has_severity(&self) -> bool {
        let mut own = ["error", "warning"].iter().filter_map(|severity| self.message.strip_prefix(severity));
        own.any(|rest| rest.starts_with([':', '[']))
    }

    /// Appends `more` to the message.
    pub(crate) fn and(mut self, more: &str) -> Self {
        self.message += more;
        self
    }

    /// Adds what to do.
    pub(crate) fn help(mut self, help: impl fmt::Display) -> Self {
        self.help = Some(help.to_string());
        self
    }

    /// The first line of what is wrong.
    pub(crate) fn title(&self) -> &str {
        self.message().lines().next().unwrap_or_default()
    }

    /// What to do about it, if anything is known.
    pub fn advice(&self) -> &str {
        self.help.as_deref().unwrap_or_default()
    }

    /// The same as a warning, where the command goes on without what failed.
    pub(crate) fn warning(&self) -> String {
        self.to_string().replacen("error: ", "warning: ", 1)
    }

    /// 1 for input, 2 for the command line, 3 for what is outside, 130 for Ctrl-C.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self.kind {
            Kind::Input => 1,
            Kind::CommandLine => 2,
            Kind::Outside => 3,
            Kind::Interrupted => Self::INTERRUPTED,
        })
    }
}

/// The help for a missing path without a similar file.
const IS_IT_RIGHT: &str = "is the path right?";

/// The folder from which a path is taken, if it is relative, as a sentence that follows another.
fn taken_from(path: &Path) -> String {
    if path.is_absolute() {
        return String::new();
    }
    let folder = std::env::current_dir().map_or(String::new(), |folder| format!(", {}", folder.display()));
    format!(" A path is taken from the current folder{folder}")
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.kind == Kind::Interrupted { "interrupted: " } else { "error: " };
        write!(f, "{}{}", if self.has_severity() { "" } else { what }, self.message.trim_end())?;
        match &self.help {
            Some(help) => write!(f, "\n  = help: {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Failure {}
