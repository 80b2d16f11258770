//! Functions as C, compiled by the system's compiler, kept in a folder for the next time.

use crate::compiler::{Compiler, unwritten};
use crate::load::fault;
use libloading::Library;
use pyo3::PyErr;
use redysim_codegen::{CLibrary, c_library};
use redysim_model::{CodegenOptions, Function, Functions, Model, RunTimeParameter};
use std::env;
use std::error::Error;
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// All names in the C code begin with it.
const PREFIX: &str = "mechanism";

/// A function of several states: how many there are, where each argument begins, how many numbers it is to the next
/// state, and where the results go.
/// With run-time parameters there is one more argument: what is given in place of them.
pub type Entry = unsafe extern "C" fn(usize, *const *const f64, *const usize, *mut f64);

/// The functions of a library.
pub struct Compiled {
    /// Makes the given numbers of one robot, of which there are so many, of its parameters.
    init: Option<(unsafe extern "C" fn(*const f64, *mut f64), usize)>,
    entries: [Option<Entry>; Function::ALL.len()],
    /// Those that were to be compiled.
    pub functions: Functions,
    /// Where it is.
    pub path: PathBuf,
    /// Keeps the functions in memory.
    _library: Library,
}

impl Compiled {
    /// Writes the functions of a model as C and compiles them, or takes what the same source, compiler and processor have
    /// left before.
    ///
    /// # Errors
    /// If the compiler is missing or fails, or the library cannot be written.
    pub fn new(
        model: &Model,
        (functions, parameters): (Functions, &[RunTimeParameter]),
        compiler: Option<OsString>,
    ) -> Result<Compiled, PyErr> {
        let compiler = Compiler::new(compiler)?;
        let options = CodegenOptions { functions, parameters: parameters.to_vec(), ..CodegenOptions::default() };
        let made = c_library(model, PREFIX, &options);
        let CLibrary { files, functions: made_functions, given } =
            made.map_err(|error| fault(&error.to_string(), ""))?;
        let (header, source) = (files.header, files.source);
        let key = [source.as_bytes(), header.as_bytes(), &compiler.key(), &processor()].concat();
        let folder = folder()?;
        let path = folder.join(format!("{PREFIX}-{:032x}{}", hash(&key), env::consts::DLL_SUFFIX));
        if !path.exists() {
            fs::create_dir_all(&folder).map_err(|error| unwritten(&folder, &error))?;
            compile(&compiler, &folder, &path, (&header, &source))?;
        }
        Compiled::open(path, functions, (&made_functions, given))
    }

    fn open(path: PathBuf, functions: Functions, (made, given): (&[Function], usize)) -> Result<Compiled, PyErr> {
        let unusable = |error: libloading::Error| {
            let mut reasons = vec![error.to_string()];
            let mut cause: Option<&dyn Error> = error.source();
            while let Some(error) = cause {
                reasons.push(error.to_string());
                cause = error.source();
            }
            let reason = reasons.join(": ");
            // A file system that is mounted without the right to run what is on it.
            let help = if ["failed to map segment", "not permitted", "denied"].iter().any(|word| reason.contains(word))
            {
                "its folder may not hold code that runs: name another folder by the environment variable REDYSIM_CACHE"
            } else {
                "delete it, so that it is compiled again"
            };
            fault(&format!("{} cannot be loaded: {reason}", path.display()), help)
        };
        // SAFETY: the library is the one that `compile` makes of generated code, without code that runs when it is loaded.
        let library = unsafe { Library::new(&path) }.map_err(unusable)?;
        let mut entries = [None; Function::ALL.len()];
        for function in made {
            // SAFETY: the symbol is a function of this type.
            let entry = unsafe { library.get::<Entry>(CLibrary::symbol(*function).as_str()) }.map_err(unusable)?;
            entries[*function as usize] = Some(*entry);
        }
        let init = if given > 0 {
            // SAFETY: as above.
            let init = unsafe { library.get(CLibrary::INIT) }.map_err(unusable)?;
            Some((*init, given))
        } else {
            None
        };
        Ok(Compiled { init, entries, functions, path, _library: library })
    }

    /// What `count` robots with these parameters are given.
    pub fn given(&self, parameters: &[f64], count: usize) -> Vec<f64> {
        let Some((init, length)) = self.init else { return Vec::new() };
        let mut given = vec![0.0; length * count];
        let of_robots = parameters.chunks_exact((parameters.len() / count.max(1)).max(1));
        for (parameters, given) in of_robots.zip(given.chunks_exact_mut(length)) {
            // SAFETY: the library was made for as many parameters and given numbers.
            unsafe { init(parameters.as_ptr(), given.as_mut_ptr()) };
        }
        given
    }

    /// The compiled function; `None` for one without numbers, as the loops of a mechanism without loops.
    pub fn entry(&self, function: Function) -> Option<Entry> {
        self.entries[function as usize]
    }
}

/// Compiles the source to the library at `path`, which is there whole or not at all.
fn compile(compiler: &Compiler, folder: &Path, path: &Path, (header, source): (&str, &str)) -> Result<(), PyErr> {
    let draft = tempfile::tempdir_in(folder).map_err(|error| unwritten(folder, &error))?;
    let write = |name: &str, text: &str| {
        let path = draft.path().join(name);
        fs::write(&path, text).map_err(|error| unwritten(&path, &error)).map(|()| path)
    };
    write(&format!("{PREFIX}.h"), header)?;
    let source = write(&format!("{PREFIX}.c"), source)?;
    let library = draft.path().join("library");
    compiler.compile(&source, &library, folder)?;
    // Some file systems find only now that there is no room.
    let written = File::open(&library).and_then(|file| file.sync_all());
    written.and_then(|()| fs::rename(&library, path)).map_err(|error| unwritten(path, &error))
}

/// Where libraries are kept.
fn folder() -> Result<PathBuf, PyErr> {
    let of = |name: &str| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let usual =
        || of("XDG_CACHE_HOME").or_else(|| Some(of("HOME")?.join(".cache"))).map(|folder| folder.join("redysim"));
    of("REDYSIM_CACHE").or_else(usual).ok_or_else(|| {
        fault("the folder for compiled functions is unknown", "set the environment variable REDYSIM_CACHE to a folder")
    })
}

/// What tells the processor from others: code for it may not run there.
fn processor() -> Vec<u8> {
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let is_of_processor = |line: &&str| ["model name", "flags", "Features"].iter().any(|name| line.starts_with(name));
    let mut lines: Vec<&str> = information.lines().filter(is_of_processor).take(2).collect();
    lines.push(env::consts::ARCH);
    lines.join("\n").into_bytes()
}

/// FNV-1a, of 128 bits.
fn hash(bytes: &[u8]) -> u128 {
    let step = |hash: u128, byte: &u8| (hash ^ u128::from(*byte)).wrapping_mul(0x1_0000_0000_0000_0000_0000_013b);
    bytes.iter().fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, step)
}
