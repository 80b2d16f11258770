//! Ctrl-C, or a request to terminate, ends a computation, not the program: what was computed is kept. The second one
//! ends the program.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::failure::Failure;
use crate::output::to_stderr;

static ASKED: AtomicBool = AtomicBool::new(false);

type Undo = Box<dyn FnOnce() + Send>;
/// What is done before the program ends at once.
static UNDO: Mutex<Option<Undo>> = Mutex::new(None);

/// From now on, the first Ctrl-C is only taken note of.
pub fn watch() -> Result<(), Failure> {
    let note = || {
        if ASKED.swap(true, Ordering::Relaxed) {
            end();
        }
    };
    ctrlc::set_handler(note).map_err(|error| Failure::outside(format!("cannot watch for Ctrl-C: {error}")))
}

/// Ends the computation that is under way, as the first Ctrl-C does.
pub fn ask() {
    ASKED.store(true, Ordering::Relaxed);
}

/// Begins a computation, whatever has ended those before.
pub fn begin() {
    ASKED.store(false, Ordering::Relaxed);
}

/// Whether it was pressed.
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Has `undo` done before the program ends at once.
pub fn before_end(undo: impl FnOnce() + Send + 'static) {
    *lock() = Some(Box::new(undo));
}

/// Does what must not be done by halves: the program does not end meanwhile, and has nothing to undo any more.
pub fn undisturbed<T>(work: impl FnOnce() -> T) -> T {
    let mut undo = lock();
    *undo = None;
    work()
}

fn end() {
    // The lock is held until the process exits: the run then cannot report that files which `undo` deletes are missing.
    let mut undo = lock();
    // Without anything to undo nothing was begun, or what was is whole, and reported.
    if let Some(undo) = undo.take() {
        undo();
        to_stderr(&Failure::interrupted("nothing is kept").to_string());
    }
    std::process::exit(Failure::INTERRUPTED.into());
}

fn lock() -> MutexGuard<'static, Option<Undo>> {
    UNDO.lock().unwrap_or_else(PoisonError::into_inner)
}
