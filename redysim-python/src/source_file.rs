//! The file of a model, watched: compiled functions are those of the file as it was.

use crate::load::fault;
use pyo3::PyErr;
use redysim_cli::{Failure, ModelFile};
use std::fs;
use std::path::{self, Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// How many ticks a look at the file counts: some 0.1 ms. A look takes about 1 µs, more than a call of a compiled function of
/// one state.
const PATIENCE: u64 = 1 << 18;

/// A clock that takes a few nanoseconds: the processor's cycles, in a third of the time that the system's clock takes.
#[cfg(target_arch = "x86_64")]
fn ticks() -> u64 {
    // SAFETY: every x86-64 has the instruction.
    unsafe { core::arch::x86_64::_rdtsc() }
}

/// A clock, of 0.4 ns.
#[cfg(not(target_arch = "x86_64"))]
fn ticks() -> u64 {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed().as_nanos() as u64 * 5 / 2 + PATIENCE
}

/// The file of which a mechanism was made, with what was in it.
pub struct SourceFile {
    /// As it was given.
    pub path: PathBuf,
    /// From the root, wherever the program goes.
    absolute: PathBuf,
    /// What was in it.
    pub bytes: Vec<u8>,
    /// Whether the root link of a URDF is on a free joint.
    pub floating: bool,
    /// The names of the run-time parameters, if they are other ones than the file's.
    pub parameters: Option<Vec<String>>,
    /// What the file system showed when its contents were last found to be the same.
    seen: Mutex<Option<Stamp>>,
    /// When it was last looked at, in ticks.
    looked: AtomicU64,
    /// Whether it has other contents, as far as is known.
    changed: AtomicBool,
}

/// What differs after a file was written or replaced: when, and how long it is.
type Stamp = (Option<SystemTime>, u64);

impl SourceFile {
    pub fn new(path: PathBuf, bytes: Vec<u8>, floating: bool, parameters: Option<Vec<String>>) -> SourceFile {
        SourceFile {
            absolute: path::absolute(&path).unwrap_or_else(|_| path.clone()),
            path,
            bytes,
            floating,
            parameters,
            seen: Mutex::new(None),
            looked: AtomicU64::new(0),
            changed: AtomicBool::new(false),
        }
    }

    /// The model that was in it.
    ///
    /// # Errors
    /// Every fault of the file, and every name that is not that of a parameter.
    pub fn model(&self) -> Result<ModelFile, Failure> {
        let file = ModelFile::from_bytes(self.bytes.clone(), &self.path, self.floating)?;
        match &self.parameters {
            Some(names) => file.with_run_time_parameters(names),
            None => Ok(file),
        }
    }

    /// # Errors
    /// If the file has other contents now, or is not there.
    pub fn check_unchanged(&self) -> Result<(), PyErr> {
        match fs::read(&self.absolute) {
            Ok(bytes) if bytes == self.bytes => Ok(()),
            Ok(_) => Err(self.changed("has changed since it was loaded")),
            Err(error) => Err(self.changed(&format!("cannot be read any more: {error}"))),
        }
    }

    /// The same for each call of a compiled function: quick, and content with a file that is not there, which no other
    /// model has replaced.
    ///
    /// # Errors
    /// If the file has other contents now, or had them less than [`PATIENCE`] ago.
    pub fn watch(&self) -> Result<(), PyErr> {
        let now = ticks();
        let is_fresh = now.wrapping_sub(self.looked.load(Ordering::Relaxed)) < PATIENCE;
        if is_fresh && !self.changed.load(Ordering::Relaxed) { Ok(()) } else { self.look(now) }
    }

    #[cold]
    fn look(&self, now: u64) -> Result<(), PyErr> {
        self.looked.store(now, Ordering::Relaxed);
        let stamp = stamp(&self.absolute);
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        if stamp.is_none() || stamp == *seen {
            return Ok(());
        }
        // Written, perhaps with the same contents, or looked at for the first time.
        let is_same = fs::read(&self.absolute).map_or(true, |bytes| bytes == self.bytes);
        self.changed.store(!is_same, Ordering::Relaxed);
        if is_same {
            *seen = stamp;
            return Ok(());
        }
        Err(self.changed("has changed since its functions were compiled"))
    }

    fn changed(&self, what: &str) -> PyErr {
        let help = format!("load it again: robot = redysim.load({:?})", self.path);
        fault(&format!("{} {what}", self.path.display()), &help)
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let found = fs::metadata(path).ok()?;
    Some((found.modified().ok(), found.len()))
}
