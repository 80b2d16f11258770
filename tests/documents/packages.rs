//! What crates.io, docs.rs and the oldest supported compiler ask of the crates. `.ci/packages` builds the packages.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

/// The categories of the crates, each in the list of crates.io.
const CATEGORIES: [&str; 8] = [
    "command-line-utilities",
    "config",
    "mathematics",
    "no-std",
    "parser-implementations",
    "science::robotics",
    "simulation",
    "visualization",
];

/// What cargo prints for these arguments.
fn cargo(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO")).current_dir(env!("CARGO_MANIFEST_DIR")).args(arguments).output().unwrap();
    assert!(output.status.success(), "cargo {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The packages of the workspace, and with `dependencies` those of Cargo.lock.
fn packages(dependencies: bool) -> Vec<Value> {
    let mut arguments = vec!["metadata", "--locked", "--all-features", "--format-version=1"];
    if !dependencies {
        arguments.push("--no-deps");
    }
    let metadata: Value = serde_json::from_str(&cargo(&arguments)).unwrap();
    metadata["packages"].as_array().unwrap().clone()
}

/// The packages of the workspace that are published.
fn published() -> Vec<Value> {
    packages(false).into_iter().filter(|package| package["publish"].is_null()).collect()
}

fn text<'a>(package: &'a Value, key: &str) -> &'a str {
    package[key].as_str().unwrap_or_else(|| panic!("{} has no {key}", package["name"]))
}

fn words<'a>(package: &'a Value, key: &str) -> Vec<&'a str> {
    package[key].as_array().unwrap().iter().filter_map(Value::as_str).collect()
}

/// Major and minor version of a compiler.
fn compiler(version: &str) -> (u32, u32) {
    let mut parts = version.split('.').map(|part| part.parse().unwrap());
    (parts.next().unwrap(), parts.next().unwrap_or(0))
}

#[test]
fn the_eight_crates_are_published() {
    let names: Vec<_> = published().iter().map(|package| text(package, "name").to_owned()).collect();
    let crates = ["", "-cli", "-codegen", "-figures", "-macros", "-model", "-runtime", "-toml"];
    assert_eq!(BTreeSet::from_iter(names), BTreeSet::from(crates.map(|suffix| format!("redysim{suffix}"))));
}

#[test]
fn versions_are_in_step() {
    for package in packages(false) {
        let name = text(&package, "name");
        assert_eq!(text(&package, "version"), env!("CARGO_PKG_VERSION"), "{name}");
        assert_eq!(text(&package, "rust_version"), env!("CARGO_PKG_RUST_VERSION"), "{name}");
        assert_eq!(text(&package, "edition"), "2024", "{name}");
        // Cargo leaves development dependencies without a version out of what it publishes.
        let is_published = |it: &&Value| it["path"].is_string() && (it["kind"] != "dev" || it["req"] != "*");
        for dependency in package["dependencies"].as_array().unwrap().iter().filter(is_published) {
            let required = text(dependency, "req");
            assert_eq!(required, concat!("^", env!("CARGO_PKG_VERSION")), "{name} needs {}", dependency["name"]);
        }
    }
}

#[test]
fn metadata_is_complete() {
    for package in published() {
        let name = text(&package, "name");
        assert!(text(&package, "description").len() > 20, "{name}");
        assert!(text(&package, "license").contains("MIT OR Apache-2.0"), "{name}");
        let keywords = words(&package, "keywords");
        assert!((1..=5).contains(&keywords.len()), "{name} has {} keywords", keywords.len());
        for keyword in keywords {
            let plain = keyword.starts_with(|c: char| c.is_ascii_alphanumeric())
                && keyword.chars().all(|c| c.is_ascii_alphanumeric() || "_-+".contains(c));
            assert!(plain && keyword.len() <= 20, "{name}: crates.io rejects the keyword `{keyword}`");
        }
        let categories = words(&package, "categories");
        assert!((1..=5).contains(&categories.len()), "{name} has {} categories", categories.len());
        for category in categories {
            assert!(CATEGORIES.contains(&category), "{name}: `{category}` may not be a category of crates.io");
        }
        // `.ci/packages` documents every library with all features.
        assert_eq!(package["metadata"]["docs"]["rs"]["all-features"], true, "{name}");
    }
}

#[test]
fn every_package_has_its_readme_and_the_licences() {
    for package in published() {
        let name = text(&package, "name");
        let folder = Path::new(text(&package, "manifest_path")).parent().unwrap();
        let packaged = cargo(&["package", "--list", "--allow-dirty", "--package", name]);
        let files: Vec<_> = packaged.lines().collect();
        assert!(files.contains(&text(&package, "readme")), "{name} is packaged without its README");
        for licence in ["LICENSE-APACHE", "LICENSE-MIT"] {
            assert!(files.contains(&licence), "{name} is packaged without {licence}");
            let [own, root] = [&folder.join(licence), &Path::new(env!("CARGO_MANIFEST_DIR")).join(licence)]
                .map(|path| fs::read_to_string(path).unwrap());
            assert_eq!(own, root, "{licence} of {name}: a link that was checked out as text?");
        }
    }
}

#[test]
fn the_package_has_every_file_that_its_documentation_compiles() {
    let packaged = cargo(&["package", "--list", "--allow-dirty", "--package", "redysim"]);
    let files: Vec<_> = packaged.lines().collect();
    let mut used = 0;
    for file in files.iter().filter(|file| file.ends_with(".rs") || file.ends_with(".md")) {
        let content = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap_or_default();
        // `models/..` from the package's folder, `../..` from its folders `src` and `docs`.
        let paths = content.split('"').filter(|part| part.starts_with("models/") || part.starts_with("../"));
        for name in paths.filter(|path| path.ends_with(".toml") || path.ends_with(".md")) {
            used += 1;
            let path = name.trim_start_matches("../");
            assert!(files.contains(&path), "{file} uses {path}, which is not packaged");
        }
    }
    assert!(used > 10, "{used} files");
}

#[test]
fn no_dependency_needs_a_newer_compiler_than_the_crates_promise() {
    let promised = compiler(env!("CARGO_PKG_RUST_VERSION"));
    let packages = packages(true);
    for package in &packages {
        if let Some(needed) = package["rust_version"].as_str() {
            assert!(compiler(needed) <= promised, "{} needs Rust {needed}", package["id"]);
        }
    }
    assert!(packages.len() > 100, "{} packages", packages.len());
}
