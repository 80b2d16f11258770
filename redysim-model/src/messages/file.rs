//! Messages about model files that cannot be read.

use super::message;
use redysim_toml::{Message, similar_file};
use std::path::Path;

pub(crate) fn unreadable(path: &Path, error: &std::io::Error) -> Message {
    let help = match error.kind() {
        std::io::ErrorKind::PermissionDenied => "its permissions forbid it".to_string(),
        std::io::ErrorKind::NotFound => {
            let folder = path.parent().unwrap_or(path);
            let similar = similar_file(path, &[folder, Path::new("")]);
            let similar = similar.map(|file| format!("did you mean `{}`? ", file.display())).unwrap_or_default();
            let current = std::env::current_dir().map(|current| format!(", {}", current.display())).unwrap_or_default();
            format!("{similar}A path is taken from the current folder{current}")
        }
        _ => "the path must name a TOML file in UTF-8".to_string(),
    };
    message(format!("cannot read the model file: {error}"), "", help)
}

pub(crate) fn is_directory() -> Message {
    message("cannot read the model file: it is a directory".into(), "", "name a file in it")
}

pub(crate) fn not_utf8(byte: usize) -> Message {
    message(
        format!("the model file is not UTF-8 (byte {byte})"),
        "",
        "save the file as UTF-8; TOML allows no other encoding",
    )
}
