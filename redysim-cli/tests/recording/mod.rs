//! Results folders, made by the generic path, for the tests of what reads them.
#![allow(dead_code, reason = "each test uses a part")]

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use redysim_model::{GenericMechanism, JointKind, Model};
use redysim_runtime::{ClosedLoop, ClosedLoopInverse, InverseDynamics, LinkKinematics, MechanicalEnergy, Motion};

/// A model of the repository.
pub fn model(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../models/{name}.toml"))
}

/// Runs the command.
pub fn redysim<const N: usize>(arguments: [&str; N]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_redysim")).args(arguments).output().unwrap()
}

/// What it said, be it on which stream it may.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// Joint forces and multipliers of a motion at one instant.
struct Instant {
    t: f64,
    motion: Motion<Vec<f64>, Vec<f64>>,
    tau: Vec<f64>,
    lambda: Vec<f64>,
}

/// Every joint swings on its own; the results of the inverse dynamics in `folder`.
pub fn swing(folder: &Path, model: &Path, seconds: f64, rows: usize) {
    let mechanism = GenericMechanism::new(Model::load(model).unwrap().model);
    let joints: Vec<f64> = (0..mechanism.tree().dof()).map(|joint| joint as f64).collect();
    let instants = (0..=rows).map(|row| {
        let t = seconds * row as f64 / rows as f64;
        let wave = |f: fn(f64) -> f64, factor: fn(f64) -> f64| -> Vec<f64> {
            joints.iter().map(|j| 0.7 * factor(2.0 + 0.5 * j) * f((2.0 + 0.5 * j) * t + j)).collect()
        };
        let (q, v, a) = (wave(f64::sin, |_| 1.0), wave(f64::cos, |w| w), wave(|x| -x.sin(), |w| w * w));
        let tau = mechanism.inverse_dynamics(&q, &v, &a);
        Instant { t, motion: Motion { q, v, a }, tau, lambda: vec![] }
    });
    write(folder, model, &mechanism, &instants.collect::<Vec<_>>());
}

/// In `seconds` the first joint turns by `angle` from where it is in `guess`, and the loops make the others follow.
pub fn turn(folder: &Path, model: &Path, angle: f64, seconds: f64, rows: usize, guess: &[f64]) {
    let mechanism = GenericMechanism::new(Model::load(model).unwrap().model);
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&mechanism), &[0], guess.to_vec());
    let (start, speed) = (guess[0], angle / seconds);
    let crank = |t: f64| Motion { q: vec![start + speed * t], v: vec![speed], a: vec![0.0] };
    let instants = (0..=rows).map(|row| {
        let t = seconds * row as f64 / rows as f64;
        let at = inverse.at(t, &crank).unwrap();
        let motion = Motion { q: at.motion.q, v: at.motion.v, a: at.motion.a };
        Instant { t, motion, tau: at.forces, lambda: at.multipliers }
    });
    let instants: Vec<_> = instants.collect();
    write(folder, model, &mechanism, &instants);
}

fn write(folder: &Path, model: &Path, mechanism: &GenericMechanism, instants: &[Instant]) {
    fs::create_dir_all(folder).unwrap();
    fs::copy(model, folder.join("model.toml")).unwrap();
    let model = mechanism.model();
    let joints = |symbol: &str, revolute: &str, prismatic: &str| -> Vec<String> {
        let unit = |kind| if kind == JointKind::Prismatic { prismatic } else { revolute }.to_owned();
        model.moving_links().map(|link| format!("{symbol} {} [{}]", link.joint_name, unit(link.joint))).collect()
    };
    let motion = [joints("q", "rad", "m"), joints("v", "rad/s", "m/s"), joints("a", "rad/s^2", "m/s^2")].concat();
    let table = |name: &str, headers: Vec<String>, row: &dyn Fn(&Instant) -> Vec<f64>| {
        let mut text = format!("t [s],{}\n", headers.join(","));
        for instant in instants {
            write!(text, "{:?}", instant.t).unwrap();
            row(instant).iter().for_each(|value| write!(text, ",{value:?}").unwrap());
            text.push('\n');
        }
        fs::write(folder.join(name), text).unwrap();
    };
    table("traj.csv", motion, &|at| [at.motion.q.as_slice(), &at.motion.v, &at.motion.a].concat());
    table("tor.csv", joints("tau", "N m", "N"), &|at| at.tau.clone());
    let of_link = ["x [m]", "y [m]", "z [m]", "com_x [m]", "com_y [m]", "com_z [m]"].map(str::to_owned);
    let rotation = (1..=9).map(|k| format!("r{}{} [1]", (k - 1) / 3 + 1, (k - 1) % 3 + 1));
    let of_link: Vec<String> = of_link.into_iter().chain(rotation).collect();
    let named = |link: &redysim_model::Link| {
        let name = link.name.clone();
        of_link.iter().map(move |header| header.replace(' ', &format!(" {name} "))).collect::<Vec<_>>()
    };
    table("kinematics.csv", model.links.iter().flat_map(named).collect(), &|at| {
        let links = mechanism.link_kinematics(&at.motion.q, &at.motion.v);
        links.iter().flat_map(|link| [&[link.origin, link.com], &link.rotation[..]].concat().concat()).collect()
    });
    let energies = ["kinetic [J]", "potential [J]", "total [J]", "drift [J]"].map(str::to_owned).to_vec();
    table("energy.csv", energies, &|at| {
        let energy = mechanism.energy(&at.motion.q, &at.motion.v);
        vec![energy.kinetic, energy.potential, energy.total(), 1e-12 * at.t.sin()]
    });
    if let Some(rows) = instants.first().map(|at| at.lambda.len()).filter(|&rows| rows > 0) {
        let name = |row| format!("lambda {} {} [N]", model.loops[0].name, row + 1);
        table("lambda.csv", (0..rows).map(name).collect(), &|at| at.lambda.clone());
    }
}
