//! Ctrl-C, or a request to terminate, ends a computation, not the program: what was computed is kept.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::failure::Failure;

static ASKED: AtomicBool = AtomicBool::new(false);

/// From now on, Ctrl-C is only taken note of.
pub fn watch() -> Result<(), Failure> {
    let note = || ASKED.store(true, Ordering::Relaxed);
    ctrlc::set_handler(note).map_err(|error| Failure::outside(format!("cannot watch for Ctrl-C: {error}")))
}

/// Whether it was pressed.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
