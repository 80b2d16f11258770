//! The path of a model file.

use std::path::{Path, PathBuf};
use syn::LitStr;

/// The file that the literal names: from the calling file for `./` and `../`, else from the package's manifest.
pub fn model_file(literal: &LitStr) -> PathBuf {
    let path = PathBuf::from(literal.value());
    let package = || std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let folder = if path.starts_with(".") || path.starts_with("..") { calling_folder(literal) } else { None };
    // Editors expand macros without knowing the file; the package is then the best guess.
    let joined = folder.unwrap_or_else(package).join(path);
    std::fs::canonicalize(&joined).unwrap_or(joined)
}

fn calling_folder(literal: &LitStr) -> Option<PathBuf> {
    let file = literal.span().unwrap().local_file()?;
    Some(std::env::current_dir().ok()?.join(file).parent()?.to_path_buf())
}

/// The path as messages show it: from the folder in which the compiler runs, where it is inside.
pub fn shown(path: &Path) -> String {
    let here = std::env::current_dir().and_then(std::fs::canonicalize).unwrap_or_default();
    path.strip_prefix(here).unwrap_or(path).display().to_string()
}
