//! Why a file is not a model.

use crate::public_interface::PublicInterface;
use redysim_toml::{Diagnostic, Diagnostics};
use std::fmt;

/// Why a file is not a model: every error in it, and the warnings beside them, in the file's order.
#[derive(Clone, Debug)]
pub struct Faults {
    /// Errors (at least one) and warnings.
    pub diagnostics: Diagnostics,
    /// The interface as far as it can be read: enough for a stub with which the code around the model compiles.
    pub interface: Box<PublicInterface>,
    /// Whether nothing was read, because the file does not exist or cannot be read.
    pub unread: bool,
}

impl Faults {
    /// The errors alone.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.diagnostics.errors()
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.diagnostics.fmt(f)
    }
}

impl std::error::Error for Faults {}
