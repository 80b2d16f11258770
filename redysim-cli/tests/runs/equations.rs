//! The motions and forces of every shipped scenario obey equations of motion that nothing of this program's dynamics is
//! used for.

#[path = "../../../tests/common/kane.rs"]
#[allow(dead_code, reason = "of what it evaluates, a part is compared")]
mod kane;
#[path = "../../../tests/common/kane_loops.rs"]
mod kane_loops;

use redysim_runtime::Real;
use std::fs;
use std::path::Path;

use crate::common::{Table, WALKING, root, scratch, succeed};
use kane::kane;
use kane_loops::loop_rows;
use nalgebra::{DVector, Vector3};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::Mechanism;

/// Of a motion, s at least, and as a share of it: in less, one that begins slowly is hardly more than rounding.
const PART: f64 = 0.05;
const SHARE: f64 = 1.0 / 30.0;
/// From row to row, s, at most, and as a share of the step of the scenario, which fast motions need.
const STEP: f64 = 5e-4;
const SHARE_OF_STEP: f64 = 0.1;
/// Weights of the central difference of order 8.
const WEIGHTS: [f64; 4] = [4.0 / 5.0, -1.0 / 5.0, 4.0 / 105.0, -1.0 / 280.0];

/// Runs a scenario: of a motion only the first part, with tolerances that leave little more than rounding.
fn run(folder: &Path, name: &str, command: &str) {
    let mut scenario = read(name);
    if command == "forward" {
        let step = step(&scenario);
        let method = if stiff(&scenario) { "Radau5" } else { "Dop853" };
        let forward = scenario["forward"].as_table_mut().unwrap();
        let integrator = format!("method = '{method}'\nrtol = 1e-12\natol = 1e-15");
        forward.insert("integrator".into(), toml::Value::Table(integrator.parse().unwrap()));
        forward.insert("step".into(), step.into());
        let whole = forward["end"].as_float().unwrap();
        forward.insert("end".into(), PART.max(SHARE * whole).min(whole).into());
    }
    run_as_it_is(folder, scenario, command);
}

/// Runs a scenario of the folder of scenarios.
fn run_as_it_is(folder: &Path, mut scenario: toml::Table, command: &str) {
    let model = root().join("scenarios").join(scenario["model"].as_str().unwrap());
    scenario["model"] = model.display().to_string().into();
    for path in [&["trajectory", "file"][..], &["forward", "torque", "file"]] {
        let start = scenario.get_mut(path[0]);
        if let Some(file) = path[1..].iter().fold(start, |table, key| table.and_then(|table| table.get_mut(key))) {
            *file = root().join("scenarios").join(file.as_str().unwrap()).display().to_string().into();
        }
    }
    fs::write(folder.join("trial.toml"), scenario.to_string()).unwrap();
    succeed(folder, &[command, "trial.toml", "-o", "run"]);
}

fn read(name: &str) -> toml::Table {
    fs::read_to_string(root().join(format!("scenarios/{name}.toml"))).unwrap().parse().unwrap()
}

/// From row to row of a motion, s.
fn step(scenario: &toml::Table) -> f64 {
    STEP.min(SHARE_OF_STEP * scenario["forward"]["step"].as_float().unwrap())
}

/// The scenarios that ship with an implicit method are stiff.
fn stiff(scenario: &toml::Table) -> bool {
    scenario["forward"]["integrator"]["method"].as_str() == Some("Ode15s")
}

/// The shipped scenarios that have a table of this name.
fn shipped(command: &str) -> Vec<String> {
    let files = fs::read_dir(root().join("scenarios")).unwrap().map(|entry| entry.unwrap().path());
    let scenarios = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let names = scenarios.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned());
    let mut names: Vec<String> = names.filter(|name| read(name).contains_key(command)).collect();
    names.sort();
    names
}

/// What a run has written.
struct Written {
    mechanism: GenericMechanism,
    q: Rows,
    v: Rows,
    tau: Rows,
    lambda: Rows,
    /// Force on each frame that is in contact, by its number.
    contacts: Vec<Vec<(usize, [f64; 3])>>,
}

type Rows = Vec<Vec<f64>>;

/// From instant to instant at which Kane's equations are looked at.
const STRIDE: usize = if cfg!(debug_assertions) { 5 } else { 1 };

