//! The file that a path was probably meant to name.

use crate::words::nearest;
use std::path::{Component, Path, PathBuf};

/// How many folders below one are searched.
const DEPTH: usize = 2;

/// How many entries are looked at, so that a path into a large folder is reported at once.
const MOST: usize = 2000;

/// The file that the missing file `wanted` was probably meant to be: one of the same name in one of `folders` or the folder above
/// it; otherwise the TOML file in or below `folders` whose name is the nearest, or the URDF or CSV file if `wanted` is one; of the
/// same names the first found, in the order of `folders`. Hidden folders, Cargo's `target` and links are not searched.
pub fn similar_file(wanted: &Path, folders: &[&Path]) -> Option<PathBuf> {
    let stem = |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().to_lowercase());
    let own = wanted.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default();
    let extension = ["urdf", "csv"].into_iter().find(|known| *known == own).unwrap_or("toml");
    let above = |folder: &Path| match folder.file_name() {
        Some(_) => folder.parent().unwrap_or(folder).to_path_buf(),
        None => folder.join(".."),
    };
    let name = wanted.file_name()?;
    let beside = |folder: &&Path| [folder.join(name), above(folder).join(name)];
    if let Some(found) = folders.iter().flat_map(beside).find(|path| path.is_file() && !is_manifest(path)) {
        return Some(found);
    }
    let (mut files, mut left) = (Vec::new(), MOST);
    for folder in folders {
        collect(folder, extension, DEPTH, &mut left, &mut files);
    }
    let stems: Vec<String> = files.iter().map(|file| stem(file).unwrap_or_default()).collect();
    let near = nearest(&stem(wanted)?, stems.iter().map(String::as_str))?;
    files.into_iter().zip(&stems).find(|(_, stem)| *stem == near).map(|(file, _)| file)
}

/// Why a file in `folder` cannot be read that is missing, as a part of a sentence.
pub fn why_missing(folder: &Path) -> String {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let shown = std::fs::canonicalize(here).unwrap_or_else(|_| here.components().collect());
    match shown.is_dir() {
        true => format!("it does not exist in {}", shown.display()),
        false => format!("the folder {} does not exist", shown.display()),
    }
}

/// The path that leads from the folder `from` to `file`, with `..` where it has to; both are absolute.
///
/// ```
/// use redysim_toml::path_from;
/// use std::path::Path;
///
/// assert_eq!(path_from(Path::new("/robots/scenarios"), Path::new("/robots/kr5.toml")), "../kr5.toml");
/// ```
pub fn path_from(from: &Path, file: &Path) -> String {
    let (from, to): (Vec<_>, Vec<_>) = (from.components().collect(), file.components().collect());
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n(Component::ParentDir, from.len() - common);
    let path: Vec<_> = up.chain(to[common..].iter().copied()).map(|part| part.as_os_str().to_string_lossy()).collect();
    path.join("/")
}

/// The files with the extension in `folder`, then those in the folders in it, by name.
fn collect(folder: &Path, extension: &str, depth: usize, left: &mut usize, files: &mut Vec<PathBuf>) {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let Ok(entries) = std::fs::read_dir(here) else { return };
    let mut entries: Vec<_> = entries.flatten().take(*left).collect();
    *left -= entries.len();
    entries.sort_by_key(std::fs::DirEntry::file_name);
    let mut folders = Vec::new();
    for entry in entries {
        let (name, path) = (entry.file_name(), folder.join(entry.file_name()));
        let Ok(kind) = entry.file_type() else { continue };
        let is_wanted = path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension));
        if kind.is_dir() && depth > 0 && name != "target" && !name.to_string_lossy().starts_with('.') {
            folders.push(path);
        } else if kind.is_file() && is_wanted && !is_manifest(&path) {
            files.push(path);
        }
    }
    folders.iter().for_each(|folder| collect(folder, extension, depth - 1, left, files));
}

/// Whether a file is Cargo's, which is never meant.
fn is_manifest(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name == "Cargo.toml")
}

#[cfg(test)]
mod tests {
    use super::similar_file;
    use std::path::{Path, PathBuf};

    fn repository() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
    }

    #[test]
    fn the_nearest_name_in_the_folder_is_similar() {
        let models = repository().join("models");
        for wanted in ["kr6.toml", "KR5.toml", "kr5", "kr5.tml"] {
            assert_eq!(similar_file(&models.join(wanted), &[&models]), Some(models.join("kr5.toml")), "{wanted}");
        }
        assert_eq!(similar_file(&models.join("centipede.toml"), &[&models]), None);
    }

    #[test]
    fn files_in_other_folders_are_similar_too() {
        let root = repository();
        assert_eq!(
            similar_file(Path::new("../kr5.toml"), &[&root, &root.join("models")]),
            Some(root.join("models/kr5.toml"))
        );
        assert_eq!(similar_file(Path::new("gripper.toml"), &[&root]), Some(root.join("models/gripper.toml")));
        assert_eq!(similar_file(&root.join("modles/kr5.toml"), &[&root.join("modles")]), None);
        assert_eq!(similar_file(&root.join("Cargo.toml"), &[&root.join("redysim-toml")]), None);
    }
}
