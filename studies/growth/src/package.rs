//! Packages that are built to see how long it takes and how fast they are.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

const MANIFEST: &str = r#"[package]
name = "NAME"
version = "0.1.0"
edition = "2024"

[dependencies]
redysim = { path = 'REDYSIM' }

[profile.dev]
incremental = false

[workspace]
"#;

/// How a package is built.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Profile {
    Dev,
    Release,
    /// Release, with all instructions that this machine has.
    Native,
}

/// A package with one program.
pub struct Package {
    name: String,
    folder: PathBuf,
}

/// What a build gave.
pub struct Built {
    pub seconds: f64,
    pub warnings: bool,
    pub program: PathBuf,
}

impl Package {
    /// A package of the given source files beside its manifest.
    pub fn new(name: &str, files: &[(&str, &str)]) -> Self {
        let folder = work().join(name);
        let write = |path: &str, text: &str| {
            let path = folder.join(path);
            fs::create_dir_all(path.parent().expect("a file in the folder")).expect("a writable target folder");
            fs::write(path, text).expect("a writable target folder");
        };
        let manifest = MANIFEST.replace("NAME", name).replace("REDYSIM", &root().display().to_string());
        write("Cargo.toml", &manifest);
        files.iter().for_each(|(path, text)| write(path, text));
        fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).expect("the repository's Cargo.lock");
        Package { name: name.to_owned(), folder }
    }

    /// Builds the package, its dependencies first; only the package itself is timed.
    pub fn build(&self, profile: Profile) -> Built {
        let source = self.folder.join("src/main.rs");
        let text = fs::read_to_string(&source).expect("a source file");
        fs::write(&source, "fn main() {}").expect("a writable target folder");
        self.cargo(profile);
        fs::write(&source, text).expect("a writable target folder");
        let begun = Instant::now();
        let output = self.cargo(profile);
        let seconds = begun.elapsed().as_secs_f64();
        let messages = String::from_utf8_lossy(&output.stderr);
        let folder = if profile == Profile::Dev { "debug" } else { "release" };
        let program = format!("{}{}", self.name, std::env::consts::EXE_SUFFIX);
        Built { seconds, warnings: messages.contains("warning"), program: target(profile).join(folder).join(program) }
    }

    fn cargo(&self, profile: Profile) -> Output {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.arg("build").current_dir(&self.folder).env("CARGO_TARGET_DIR", target(profile)).env_remove("RUSTFLAGS");
        if profile != Profile::Dev {
            cargo.arg("--release");
        }
        if profile == Profile::Native {
            cargo.env("RUSTFLAGS", "-C target-cpu=native");
        }
        let output = cargo.output().expect("cargo runs");
        assert!(output.status.success(), "{}: {}", self.name, String::from_utf8_lossy(&output.stderr));
        output
    }
}

impl Built {
    /// Runs the program: ns for a call of inverse and of forward dynamics.
    pub fn run(&self, batches: usize) -> [f64; 2] {
        let output = Command::new(&self.program).arg(batches.to_string()).output().expect("the program runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8_lossy(&output.stdout);
        let mut numbers = text.split_whitespace().map(|number| number.parse().expect("a number"));
        [(); 2].map(|()| numbers.next().expect("two numbers"))
    }
}

/// The root of the repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository")
}

/// The folder for all that is built.
fn work() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from).join("growth")
}

fn target(profile: Profile) -> PathBuf {
    work().join(if profile == Profile::Native { "target-native" } else { "target" })
}