impl Written {
    fn read(folder: &Path) -> Written {
        let mechanism = GenericMechanism::new(Model::load(folder.join("model.toml")).unwrap().model);
        let (nq, nv) = (mechanism.nq(), mechanism.nv());
        let read = |table: &str| Table::csv(&folder.join(table));
        let (states, tau) = (read("statevar.csv"), read("tor.csv").columns(1..1 + nv));
        let lambda = match mechanism.model().loops.as_slice() {
            [] => vec![vec![]; tau.len()],
            _ => read("lambda.csv").rows.iter().map(|row| row[1..].to_vec()).collect(),
        };
        let frame = |header: &str| {
            let name = header.strip_prefix("force_x ")?.strip_suffix(" [N]")?;
            (0..mechanism.nf()).find(|&frame| mechanism.frame_name(frame) == Some(name))
        };
        let contacts = if folder.join("contacts.csv").exists() {
            let table = read("contacts.csv");
            let frames: Vec<_> =
                table.headers.iter().enumerate().filter_map(|(at, header)| Some((at, frame(header)?))).collect();
            let force = |row: &[f64], at: usize| [row[at], row[at + 1], row[at + 2]];
            table.rows.iter().map(|row| frames.iter().map(|&(at, frame)| (frame, force(row, at))).collect()).collect()
        } else {
            vec![vec![]; tau.len()]
        };
        let [q, v] = [states.columns(1..1 + nq), states.columns(1 + nq..1 + nq + nv)];
        Written { mechanism, q, v, tau, lambda, contacts }
    }

    fn accelerations(&self, folder: &Path) -> Rows {
        let (nq, nv) = (self.mechanism.nq(), self.mechanism.nv());
        Table::csv(&folder.join("traj.csv")).columns(1 + nq + nv..1 + nq + 2 * nv)
    }

    /// The rows of J that λ multiplies, from a position at which no row vanishes that does not vanish everywhere: of a planar
    /// loop two, since its axes stay parallel by themselves.
    fn kept_rows(&self) -> Vec<bool> {
        let (model, dof) = (self.mechanism.model(), self.mechanism.nv());
        let anywhere: Vec<f64> = (0..self.mechanism.nq()).map(|i| 0.3 + 1.7 * (i as f64).sin()).collect();
        let rows = loop_rows(model, &kane(model, &anywhere, &vec![0.0; dof]), dof);
        rows.row_iter().map(|row| row.amax() > 1e-9 * rows.amax()).collect()
    }

    /// The largest part of M q̈ + h − τ − Jᵀλ − Σ Jᵀf over `instants`, as a share of the largest of its terms.
    fn imbalance(&self, instants: impl Iterator<Item = usize>, acceleration: impl Fn(usize, usize) -> f64) -> f64 {
        let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
        let kept = self.kept_rows();
        for k in instants {
            let (q, dof) = (&self.q[k], self.v[k].len());
            let equations = kane(self.mechanism.model(), q, &self.v[k]);
            // Jacobians of the frames and of the points of loops are those of Kane's kinematics as well.
            let all = loop_rows(self.mechanism.model(), &equations, dof);
            let rows = all.row_iter().zip(&kept).filter(|(_, kept)| **kept).map(|(row, _)| row.transpose());
            let rows: Vec<DVector<f64>> = rows.collect();
            assert_eq!(rows.len(), self.lambda[k].len(), "a multiplier for each condition");
            let of_loops = rows.iter().zip(&self.lambda[k]).map(|(row, lambda)| row * *lambda);
            let of_ground = self.contacts[k].iter().map(|(frame, force)| {
                equations.frames[*frame].jacobians(dof).0.transpose() * Vector3::from_row_slice(force)
            });
            let terms = [
                equations.matrix * DVector::from_fn(dof, |joint, _| acceleration(k, joint)),
                equations.bias,
                -DVector::from_vec(self.tau[k].clone()),
                of_loops.fold(DVector::zeros(dof), |sum, force| sum - force),
                of_ground.fold(DVector::zeros(dof), |sum, force| sum - force),
            ];
            largest = terms.iter().fold(largest, |most, term| Real::maximum(most, term.amax()));
            worst = Real::maximum(worst, terms.into_iter().sum::<DVector<f64>>().amax());
        }
        worst / largest
    }
}

