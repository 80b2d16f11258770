//! Calls of the program.

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command, ExitStatus, Stdio};
use std::thread::{sleep, spawn};
use std::time::{Duration, Instant};

use super::root;

/// A call that takes longer, which none does on a slow machine, is killed, so that its test fails.
const LONGEST: Duration = Duration::from_secs(120);

/// What a command printed, and its exit code.
pub struct Run {
    pub stdout: String,
    pub stderr: String,
    pub code: i32,
}

impl Run {
    /// Runs a command until it ends.
    pub fn of(command: &mut Command) -> Run {
        let output = command.output().unwrap();
        Run::ended([output.stdout, output.stderr], output.status)
    }

    fn ended(streams: [Vec<u8>; 2], status: ExitStatus) -> Run {
        let [stdout, stderr] = streams.map(|bytes| String::from_utf8(bytes).unwrap());
        Run { stdout, stderr, code: status.code().expect("it ends by itself") }
    }

    /// What was printed, on both streams.
    pub fn output(&self) -> String {
        format!("{}{}", self.stdout, self.stderr)
    }
}

/// The program, to be called in `folder`.
pub fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_redysim"));
    command.args(arguments).current_dir(folder);
    command
}

/// Cargo in a new crate, with the versions of dependencies that this workspace has, and one target folder for all.
pub fn cargo(folder: &Path, command: &str) -> Run {
    if !folder.join("Cargo.lock").exists() {
        fs::copy(root().join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
    }
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([command, "--offline", "--quiet"]).current_dir(folder);
    cargo.env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("crates"));
    cargo.env("CARGO_PROFILE_DEV_DEBUG", "0").env("CARGO_INCREMENTAL", "0");
    Run::of(&mut cargo)
}

/// Calls the program in `folder`.
pub fn call(folder: &Path, arguments: &[&str]) -> Run {
    fn read(mut stream: impl Read + Send + 'static) -> impl FnOnce() -> Vec<u8> {
        let mut bytes = Vec::new();
        let reader = spawn(move || stream.read_to_end(&mut bytes).map(|_| bytes));
        || reader.join().unwrap().unwrap()
    }
    let mut program = program(folder, arguments);
    let mut child = program.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let (stdout, stderr) = (read(child.stdout.take().unwrap()), read(child.stderr.take().unwrap()));
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > LONGEST {
            child.kill().unwrap();
        }
        sleep(Duration::from_millis(1));
    }
    Run::ended([stdout(), stderr()], child.wait().unwrap())
}

/// Calls the program in `folder`, which must go well, and returns what it prints.
pub fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let run = call(folder, arguments);
    assert_eq!(run.code, 0, "{arguments:?}: {}", run.output());
    run.stdout
}

/// Calls the program in `folder`, which must end with `code`, and returns its standard error.
pub fn fail(folder: &Path, arguments: &[&str], code: i32) -> String {
    failed(call(folder, arguments), arguments, code)
}

fn failed(run: Run, arguments: &[&str], code: i32) -> String {
    assert_eq!(run.code, code, "{arguments:?}: {}", run.output());
    assert!(!run.stderr.contains("panicked"), "{arguments:?}: {}", run.stderr);
    run.stderr
}

/// Runs a command line in `folder`, in which `$0` is the program and `$1`, `$2`, … are the arguments.
#[cfg(unix)]
pub fn bash(folder: &Path, command: &str, arguments: &[&str]) -> Run {
    let mut bash = Command::new("bash");
    Run::of(bash.args(["-c", command, env!("CARGO_BIN_EXE_redysim")]).args(arguments).current_dir(folder))
}

/// Calls the program in `folder`, where it must fail because no file may become larger than that: to write more is
/// refused, as by a disk that is full. Returns its standard error.
#[cfg(unix)]
pub fn on_a_full_disk(folder: &Path, kilobytes: u32, arguments: &[&str]) -> String {
    // Without the trap a signal would end it; bash counts in kilobytes.
    let command = format!("trap '' XFSZ; ulimit -f {kilobytes}; exec \"$0\" \"$@\"");
    failed(bash(folder, &command, arguments), arguments, 3)
}
