//! The compilers of C and C++ for the target of the tests, and how a program that they make is run.
//!
//! Where the tests run under an emulator, `REDYSIM_RUNNER` is the command that runs a program, as `qemu-aarch64 -L
//! /usr/aarch64-linux-gnu`, and `CC` and `CXX` name compilers for the target, as in `studies/aarch64/run`.

use crate::common::tools::{all_tools, skip};
use std::path::Path;
use std::process::Command;
use std::sync::LazyLock;

/// The command that runs a program for the target of the tests, if that is not the machine at hand.
static RUNNER: LazyLock<Option<String>> =
    LazyLock::new(|| std::env::var("REDYSIM_RUNNER").ok().filter(|runner| !runner.trim().is_empty()));

static COMPILERS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let own = std::env::var("CC").ok();
    if RUNNER.is_none() {
        let there_are = |name: &String| {
            let runs = runs(name);
            if !runs {
                skip(&format!("the C compiler `{name}` cannot be run"));
            }
            runs
        };
        let clang = all_tools().then(|| "clang".into());
        return [own.unwrap_or("cc".into())].into_iter().chain(clang).filter(there_are).collect();
    }
    let own =
        own.filter(|own| runs(own)).expect("with REDYSIM_RUNNER, CC names a compiler for the target of the tests");
    let machine = command(&own).arg("-dumpmachine").output().expect("the compiler runs").stdout;
    let clang = format!("clang --target={}", String::from_utf8_lossy(&machine).trim());
    if links(&clang) {
        vec![own, clang]
    } else {
        skip(&format!("{clang} links no program"));
        vec![own]
    }
});

/// The compilers of C for the target of the tests: the machine's own, `CC` if that is set, and Clang, on the machine at hand
/// only if [`all_tools`] returns `true`. As in `CC`, flags may follow the name.
pub fn compilers() -> &'static [String] {
    if COMPILERS.is_empty() {
        skip("there is no C compiler here; install one, or name it in the variable CC");
    }
    &COMPILERS
}

/// The compiler of C++ beside one of C; `None` if there is none for the target of the tests.
pub fn cpp_compiler(c: &str) -> Option<String> {
    let cpp = if c.contains("clang") {
        Some(c.replacen("clang", "clang++", 1))
    } else {
        let host = RUNNER.is_none().then(|| "c++".into());
        std::env::var("CXX").ok().or(host)
    };
    let found = cpp.filter(|name| runs(name));
    if found.is_none() {
        skip(&format!("{c} comes without a C++ compiler"));
    }
    found
}

/// Whether the target of the tests is the machine at hand, whose processor a compiler may be told to use.
pub fn is_native() -> bool {
    RUNNER.is_none()
}

/// The command of a compiler with the flags that follow its name.
pub fn command(compiler: &str) -> Command {
    let mut words = compiler.split_whitespace();
    let mut command = Command::new(words.next().expect("a name"));
    command.args(words);
    command
}

/// The command that runs a program for the target of the tests.
pub fn program(path: &Path) -> Command {
    let Some(runner) = RUNNER.as_deref() else { return Command::new(path) };
    let mut command = command(runner);
    command.arg(path);
    command
}

fn runs(compiler: &str) -> bool {
    command(compiler).arg("--version").output().is_ok_and(|output| output.status.success())
}

/// Whether a compiler links an empty program: Clang has each target, but not each has its library here.
fn links(compiler: &str) -> bool {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let source = folder.join("empty.c");
    std::fs::write(&source, "int main(void)\n{\n    return 0;\n}\n").expect("a file");
    let made = command(compiler).arg(source).arg("-o").arg(folder.join("empty")).output();
    made.is_ok_and(|output| output.status.success())
}
