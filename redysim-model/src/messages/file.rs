//! Messages about model files that cannot be read.

use super::message;
use redysim_toml::Message;

pub(crate) fn unreadable(error: &std::io::Error) -> Message {
    let help = match error.kind() {
        std::io::ErrorKind::PermissionDenied => "its permissions forbid it",
        _ => "the path must name a TOML file in UTF-8",
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
