//! The path of a model file.

use redysim_toml::{path_from, similar_file, why_missing};
use std::path::{Path, PathBuf};
use syn::LitStr;

/// Where the literal leads.
pub struct Located {
    /// The file.
    pub path: PathBuf,
    /// The path as it is written.
    written: String,
    /// The folder from which it is taken.
    from: PathBuf,
    /// Whether that is the folder of the calling file.
    is_beside_caller: bool,
}

impl Located {
    /// The file that the literal names: from the calling file for `./` and `../`, else from the package's manifest.
    pub fn new(literal: &LitStr) -> Located {
        let written = literal.value();
        let path = PathBuf::from(&written);
        let beside = if path.starts_with(".") || path.starts_with("..") { calling_folder(literal) } else { None };
        let is_beside_caller = beside.is_some();
        // Editors expand macros without knowing the file; the package is then the best guess.
        let from = canonical(beside.unwrap_or_else(package));
        Located { path: canonical(from.join(path)), written, from, is_beside_caller }
    }

    /// The error message for a missing file, with the folder that was searched and a file of similar name; `None` if the
    /// file exists.
    pub fn missing(&self) -> Option<String> {
        if self.path.exists() {
            return None;
        }
        let folder = self.path.parent().unwrap_or(&self.from);
        let (shown, from) = (canonical(folder.to_path_buf()), self.from.display());
        let why = why_missing(folder);
        let (base, otherwise) = if self.is_beside_caller {
            ("this Rust file", "one that does not begin with \"./\" or \"../\" is relative to that of Cargo.toml")
        } else {
            ("the crate's Cargo.toml", "one that begins with \"./\" or \"../\" is relative to that of the Rust file")
        };
        let here = std::env::current_dir().map(canonical).unwrap_or_default();
        let help = match similar_file(&self.path, &[&shown, &self.from, &canonical(package()), &here]) {
            Some(file) => format!("did you mean \"{}\"?", self.as_written(&canonical(file))),
            None => "no file of a similar name is near: put it there, or correct the path".to_string(),
        };
        Some(format!(
            "cannot read the model file `{}`: {why}\n = note: the path is relative to the folder of {base}, {from}; \
             {otherwise}\n = help: {help}",
            self.written
        ))
    }

    /// The path by which the literal would name `file`.
    fn as_written(&self, file: &Path) -> String {
        let path = path_from(&self.from, file);
        if self.is_beside_caller && !path.starts_with("..") { format!("./{path}") } else { path }
    }
}

/// The folder of the package's manifest.
fn package() -> PathBuf {
    std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default()
}

fn calling_folder(literal: &LitStr) -> Option<PathBuf> {
    let file = literal.span().unwrap().local_file()?;
    Some(std::env::current_dir().ok()?.join(file).parent()?.to_path_buf())
}

/// The path without `..` and links, or if it does not exist, without `.`.
fn canonical(path: PathBuf) -> PathBuf {
    std::fs::canonicalize(&path).unwrap_or_else(|_| path.components().collect())
}

/// The path as messages show it: from the folder in which the compiler runs, where it is inside.
pub fn shown(path: &Path) -> String {
    let here = std::env::current_dir().and_then(std::fs::canonicalize).unwrap_or_default();
    path.strip_prefix(here).unwrap_or(path).display().to_string()
}
