//! Tools that not every machine has.

/// Reports that a test, or a part of it, is skipped because a tool is missing.
///
/// # Panics
/// If `REDYSIM_ALL_TOOLS` is set, as by `.ci/run`, where every tool must be there.
pub fn skip(reason: &str) {
    assert!(std::env::var_os("REDYSIM_ALL_TOOLS").is_none(), "{reason}, and REDYSIM_ALL_TOOLS is set: install it");
    eprintln!("SKIPPED: {reason}");
}
