//! KR5 picks up 5 kg, which only the program knows: mass, centre of mass and inertia of its last link are run-time
//! parameters. Torques with the right and with the wrong payload, and how well a controller follows with each.
//!
//! `cargo run --release --example payload`

mod common;

use std::f64::consts::FRAC_PI_3;

use common::csv::{Csv, headers};
use common::figure::joint_grid;
use common::table::{Table, headline, remark};
use common::{Context, Failure, Outputs, Rows, Series, column, instants, peak};
use redysim::{ComputedTorque, Cycloid, ForwardSimulation, Integrator, Ode45, TorqueLaw, Trajectory, redysim};

redysim! {
    /// The KUKA KR5, whose last link is given at run time.
    pub struct Kr5("../models/kr5.toml", parameters = ["link6.mass", "link6.com", "link6.inertia"]);
}

type Joints = [f64; Kr5::NV];
type Path = Cycloid<f64, Joints>;

/// Time between samples, s, and their number.
const PERIOD: f64 = 1e-3;
const SAMPLES: usize = 1000;
/// Kp, 1/s², and Kd, 1/s: errors of the exact model die out as exp(−20 t).
const KP: Joints = [400.0; Kr5::NV];
const KD: Joints = [40.0; Kr5::NV];

/// The robot with a cube of steel at its flange: 5 kg, with its centre of mass 60 mm ahead.
fn loaded() -> Result<Kr5, Failure> {
    const MASS: f64 = 5.0;
    const SIDE: f64 = 0.086;
    const AHEAD: [f64; 3] = [0.0, 0.0, 0.06];
    let [own, x, y, z, xx, yy, zz, xy, yz, xz] = Kr5::PARAMETERS;
    let (com, mass) = ([x, y, z], own + MASS);
    let together: [f64; 3] = std::array::from_fn(|i| (own * com[i] + MASS * AHEAD[i]) / mass);
    // Steiner's theorem, from each body's centre of mass to that of both.
    let moved = |m: f64, from: [f64; 3], i: usize, j: usize| {
        let d: [f64; 3] = std::array::from_fn(|k| from[k] - together[k]);
        let square: f64 = d.iter().map(|d| d * d).sum();
        m * (if i == j { square } else { 0.0 } - d[i] * d[j])
    };
    let both = |i: usize, j: usize| moved(own, com, i, j) + moved(MASS, AHEAD, i, j);
    let cube = MASS * SIDE * SIDE / 6.0;
    let [cx, cy, cz] = together;
    let parameters = [
        mass,
        cx,
        cy,
        cz,
        xx + cube + both(0, 0),
        yy + cube + both(1, 1),
        zz + cube + both(2, 2),
        xy + both(0, 1),
        yz + both(1, 2),
        xz + both(0, 2),
    ];
    Kr5::try_new(&parameters).context(|| "KR5 with its load".to_string())
}

fn main() -> Result<(), Failure> {
    let path = Cycloid::new([0.0; Kr5::NQ], [FRAC_PI_3; Kr5::NQ], 1.0)?;
    let (empty, loaded) = (Kr5::default(), loaded()?);
    let runs = [Run::of("right payload", &loaded, &loaded, path)?, Run::of("wrong payload", &empty, &loaded, path)?];
    headline("KR5 with 5 kg at its flange: torques along the path, and tracking errors under computed torque at 1 kHz");
    let mut table = Table::new(&[
        "\njoint",
        "largest torque, N m\nright payload",
        "\nwrong payload",
        "largest error, deg\nright payload",
        "\nwrong payload",
    ]);
    for joint in 0..Kr5::NV {
        let torque = |run: &Run| format!("{:.1}", peak(column(&run.feedforward, joint).into_iter()));
        let error = |run: &Run| format!("{:.4}", peak(column(&run.error, joint).into_iter()).to_degrees());
        let [right, wrong] = &runs;
        table.row([(joint + 1).to_string(), torque(right), torque(wrong), error(right), error(wrong)]);
    }
    table.print();
    remark("The robot is the same type in both: its numbers are computed once, in `Kr5::new`.");
    let mut outputs = Outputs::of("payload")?;
    let series = |run: &'static str, t, rows| Series { name: run, t, rows };
    let [right, wrong] = &runs;
    let of = |rows: fn(&Run) -> &Rows| {
        [series(right.name, &right.t, rows(right)), series(wrong.name, &wrong.t, rows(wrong))]
    };
    let torques = joint_grid("torque", "N m", 1.0, &of(|run| &run.feedforward), &[]);
    outputs.picture("torques", "the torques that the path takes", &torques)?;
    let errors = joint_grid("error", "deg", 1_f64.to_degrees(), &of(|run| &run.error), &[]);
    outputs.picture("errors", "tracking errors", &errors)?;
    for run in &runs {
        outputs.numbers(&run.name.replace(' ', "_"), "torques and tracking errors, each 1 ms", &run.csv())?;
    }
    outputs.print();
    Ok(())
}

/// What the loaded robot does under a controller that takes it for `model`.
struct Run {
    name: &'static str,
    t: Vec<f64>,
    /// The torques that the path takes, N m.
    feedforward: Rows,
    /// Desired minus true coordinates, rad.
    error: Rows,
}

impl Run {
    fn of(name: &'static str, model: &Kr5, robot: &Kr5, path: Path) -> Result<Self, Failure> {
        let mut controller = ComputedTorque { mechanism: model, trajectory: path, kp: KP, kd: KD };
        let mut run = Run { name, t: instants(PERIOD * SAMPLES as f64, SAMPLES), feedforward: vec![], error: vec![] };
        let start = path.at(0.0);
        let (mut q, mut v): (Joints, Joints) = (start.q, start.v);
        for &t in &run.t {
            let desired = path.at(t);
            run.feedforward.push(model.inverse_dynamics(&desired.q, &desired.v, &desired.a).to_vec());
            run.error.push(desired.q.iter().zip(&q).map(|(desired, q)| desired - q).collect());
            let tau = controller.torque(robot, t, &q, &v);
            let mut held = ForwardSimulation::new(robot, |_: f64, _: &Joints, _: &Joints| tau);
            let method = Ode45::new().rtol(1e-10).atol(1e-12).max_step(PERIOD);
            let state = held.state(&q, &v);
            let end = method.integrate(&mut held, (t, t + PERIOD), state).context(|| name.to_string())?;
            let parts = held.split(&end.y);
            (q, v) = (parts.q, parts.v);
        }
        Ok(run)
    }

    fn csv(&self) -> Csv {
        let mut csv = Csv::new(&headers(Kr5::NV, &[("tau", "N m"), ("error", "rad")]));
        for (k, &t) in self.t.iter().enumerate() {
            csv.row(std::iter::once(t).chain(self.feedforward[k].iter().chain(&self.error[k]).copied()));
        }
        csv
    }
}
