//! The program as a user calls it, and what it writes.
#![allow(dead_code, reason = "each test uses a part")]

#[cfg(unix)]
pub mod running;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A double pendulum that falls for a second.
pub const SWING: &str = "initial = { q = [0, 1] }\n[forward]\nend = 1.0\nstep = 0.1\n";

/// Hours of steps.
pub const LONG: &str =
    "initial = { q = [0, 1] }\n[forward]\nend = 1e5\nstep = 0.01\nintegrator = { method = 'Ode5', step = 0.001 }\n";

/// The repository.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// An empty folder of a test's own.
pub fn scratch(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The program, to be called in `folder`.
pub fn program(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_redysim"));
    command.args(arguments).current_dir(folder);
    command
}

/// Calls the program in `folder`.
pub fn call(folder: &Path, arguments: &[&str]) -> Output {
    program(folder, arguments).output().unwrap()
}

/// Calls the program in `folder`, which must go well.
pub fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = call(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Calls the program in `folder`, which must end with `code`, and returns what it says.
pub fn fail(folder: &Path, arguments: &[&str], code: i32) -> String {
    let output = call(folder, arguments);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

/// Writes a scenario of a model of this repository, and returns its path.
pub fn scenario(folder: &Path, model: &str, rest: &str) -> String {
    let path = folder.join("trial.toml");
    let model = root().join("models").join(model);
    fs::write(&path, format!("model = '{}'\n{rest}", model.display())).unwrap();
    path.display().to_string()
}

/// The folder of results of `redysim inverse` or `forward`, with a scenario of a model of this repository.
pub fn results(folder: &Path, command: &str, model: &str, rest: &str) -> PathBuf {
    fs::create_dir_all(folder).unwrap();
    let path = scenario(folder, model, rest);
    succeed(folder, &[command, &path, "--output", "run", "--force", "--quiet"]);
    folder.join("run")
}

/// The results of inverse dynamics where each of so many joints swings by its own angle.
pub fn swing(folder: &Path, model: &str, joints: usize, seconds: f64, rows: usize) -> PathBuf {
    let to: Vec<f64> = (0..joints).map(|joint| 0.7 - 0.3 * (joint % 5) as f64).collect();
    let (from, step) = (vec![0; joints], seconds / rows as f64);
    let trajectory = format!("trajectory = {{ from = {from:?}, to = {to:?}, duration = {seconds:?} }}");
    results(folder, "inverse", model, &format!("{trajectory}\ninverse = {{ end = {seconds:?}, step = {step:?} }}\n"))
}

/// The results of inverse dynamics where the four-bar's crank turns once.
pub fn turn(folder: &Path, rows: usize) -> PathBuf {
    let motion = "initial = { q = [0.0, 0.9844, 4.3144] }\n\
                  trajectory = { kind = \"constant-speed\", from = [0.0], speed = [\"360 deg\"] }\n";
    let step = 1.0 / rows as f64;
    results(folder, "inverse", "fourbar.toml", &format!("{motion}inverse = {{ end = 1.0, step = {step:?} }}\n"))
}

/// The results of forward dynamics where the slider-crank falls.
pub fn slide(folder: &Path, rows: usize) -> PathBuf {
    let step = 0.5 / rows as f64;
    let motion = format!("initial = {{ q = [-2.6, 2.058, 1.031] }}\nforward = {{ end = 0.5, step = {step:?} }}\n");
    results(folder, "forward", "slider_crank.toml", &motion)
}

/// An integrator whose tolerances leave hardly more than rounding.
pub const TIGHT: &str = "method = \"Dop853\", rtol = 1e-13, atol = 1e-14";

/// A scenario of this repository with another integrator.
pub fn by(folder: &Path, name: &str, method: &str) -> String {
    let text = fs::read_to_string(root().join(format!("scenarios/{name}.toml"))).unwrap();
    let text = text.replace("../models", &root().join("models").display().to_string());
    let shipped = "method = \"Ode45\", rtol = 1e-4, atol = 1e-6";
    assert!(text.contains(shipped), "{name} has ReDySim's tolerances");
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text.replace(shipped, method)).unwrap();
    path.display().to_string()
}

/// The names in `folder`, in order.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// A table of numbers.
pub struct Table {
    pub headers: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Run {
    /// What was printed, be it on which stream it may.
    pub fn said(&self) -> String {
        format!("{}{}", self.stdout, self.stderr)
    }
}

impl Table {
    /// Reads comma-separated values with names above.
    pub fn csv(path: &Path) -> Table {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines();
        let headers = lines.next().unwrap().split(',').map(str::to_owned).collect();
        Table { headers, rows: lines.map(|line| numbers(line.split(','))).collect() }
    }

    /// Reads numbers between spaces.
    pub fn dat(path: &Path) -> Table {
        let text = fs::read_to_string(path).unwrap();
        Table { headers: vec![], rows: text.lines().map(|line| numbers(line.split_whitespace())).collect() }
    }

    /// A reference: its first line says what the columns are.
    pub fn reference(name: &str) -> Table {
        Table::csv(&root().join("tests/reference").join(name))
    }

    /// The columns `range` of each row.
    pub fn columns(&self, range: std::ops::Range<usize>) -> Vec<Vec<f64>> {
        self.rows.iter().map(|row| row[range.clone()].to_vec()).collect()
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self.headers.iter().position(|header| header == name);
        let index = index.unwrap_or_else(|| panic!("no `{name}` among {:?}", self.headers));
        self.rows.iter().map(|row| row[index]).collect()
    }
}

fn numbers<'a>(cells: impl Iterator<Item = &'a str>) -> Vec<f64> {
    cells.map(|cell| cell.parse().unwrap()).collect()
}

/// The largest difference between two tables, which must have the same shape.
pub fn deviation(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len(), "as many rows");
    let pairs = found.iter().zip(expected).flat_map(|(found, expected)| {
        assert_eq!(found.len(), expected.len(), "as many columns");
        found.iter().zip(expected)
    });
    // What is no number counts as infinite, so that it cannot hide.
    let sizes = pairs.map(|(found, expected)| (found - expected).abs());
    sizes.fold(0.0, |most, size| if size.is_nan() { f64::INFINITY } else { f64::max(most, size) })
}

/// What the command printed, and its exit code.
pub struct Run {
    pub stdout: String,
    pub stderr: String,
    pub code: i32,
}

/// Runs `redysim` with these arguments.
pub fn redysim(arguments: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_redysim")).args(arguments).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Run { stdout: text(output.stdout), stderr: text(output.stderr), code: output.status.code().unwrap() }
}

/// The path of a model file of the repository.
pub fn model(name: &str) -> String {
    root().join("models").join(name).display().to_string()
}