/// Accelerations are those that are written, and differences of the velocities.
#[test]
fn every_shipped_motion_obeys_kanes_equations() {
    let mut names = shipped("forward");
    if cfg!(debug_assertions) {
        names.retain(|name| !WALKING.contains(&name.as_str()));
        names = names.into_iter().step_by(5).collect();
    }
    for name in names {
        let folder = scratch(&format!("equations-of-motion-{name}"));
        run(&folder, &name, "forward");
        let written = Written::read(&folder.join("run"));
        let step = step(&read(&name));
        let difference = |k: usize, joint: usize| {
            let at = |k: usize| written.v[k][joint];
            let pairs = WEIGHTS.iter().zip(1..).map(|(weight, far)| weight * (at(k + far) - at(k - far)));
            pairs.sum::<f64>() / step
        };
        // Those that are written take what is written of the forces, whatever led to the state.
        let a = written.accelerations(&folder.join("run"));
        let share = written.imbalance((0..a.len()).step_by(STRIDE), |k, joint| a[k][joint]);
        assert!(share < 1e-11, "{name}, as it is written: {share:e}");
        // What is stiff is over by half the time.
        let share = written.imbalance((written.q.len() / 2..written.q.len() - 4).step_by(STRIDE), difference);
        println!("{name}: {share:.1e}");
        // Within the long steps of an implicit method its solution is of order 3. Legs on the ground follow a table, whose
        // third derivative jumps from row to row, which differences of order 8 see.
        let scenario = read(&name);
        let jumps = scenario.contains_key("contact") && scenario.contains_key("trajectory");
        let bound = if stiff(&scenario) {
            2e-8
        } else if jumps {
            5e-9
        } else {
            1e-10
        };
        assert!(share < bound, "{name}: {share:e}");
    }
}

/// Rows of a run that are looked at, at most.
const ROWS: usize = 2000;

/// As they are shipped, from beginning to end, steps, touch-downs and lift-offs included: whatever led to a state, the
/// accelerations there are those of the forces that are written.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn every_shipped_run_obeys_kanes_equations_with_the_written_forces_from_beginning_to_end() {
    let mut with_contact = 0;
    for name in shipped("forward") {
        let folder = scratch(&format!("equations-of-the-run-{name}"));
        let scenario = read(&name);
        let has_contact = scenario.contains_key("contact");
        run_as_it_is(&folder, scenario, "forward");
        let written = Written::read(&folder.join("run"));
        let a = written.accelerations(&folder.join("run"));
        let share = written.imbalance((0..a.len()).step_by(a.len().div_ceil(ROWS)), |k, joint| a[k][joint]);
        println!("{name}: {share:.1e} over {} rows", a.len());
        assert!(share < 1e-11, "{name}: {share:e}");
        if has_contact {
            with_contact += 1;
            assert!(written.contacts.iter().flatten().any(|(_, force)| *force != [0.0; 3]), "{name} is on the ground");
            let touches = |k: usize, i: usize| written.contacts[k][i].1 != [0.0; 3];
            let changes = |from: bool| {
                let rows = 1..written.contacts.len();
                let places = rows.flat_map(|k| (0..written.contacts[k].len()).map(move |i| (k, i)));
                places.filter(|&(k, i)| touches(k - 1, i) == from && touches(k, i) != from).count()
            };
            let (touch_downs, lift_offs) = (changes(false), changes(true));
            println!("{name}: {touch_downs} touch-downs, {lift_offs} lift-offs");
            // The hexapod stands all the time.
            let moves = touch_downs > 0 && lift_offs > 0;
            assert!(moves || name == "hexapod", "{name}: {touch_downs} touch-downs, {lift_offs} lift-offs");
        }
    }
    assert!(with_contact >= 4, "hexapod, parcel, quadruped and walking_biped");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_forces_of_every_shipped_motion_obey_kanes_equations() {
    for name in shipped("inverse") {
        let folder = scratch(&format!("equations-of-forces-{name}"));
        run(&folder, &name, "inverse");
        let written = Written::read(&folder.join("run"));
        let a = written.accelerations(&folder.join("run"));
        let share = written.imbalance((0..a.len()).step_by(STRIDE), |k, joint| a[k][joint]);
        println!("{name}: {share:.1e}");
        assert!(share < 1e-13, "{name}: {share:e}");
    }
}
