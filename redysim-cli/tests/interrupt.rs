//! Long runs: how far they are is shown, and Ctrl-C keeps what was computed.
#![cfg(unix)]

mod common;

use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use common::{Table, names, program, scenario, scratch};

/// Hours of steps.
const LONG: &str =
    "initial = { q = [0, 1] }\n[forward]\nend = 1e5\nstep = 0.1\nintegrator = { method = 'Ode5', step = 0.001 }\n";

/// What a terminal shows of the first two seconds of a long run.
#[cfg(target_os = "linux")]
fn shown(name: &str, options: &str) -> String {
    let folder = scratch(name);
    let path = scenario(&folder, "two_link.toml", LONG);
    let run = format!("'{}' forward '{path}' -o run {options}", env!("CARGO_BIN_EXE_redysim"));
    let for_two_seconds = format!("timeout --foreground --signal INT 2 {run}");
    let mut terminal = Command::new("script");
    terminal.args(["--quiet", "--return", "--command", &for_two_seconds, "/dev/null"]).current_dir(&folder);
    let output = terminal.stdin(Stdio::null()).output().unwrap();
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[cfg(target_os = "linux")]
#[test]
fn a_terminal_shows_how_far_a_long_run_is_and_how_long_it_will_take() {
    let bar = shown("progress", "");
    assert!(bar.contains("0 %") && bar.contains(" left"), "{bar}");
    let none = shown("progress-quiet", "--quiet");
    assert!(!none.contains('%') && none.contains("interrupted: "), "{none}");
}

#[test]
fn ctrl_c_keeps_what_was_computed() {
    let folder = scratch("interrupt");
    let path = scenario(&folder, "two_link.toml", LONG);
    let mut child = program(&folder, &["forward", &path, "-o", "run"]).stderr(Stdio::piped()).spawn().unwrap();
    // The draft is there before the first step; after it, a moment for some steps.
    let mut patience = 600;
    while !names(&folder).iter().any(|name| name.ends_with(".draft")) {
        patience -= 1;
        assert!(patience > 0 && child.try_wait().unwrap().is_none(), "the run begins");
        sleep(Duration::from_millis(50));
    }
    sleep(Duration::from_millis(1500));
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    for _ in 0..600 {
        sleep(Duration::from_millis(50));
        if child.try_wait().unwrap().is_some() {
            break;
        }
    }
    if child.try_wait().unwrap().is_none() {
        child.kill().unwrap();
        panic!("it goes on");
    }
    let output = child.wait_with_output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("interrupted: ") && said.contains("are in run"), "{said}");
    assert!(!said.contains('%'), "no terminal, no bar: {said}");
    assert_eq!(names(&folder), ["run", "trial.toml"], "no draft is left");
    let states = Table::csv(&folder.join("run/statevar.csv"));
    assert!(states.rows.len() > 2, "{} rows", states.rows.len());
    assert!(said.contains(&format!("{} instants", states.rows.len())), "{said}");
    for (k, t) in states.column("t [s]").into_iter().enumerate() {
        assert!((t - 0.1 * k as f64).abs() < 1e-9, "every instant until then");
    }
    assert!(fs::read_to_string(folder.join("run/run.toml")).unwrap().contains("ended = \"interrupted\""));
}
