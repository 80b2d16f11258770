//! What the program is given, and the results that follow from it.

use std::fs;
use std::path::{Path, PathBuf};

use super::{root, succeed};

/// A double pendulum that falls for a second.
pub const SWING: &str = "initial = { q = [0, 1] }\n[forward]\nend = 1.0\nstep = 0.1\n";

/// The forces that lift two links in a second.
pub const LIFT: &str = "[trajectory]\nfrom = [0, 0]\nto = [1, 1]\nduration = 1.0\n[inverse]\nend = 1.0\nstep = 0.1\n";

/// Hours of steps.
pub const LONG: &str =
    "initial = { q = [0, 1] }\n[forward]\nend = 1e5\nstep = 0.01\nintegrator = { method = 'Ode5', step = 0.001 }\n";

/// Shipped scenarios of robots on legs, each of which takes five to ten seconds in a debug build.
pub const WALKING: [&str; 3] = ["hexapod", "quadruped", "walking_biped"];

/// An integrator whose errors cannot be seen beside a closed form of one or a few metres, radians, …
pub const AGAINST_CLOSED_FORMS: &str = "integrator = { method = 'Dop853', rtol = 1e-12, atol = 1e-13 }\n";

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
