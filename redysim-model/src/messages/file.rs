//! Messages about model files that cannot be read.

use super::message;
use redysim_toml::{Message, not_utf8_because, similar_file, why_missing};
use std::path::Path;

pub(crate) fn unreadable(path: &Path, error: &std::io::Error) -> Message {
    let folder = path.parent().unwrap_or(path);
    let (why, help) = match error.kind() {
        std::io::ErrorKind::PermissionDenied => (without_code(error), "its permissions forbid it".to_string()),
        std::io::ErrorKind::NotFound => {
            let similar = similar_file(path, &[folder, Path::new("")]);
            let similar = similar.map(|file| format!("did you mean `{}`? ", file.display())).unwrap_or_default();
            let current = std::env::current_dir().map(|current| format!(", {}", current.display())).unwrap_or_default();
            (why_missing(folder), format!("{similar}A path is taken from the current folder{current}"))
        }
        _ => (without_code(error), "the path must name a TOML file in UTF-8".to_string()),
    };
    message(format!("cannot read the model file: {why}"), "", help)
}

/// What went wrong, without the number that the operating system has for it.
fn without_code(error: &std::io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error").next().unwrap_or_default().to_string()
}

pub(crate) fn is_directory() -> Message {
    message("cannot read the model file: it is a directory".into(), "", "name a file in it")
}

pub(crate) fn not_utf8(bytes: &[u8]) -> Message {
    message(
        format!("the model file {}", not_utf8_because(bytes)),
        "",
        "save the file as UTF-8; TOML allows no other encoding",
    )
}
