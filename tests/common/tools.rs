//! Tools that not every machine has.

const ALL_TOOLS: &str = "REDYSIM_ALL_TOOLS";

/// Whether tests use more than Rust and the compilers by which it links: Clang, CMake, Eigen.
///
/// They do where `REDYSIM_ALL_TOOLS` is set, as by `.ci/run`; each tool must be there then. `cargo test` alone runs the same on
/// every machine, whatever else is installed there.
pub fn all_tools() -> bool {
    std::env::var_os(ALL_TOOLS).is_some()
}

/// Reports that a test, or a part of it, is skipped because a tool is missing or not used.
///
/// # Panics
/// If [`all_tools`] are used.
pub fn skip(reason: &str) {
    assert!(!all_tools(), "{reason}, and {ALL_TOOLS} is set: install it");
    eprintln!("SKIPPED: {reason}");
}
