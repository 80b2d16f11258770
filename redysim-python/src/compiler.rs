//! The system's C compiler: what it is told to do, and why it fails.

use crate::load::fault;
use pyo3::PyErr;
use std::env;
use std::ffi::OsString;
use std::io;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// With products and sums fused where the processor can.
const FLAGS: &str = "-std=c99 -O3 -DREDYSIM_FMA -fno-math-errno";

/// The flag that enables all instructions of this processor.
const FOR_THIS_PROCESSOR: &str =
    if cfg!(any(target_arch = "x86", target_arch = "x86_64")) { "-march=native" } else { "-mcpu=native" };

/// What has GCC 12 or later keep the code for one state to vectors of 256 bits: one of 512 bits may slow down the numbers around
/// it by more than it saves. Lanes stay wide by a pragma in the source. Clang, which has no such pragma, keeps to 256 bits by
/// itself for processors of Intel, where it matters most.
const NARROW: &str = "-mprefer-vector-width=256 -mmove-max=256 -mstore-max=256";

/// What compilers, assemblers and linkers report of a file that they cannot write for want of room, in English.
const WITHOUT_ROOM: [&str; 4] =
    ["No space left on device", "quota exceeded", "File too large", "File size limit exceeded"];

/// A C compiler.
pub struct Compiler {
    name: OsString,
    /// Those of the environment variable CC.
    flags: Vec<OsString>,
    /// What it is, as it states it.
    version: Vec<u8>,
}

impl Compiler {
    /// The compiler of this name; by default that of the environment variable CC, or cc.
    ///
    /// # Errors
    /// If it cannot be run.
    pub fn new(name: Option<OsString>) -> Result<Compiler, PyErr> {
        let (name, flags) = name.map_or_else(redysim_cli::c_compiler, |name| (name, Vec::new()));
        let mut compiler = Compiler { name, flags, version: Vec::new() };
        compiler.version = compiler.run(compiler.command().arg("--version"))?.stdout;
        Ok(compiler)
    }

    fn command(&self) -> Command {
        let mut command = Command::new(&self.name);
        command.args(&self.flags);
        command
    }

    /// What its code depends on, beside the source and the processor.
    pub fn key(&self) -> Vec<u8> {
        let own = self.flags.iter().map(|flag| flag.as_encoded_bytes()).collect::<Vec<_>>().join(&b' ');
        [&self.version[..], &own, FLAGS.as_bytes(), FOR_THIS_PROCESSOR.as_bytes(), NARROW.as_bytes()].concat()
    }

    /// Compiles a source to a library, which is to be kept in `folder`.
    ///
    /// # Errors
    /// If it fails.
    pub fn compile(&self, source: &Path, library: &Path, folder: &Path) -> Result<(), PyErr> {
        let mut command = self.command();
        command.args(FLAGS.split(' ')).arg(FOR_THIS_PROCESSOR).args(self.narrow()?).args(["-fPIC", "-shared", "-o"]);
        let Output { status, stderr, .. } = self.run(command.arg(library).arg(source).arg("-lm"))?;
        if status.success() {
            return Ok(());
        }
        let stderr = String::from_utf8_lossy(&stderr);
        let line_with = |words: &[&str]| stderr.lines().find(|line| words.iter().any(|word| line.contains(word)));
        let of_room = line_with(&WITHOUT_ROOM);
        let line = of_room.or_else(|| line_with(&["error"])).or(stderr.lines().next()).unwrap_or_default();
        let message = format!("the C compiler `{}` fails ({status}): {line}", self.name.display());
        let help = match of_room {
            Some(_) => room(folder),
            None => "gcc 4.9 and clang 6 and later compile it; name one by compile(compiler=...)".to_owned(),
        };
        Err(fault(&message, &help))
    }

    /// [`NARROW`], if the compiler takes it and the processor has vectors of 512 bits.
    fn narrow(&self) -> Result<impl Iterator<Item = &'static str>, PyErr> {
        let flags = NARROW.split(' ');
        let trial = ["-fsyntax-only", "-x", "c", "-"];
        let is_narrowed =
            has_vectors_of_512_bits() && self.run(self.command().args(flags.clone()).args(trial))?.status.success();
        Ok(flags.take(if is_narrowed { usize::MAX } else { 0 }))
    }

    fn run(&self, command: &mut Command) -> Result<Output, PyErr> {
        command.env("LC_ALL", "C").stdin(Stdio::null()).output().map_err(|error| {
            let message = format!("the C compiler `{}` cannot be run: {error}", self.name.display());
            fault(&message, "install one, as by `apt install gcc`, or name another one by compile(compiler=...) or CC")
        })
    }
}

#[cfg(target_arch = "x86_64")]
fn has_vectors_of_512_bits() -> bool {
    std::is_x86_feature_detected!("avx512f")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_vectors_of_512_bits() -> bool {
    false
}

/// What there is to do where there is no room for compiled functions in `folder`.
fn room(folder: &Path) -> String {
    let temporary = env::temp_dir();
    format!(
        "make room for the library, in {}, and for the compiler's temporary files, in {}; the environment variables \
         REDYSIM_CACHE and TMPDIR name other folders",
        folder.display(),
        temporary.display()
    )
}

/// The error of a file for compiled functions that cannot be written.
pub fn unwritten(path: &Path, error: &io::Error) -> PyErr {
    use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
    let message = format!("compiled functions cannot be written to {}: {error}", path.display());
    let help = match error.kind() {
        StorageFull | QuotaExceeded | FileTooLarge => "make room there, or name another folder",
        _ => "name another folder",
    };
    fault(&message, &format!("{help} by the environment variable REDYSIM_CACHE"))
}
