//! A robot that drives over the ground: an arm on a base with a planar joint.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::results;

/// A beacon that turns on the ground, and the rover, whose base is joined to a fixed post by `joint`.
fn model(joint: &str) -> String {
    let link = |name: &str, parent: &str, rest: &str| {
        let mass = "mass = 4.0\ncom = [0.1, 0, 0]\ninertia = { xx = 0.1, yy = 0.2, zz = 0.2 }";
        format!("[[link]]\nname = '{name}'\nparent = '{parent}'\n{rest}\n{mass}\n")
    };
    let start = "name = 'rover'\ngravity = [0, 0, -9.81]\nallow = ['under-actuated']\n".to_owned();
    let beacon = link("beacon", "base", "joint = 'revolute'\ndh = { a = 1.0 }");
    let post = link("post", "base", "joint = 'fixed'\norigin = { xyz = [0.5, 0, 0.2] }");
    let base = link("chassis", "post", &format!("{joint}\norigin = {{ rpy = [0, 0, '30 deg'] }}\nactuated = false"));
    let arm = link("arm", "chassis", "joint = 'revolute'\norigin = { xyz = [0.2, 0, 0.3] }\naxis = [0, 0, 1]");
    [start, beacon, post, base, arm].concat()
}

/// The results of two seconds in which its arm turns and its base starts at the velocities `v`, of `rows` rows.
pub fn drive(folder: &Path, joint: &str, v: &str, rows: usize) -> PathBuf {
    fs::create_dir_all(folder).unwrap();
    let path = folder.join("rover.toml");
    fs::write(&path, model(joint)).unwrap();
    let step = 2.0 / rows as f64;
    let rest =
        format!("[initial]\nv = {{ beacon = 1, chassis = {v}, arm = 2 }}\n[forward]\nend = 2.0\nstep = {step:?}\n");
    results(folder, "forward", &path.display().to_string(), &rest)
}
