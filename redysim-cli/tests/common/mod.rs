//! Calls the command.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::path::PathBuf;
use std::process::Command;

/// What the command printed, and its exit code.
pub struct Run {
    pub stdout: String,
    pub stderr: String,
    pub code: i32,
}

/// Runs `redysim` with these arguments.
pub fn redysim(arguments: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_redysim")).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Run { stdout: text(output.stdout), stderr: text(output.stderr), code: output.status.code().unwrap() }
}

/// The repository.
pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The path of a model file of the repository.
pub fn model(name: &str) -> String {
    root().join("models").join(name).display().to_string()
}
