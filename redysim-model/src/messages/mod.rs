//! The messages about model files, beside those about any file that `redysim-toml` has. One function is one message.
//!
//! Form: the title names the item, the rule and the value found; the label repeats the rule in a few words beside the
//! caret; the help has the remedy. `item` is "link `arm`", "loop `crank`" or "model `kr5`".

mod file;
mod lints;
mod mechanism;
mod mimic;
mod options;

pub(crate) use file::*;
pub(crate) use lints::*;
pub(crate) use mechanism::*;
pub(crate) use mimic::*;
pub(crate) use options::*;

use redysim_toml::Message;
use redysim_toml::words::quoted;

fn message(title: String, label: impl Into<String>, help: impl Into<String>) -> Message {
    Message::new(title, label, help)
}

/// The message with the joints that the options lock, where that may be why.
pub(crate) fn with_locks(mut message: Message, locks: &[&str]) -> Message {
    if !locks.is_empty() {
        let names: Vec<_> = locks.iter().map(|name| quoted(name)).collect();
        message.help += &format!("; with {} locked", names.join(", "));
    }
    message
}
