//! Long runs: how far they are is shown, and Ctrl-C keeps what was computed.
#![cfg(unix)]

use std::fs;
use std::path::Path;

#[cfg(target_os = "linux")]
use crate::common::running;
use crate::common::running::{Running, interrupted};
use crate::common::{LONG, Table, names, scenario, scratch, succeed};

/// What a terminal shows of the first two seconds of a long run.
#[cfg(target_os = "linux")]
fn shown(name: &str, options: &str) -> String {
    let folder = scratch(name);
    let path = scenario(&folder, "two_link.toml", LONG);
    running::shown(&folder, &format!("forward '{path}' -o run {options}"))
}

/// Another run ignores the draft of a run in progress, and reports the draft of a run that was killed.
#[cfg(target_os = "linux")]
#[test]
fn the_draft_of_a_run_that_was_killed_is_mentioned_by_the_next_run_of_the_same_output() {
    let folder = scratch("interrupt-killed");
    let long = scenario(&folder, "two_link.toml", LONG);
    let short = folder.join("short.toml");
    fs::write(&short, fs::read_to_string(&long).unwrap().replace("1e5", "0.05")).unwrap();
    let again = |options: &[&str]| {
        let run = crate::common::call(&folder, &[&["forward", "short.toml", "-o", "run", "--force"], options].concat());
        assert_eq!(run.code, 0, "{}", run.stderr);
        run.stderr
    };
    let mut running = Running::begin(&folder, &["forward", &long, "-o", "run"]);
    assert_eq!(again(&[]), "");
    running.kill();
    let draft = names(&folder).into_iter().find(|name| name.ends_with(".draft")).unwrap();
    fs::create_dir(folder.join("run.4194305.before")).unwrap();
    for other in ["other.4194305.draft", "run.x.draft", "run.4194305.notes"] {
        fs::create_dir(folder.join(other)).unwrap();
    }
    let shown = again(&[]);
    assert!(shown.contains(&format!("has left its draft: {draft}\n")), "{shown}");
    assert!(shown.contains(&format!("delete it: rm -r \"{draft}\"")), "{shown}");
    assert!(shown.contains("has left the earlier one: run.4194305.before\n"), "{shown}");
    assert_eq!(shown.matches("warning: ").count(), 2, "{shown}");
    assert_eq!(again(&["--quiet"]), "");
    assert!(folder.join(draft).exists());
}

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_terminal_shows_how_far_a_long_run_is_and_how_long_it_will_take() {
    let bar = shown("progress", "");
    assert!(bar.contains("0 %") && bar.contains(" left"), "{bar}");
    let none = shown("progress-quiet", "--quiet");
    assert!(!none.contains('%') && none.contains("interrupted: "), "{none}");
}

/// Interrupts a run that would go on for long, and returns the states that it leaves.
fn kept(folder: &Path, command: &str, path: &str) -> Table {
    let run = Running::begin(folder, &[command, path, "-o", "run"]);
    // Rows are written as they are computed, a buffer at a time.
    run.wait(|draft| fs::metadata(draft.join("statevar.csv")).is_ok_and(|file| file.len() > 100_000));
    let (code, output) = interrupted(run);
    assert_eq!(code, Some(130), "{output}");
    assert!(output.contains("interrupted: ") && output.contains("are in run"), "{output}");
    assert!(!output.contains('%'), "no terminal, no bar: {output}");
    assert_eq!(names(folder), ["run", "trial.toml"], "no draft is left");
    let states = Table::csv(&folder.join("run/statevar.csv"));
    assert!(output.contains(&format!("{} instants", states.rows.len())), "{output}");
    for table in names(&folder.join("run")).iter().filter(|name| name.ends_with(".csv")) {
        assert_eq!(Table::csv(&folder.join("run").join(table)).rows.len(), states.rows.len(), "{table}");
    }
    assert!(fs::read_to_string(folder.join("run/run.toml")).unwrap().contains("ended = \"interrupted\""));
    states
}

