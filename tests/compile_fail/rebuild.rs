//! A compiled mechanism follows its model file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const MANIFEST: &str = r#"
[package]
name = "NAME"
version = "0.1.0"
edition = "2024"

[dependencies]
redysim = { path = "REDYSIM", default-features = false }

[workspace]
"#;

const MODEL: &str = r#"
name = "pendulum"
gravity = [0.0, -10.0, 0.0]

[[link]]
name = "rod"
parent = "base"
joint = "revolute"
axis = [0.0, 0.0, 1.0]
mass = MASS
com = [1.0, 0.0, 0.0]
"#;

const PROGRAM: &str = r#"
redysim::redysim! { struct Pendulum("models/pendulum.toml"); }
fn main() {
    print!("{}", Pendulum::gravity_forces(&[0.0])[0]);
}
"#;

/// A package with a pendulum of this mass, which prints the torque that holds it.
fn package(name: &str) -> PathBuf {
    let package = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(package.join("src")).unwrap();
    fs::create_dir_all(package.join("models")).unwrap();
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    fs::write(package.join("Cargo.toml"), MANIFEST.replace("NAME", name).replace("REDYSIM", &root.replace('\\', "/")))
        .unwrap();
    fs::write(package.join("src/main.rs"), PROGRAM).unwrap();
    fs::copy(Path::new(root).join("Cargo.lock"), package.join("Cargo.lock")).unwrap();
    package
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn an_edited_model_is_compiled_again() {
    let package = package("follower");
    for (mass, torque) in [("2.0", "20"), ("3.0", "30")] {
        fs::write(package.join("models/pendulum.toml"), MODEL.replace("MASS", mass)).unwrap();
        let output = run(&package);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        assert_eq!(String::from_utf8_lossy(&output.stdout), torque, "mass {mass} kg");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_fault_is_shown_at_its_line_and_column_of_the_model() {
    let package = package("faulty");
    fs::write(package.join("models/pendulum.toml"), MODEL.replace("MASS", "\"heavy\"")).unwrap();
    let output = run(&package);
    let shown = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success());
    assert!(shown.contains("models/pendulum.toml:10:8"), "{shown}");
    assert!(shown.contains("10 | mass = \"heavy\""), "{shown}");
    assert!(shown.contains("due to 1 previous error"), "{shown}");
}

fn run(package: &Path) -> Output {
    Command::new(env!("CARGO"))
        .args(["run", "--quiet"])
        .current_dir(package)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("crates"))
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .env("CARGO_INCREMENTAL", "0")
        .output()
        .expect("cargo runs")
}
