//! Tools that not every machine has.

const ALL_TOOLS: &str = "REDYSIM_ALL_TOOLS";

/// Whether tests use Clang, CMake and Eigen, beside Rust and its linker.
///
/// They do if `REDYSIM_ALL_TOOLS` is set, as by `.ci/run`; every tool must then be installed. Otherwise `cargo test` runs the same
/// tests on every machine.
pub fn all_tools() -> bool {
    std::env::var_os(ALL_TOOLS).is_some()
}

/// Reports that a test, or a part of it, is skipped because a tool is missing or not used.
///
/// # Panics
/// If [`all_tools`] returns `true`.
pub fn skip(reason: &str) {
    assert!(!all_tools(), "{reason}, and {ALL_TOOLS} is set: install it");
    eprintln!("SKIPPED: {reason}");
}
