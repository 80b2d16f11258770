//! Files that a scenario names, in memory instead of its folder.

use std::collections::BTreeMap;
use std::path::Path;

use redysim_toml::words::quoted;

use super::table::InputTable;
use crate::failure::Failure;

/// The texts of the files that a scenario names.
#[derive(Clone, Copy)]
pub struct Held<'h> {
    /// The model file.
    pub model: &'h str,
    /// What messages call it.
    pub model_name: &'h str,
    /// The tables, by their paths as the scenario writes them.
    pub tables: &'h BTreeMap<String, String>,
}

impl Held<'_> {
    /// The table at `path`.
    ///
    /// # Errors
    /// If it is not among them, or as [`InputTable::read`].
    pub fn table(&self, path: &str) -> Result<InputTable, Failure> {
        let text = self
            .tables
            .get(path)
            .ok_or_else(|| Failure::input(format!("the study does not hold the table {}", quoted(path))))?;
        InputTable::of_text(text.clone(), Path::new(path))
    }
}