#[test]
fn ctrl_c_keeps_what_was_computed() {
    let folder = scratch("interrupt");
    let states = kept(&folder, "forward", &scenario(&folder, "two_link.toml", LONG));
    for (k, t) in states.column("t [s]").into_iter().enumerate() {
        assert!((t - 0.01 * k as f64).abs() < 1e-9, "every instant until then");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn ctrl_c_keeps_what_was_computed_of_closed_loops() {
    let folder = scratch("interrupt-loops");
    let rest = LONG.replace("q = [0, 1]", "q = [0, 0.9844, 4.3144]");
    kept(&folder, "forward", &scenario(&folder, "fourbar.toml", &rest));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn ctrl_c_keeps_what_was_computed_of_inverse_dynamics() {
    let folder = scratch("interrupt-inverse");
    let rest = "[trajectory]\nfrom = [0, 0]\nto = [1, 1]\nduration = 1e3\n[inverse]\nend = 1e3\nstep = 0.001\n";
    kept(&folder, "inverse", &scenario(&folder, "two_link.toml", rest));
}

/// A run that was meant to replace a result is no reason to lose it before it is done.
#[test]
fn a_part_of_a_run_replaces_no_result() {
    let folder = scratch("interrupt-force");
    let short = scenario(&folder, "two_link.toml", &LONG.replace("end = 1e5", "end = 0.1"));
    succeed(&folder, &["forward", &short, "-o", "run"]);
    let before = fs::read(folder.join("run/run.toml")).unwrap();
    let long = scenario(&folder, "two_link.toml", LONG);
    let (code, output) = interrupted(Running::begin(&folder, &["forward", &long, "-o", "run", "--force"]));
    assert_eq!(code, Some(130), "{output}");
    assert!(output.contains("are in run-2"), "{output}");
    assert_eq!(fs::read(folder.join("run/run.toml")).unwrap(), before);
    assert_eq!(names(&folder), ["run", "run-2", "trial.toml"]);
}

/// The second may come while the tables are being finished: then there is a whole result, or nothing. It may even come
/// between the result and the line that reports it.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn two_ctrl_cs_in_a_row_leave_no_half_result() {
    let folder = scratch("interrupt-pair");
    let path = scenario(&folder, "two_link.toml", LONG);
    for _ in 0..3 {
        let before = names(&folder);
        let run = Running::begin(&folder, &["forward", &path, "-o", "run", "--force"]);
        run.wait(|draft| std::fs::metadata(draft.join("statevar.csv")).is_ok_and(|file| file.len() > 1000));
        run.interrupt();
        run.interrupt();
        let (code, output) = run.end();
        assert_eq!(code, Some(130), "{output}");
        let left = names(&folder);
        let reported = output.contains("are in run") || output.contains("nothing is kept");
        assert!(reported || left.len() > before.len(), "{left:?}: {output}");
        for name in left.iter().filter(|name| *name != "trial.toml") {
            assert!(!name.contains("draft") && names(&folder.join(name)).contains(&"run.toml".to_owned()), "{left:?}");
        }
    }
}

/// The reader of the output has stopped: the run waits, and cannot check whether it is to end.
#[cfg(target_os = "linux")]
mod waiting {
    use super::*;
    use std::io::{PipeReader, Read, Write};

    /// A run that is about to report how it closes its loops, and cannot; its second instant is hours away.
    fn stuck(folder: &Path) -> (Running, PipeReader) {
        let rest = LONG.replace("q = [0, 1]", "q = [0, 0.9844, 4.3144]").replace("step = 0.01\n", "step = 1e4\n");
        let path = scenario(folder, "fourbar.toml", &rest);
        let (reader, mut writer) = std::io::pipe().unwrap();
        // As much as a pipe holds.
        writer.write_all(&[b' '; 1 << 16]).unwrap();
        let mut program = crate::common::program(folder, &["forward", &path, "-o", "results/run"]);
        (Running::of(program.stdout(writer), &folder.join("results")), reader)
    }

    #[test]
    fn the_second_ctrl_c_ends_the_program_at_once_and_leaves_nothing() {
        let folder = scratch("interrupt-twice");
        let (mut run, reader) = stuck(&folder);
        run.interrupt();
        run.interrupt_until_it_ends();
        let (code, output) = run.end();
        drop(reader);
        assert_eq!(code, Some(130), "{output}");
        assert!(output.contains("interrupted: nothing is kept"), "{output}");
        assert_eq!(names(&folder), ["trial.toml"]);
    }

    #[test]
    fn ctrl_c_before_the_second_instant_leaves_nothing() {
        let folder = scratch("interrupt-early");
        let (run, mut reader) = stuck(&folder);
        run.interrupt();
        let reading = std::thread::spawn(move || reader.read_to_end(&mut Vec::new()));
        let (code, output) = run.end();
        reading.join().unwrap().unwrap();
        assert_eq!(code, Some(130), "{output}");
        assert!(output.contains("nothing was computed yet"), "{output}");
        assert_eq!(names(&folder), ["trial.toml"]);
    }
}
