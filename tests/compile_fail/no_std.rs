//! Compiled mechanisms and integrators need neither `std` nor an allocator, and no panic is left in them.

use std::path::Path;
use std::process::Command;

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_program_without_std_allocator_and_panics_links_and_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let status = Command::new(env!("CARGO"))
        .args(["run", "--release", "--quiet", "--manifest-path"])
        .arg(root.join("tests/no_std/Cargo.toml"))
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("crates"))
        .status()
        .expect("cargo runs");
    assert!(status.success(), "{status}");
}

#[test]
fn the_runtime_builds_without_its_features() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let status = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--package", "redysim-runtime", "--no-default-features"])
        .current_dir(root)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("crates"))
        .status()
        .expect("cargo runs");
    assert!(status.success(), "{status}");
}
