//! The program as a user calls it, and what it writes.
#![allow(dead_code, unused_imports, reason = "each test uses a part")]

mod program;
mod refusals;
mod robot;
#[cfg(unix)]
pub mod running;
mod scenarios;
mod table;
#[path = "../../../tests/common/tools.rs"]
mod tools;

use std::fs;
use std::path::{Path, PathBuf};

pub use program::{Run, call, cargo, fail, program, succeed};
#[cfg(unix)]
pub use program::{bash, on_a_full_disk};
pub use refusals::{refuses, refuses_in};
pub use robot::{BALLS, robot};
pub use scenarios::{AGAINST_CLOSED_FORMS, LIFT, LONG, SWING, WALKING, results, scenario, slide, swing, turn};
pub use table::{Table, deviation};
pub use tools::{all_tools, skip};

/// The repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// The path of the scenario `name` of the repository.
pub fn shipped(name: &str) -> String {
    root().join(format!("scenarios/{name}.toml")).display().to_string()
}

/// The path of a model file of the repository.
pub fn model(name: &str) -> String {
    root().join("models").join(name).display().to_string()
}

/// An empty folder of a test's own.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The names in `folder`, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The data in a page of HTML.
pub fn data(page: &str) -> serde_json::Value {
    let (_, rest) = page.split_once(r#"<script id="data" type="application/json">"#).unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}
