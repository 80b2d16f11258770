//! The names of links, loops, frames and springs in messages.

use super::keys::NAME;
use redysim_toml::words::quoted;
use redysim_toml::{DeValue, Spanned, TableAt};

/// "link `arm`", or "link #3" for a table without a readable name.
pub(super) fn item(what: &str, at: &TableAt<'_>, number: usize) -> String {
    match at.table.get(NAME.name).map(Spanned::get_ref) {
        Some(DeValue::String(name)) if !name.trim().is_empty() => format!("{what} {}", quoted(name)),
        _ => format!("{what} #{number}"),
    }
}
