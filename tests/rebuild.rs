//! A compiled mechanism follows its model file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const MANIFEST: &str = r#"
[package]
name = "follower"
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

#[test]
fn an_edited_model_is_compiled_again() {
    let package = Path::new(env!("CARGO_TARGET_TMPDIR")).join("follower");
    fs::create_dir_all(package.join("src")).unwrap();
    fs::create_dir_all(package.join("models")).unwrap();
    let root = env!("CARGO_MANIFEST_DIR");
    fs::write(package.join("Cargo.toml"), MANIFEST.replace("REDYSIM", &root.replace('\\', "/"))).unwrap();
    fs::write(package.join("src/main.rs"), PROGRAM).unwrap();
    fs::copy(Path::new(root).join("Cargo.lock"), package.join("Cargo.lock")).unwrap();
    for (mass, torque) in [("2.0", "20"), ("3.0", "30")] {
        fs::write(package.join("models/pendulum.toml"), MODEL.replace("MASS", mass)).unwrap();
        assert_eq!(output(&package), torque, "mass {mass} kg");
    }
}

fn output(package: &PathBuf) -> String {
    let output = Command::new(env!("CARGO"))
        .args(["run", "--quiet"])
        .current_dir(package)
        .env("CARGO_TARGET_DIR", Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_std"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}
