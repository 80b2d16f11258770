//! A run that is going on.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use super::{names, program};

pub struct Running {
    child: Child,
    /// What it writes into until it ends.
    draft: PathBuf,
}

impl Running {
    /// Begins a run of the program in `folder`, and waits until it is on its way.
    pub fn begin(folder: &Path, arguments: &[&str]) -> Running {
        Running::of(program(folder, arguments).stdout(Stdio::null()), folder)
    }

    /// Begins `program`, and waits for its draft in `parent`.
    pub fn of(program: &mut Command, parent: &Path) -> Running {
        let child = program.stderr(Stdio::piped()).spawn().unwrap();
        let draft = parent.join(format!("run.{}.draft", child.id()));
        let run = Running { child, draft };
        run.wait(Path::exists);
        run
    }

    /// Begins a run of the program in `folder`, which writes into `place` from the start.
    pub fn into(folder: &Path, arguments: &[&str], place: PathBuf) -> Running {
        let child = program(folder, arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        Running { child, draft: place }
    }

    /// Waits until the draft is as it should be.
    pub fn wait(&self, ready: impl Fn(&Path) -> bool) {
        for _ in 0..2400 {
            if ready(&self.draft) {
                return;
            }
            sleep(Duration::from_millis(25));
        }
        panic!("it does not come so far: {:?}", names(self.draft.parent().unwrap()));
    }

    /// Kills the program, which its parent does not notice.
    pub fn kill(&mut self) {
        self.child.kill().unwrap();
        let status = format!("/proc/{}/status", self.child.id());
        self.wait(|_| fs::read_to_string(&status).is_ok_and(|status| status.contains("State:\tZ")));
    }

    /// Presses Ctrl-C.
    pub fn interrupt(&self) {
        assert!(Command::new("kill").args(["-INT", &self.child.id().to_string()]).status().unwrap().success());
    }

    /// Presses Ctrl-C until the program heeds it: two that follow each other too closely are one.
    pub fn interrupt_until_it_ends(&mut self) {
        for _ in 0..600 {
            if self.child.try_wait().unwrap().is_some() {
                return;
            }
            self.interrupt();
            sleep(Duration::from_millis(100));
        }
    }

    /// Waits until it ends; returns its exit code and its standard error.
    pub fn end(mut self) -> (Option<i32>, String) {
        for _ in 0..1200 {
            if self.child.try_wait().unwrap().is_some() {
                break;
            }
            sleep(Duration::from_millis(50));
        }
        let status = self.child.try_wait().unwrap().expect("it goes on");
        let mut output = String::new();
        self.child.stderr.take().unwrap().read_to_string(&mut output).unwrap();
        (status.code(), output)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Of a test that fails nothing goes on.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What a terminal shows of the first two seconds of a run in `folder`, after which Ctrl-C is pressed.
#[cfg(target_os = "linux")]
pub fn shown(folder: &Path, arguments: &str) -> String {
    let run = format!("'{}' {arguments}", env!("CARGO_BIN_EXE_redysim"));
    let for_two_seconds = format!("timeout --foreground --signal INT 2 {run}");
    let mut terminal = Command::new("script");
    terminal.args(["--quiet", "--return", "--command", &for_two_seconds, "/dev/null"]).current_dir(folder);
    let output = terminal.stdin(Stdio::null()).output().unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Interrupts a run after a moment for some rows.
pub fn interrupted(run: Running) -> (Option<i32>, String) {
    run.wait(|draft| std::fs::metadata(draft.join("statevar.csv")).is_ok_and(|file| file.len() > 1000));
    run.interrupt();
    run.end()
}
