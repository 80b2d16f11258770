//! KR5 under computed torque at 1 kHz: it starts beside the motion it should follow, and is led onto it.
//!
//! The controller is discrete: every millisecond it takes a sample and sets torques, which stay until the next one. Two
//! controllers drive the same robot. One knows it exactly; the other takes it for the robot of the paper's Table 2,
//! whose masses, centres of mass and inertias are different.
//!
//! `cargo run --release --example controller`

mod common;

use std::f64::consts::FRAC_PI_3;
use std::hint::black_box;
use std::time::Instant;

use common::csv::{Csv, headers};
use common::figure::{Figure, Panel, joint_grid};
use common::progress::Progress;
use common::speed::median;
use common::table::{Table, headline, remark};
use common::{Context, Failure, Outputs, Rows, Series, column, instants, peak};
use redysim::{ComputedTorque, Cycloid, ForwardSimulation, Integrator, Ode45, TorqueLaw, Trajectory, redysim};

redysim! {
    /// The robot.
    pub struct Kr5("../models/kr5.toml");
}

redysim! {
    /// The robot as Table 2 of the paper has it.
    #[allow(deprecated)] // the triangle inequality of link 6 is Table 2's own
    pub struct Kr5Table2("../models/kr5_table2.toml");
}

type Joints = [f64; Kr5::NV];
type Path = Cycloid<f64, Joints>;

/// Time between samples, s, and their number.
const PERIOD: f64 = 1e-3;
const SAMPLES: usize = 1000;
/// Errors die out as exp(−20 t), critically damped: Kp = 20², 1/s², and Kd = 2·20, 1/s.
const DECAY: f64 = 20.0;
const KP: Joints = [DECAY * DECAY; Kr5::NV];
const KD: Joints = [2.0 * DECAY; Kr5::NV];
/// The robot's start, where it should rest at q = 0: 5° aside in every joint, rad, and not at rest, rad/s.
const START: Joints = [0.087_266_462_599_716_48; Kr5::NV];
const START_VELOCITY: Joints = [0.0, 0.4, 0.8, -0.4, -0.8, -1.2];

fn main() -> Result<(), Failure> {
    let path = Cycloid::new([0.0; Kr5::NV], [FRAC_PI_3; Kr5::NV], 1.0)?;
    let mut exact = controller(&Kr5, path);
    let mut approximate = controller(&Kr5Table2, path);
    let runs = [Run::of("exact model", &mut exact, &path)?, Run::of("Table 2's model", &mut approximate, &path)?];
    report(&runs);
    let cycle = nanoseconds_per_cycle(&mut exact, &runs[0]);
    remark("What is left with the exact model is the sampling's: half the period leaves half of it.");
    remark(&format!(
        "One control cycle takes {cycle:.0} ns, {:.3} % of the period of {} ms.",
        1e-7 * cycle / PERIOD,
        1e3 * PERIOD
    ));
    let mut outputs = Outputs::of("controller")?;
    outputs.picture("tracking", "joint angles, and those to follow", &tracking_figure(&runs, &path))?;
    outputs.picture("error", "tracking errors", &error_figure(&runs))?;
    outputs.numbers("exact_model", "samples, errors and torques with the exact model", &runs[0].csv())?;
    outputs.numbers("table2_model", "the same with Table 2's model", &runs[1].csv())?;
    outputs.print();
    Ok(())
}

/// The controller that takes the robot for `model`.
fn controller<M>(model: &M, trajectory: Path) -> ComputedTorque<'_, M, Path, Joints> {
    ComputedTorque { mechanism: model, trajectory, kp: KP, kd: KD }
}

/// What the robot did under one controller, at every sample.
struct Run {
    name: &'static str,
    t: Vec<f64>,
    q: Vec<Joints>,
    v: Vec<Joints>,
    /// Desired minus true coordinates, rad.
    error: Rows,
    tau: Vec<Joints>,
}

impl Run {
    /// Runs the robot under the controller.
    fn of(name: &'static str, controller: &mut impl TorqueLaw<f64, Kr5>, path: &Path) -> Result<Self, Failure> {
        let mut run = Run {
            name,
            t: instants(PERIOD * SAMPLES as f64, SAMPLES),
            q: vec![],
            v: vec![],
            error: vec![],
            tau: vec![],
        };
        let (mut q, mut v) = (START, START_VELOCITY);
        let mut progress = Progress::new(name, SAMPLES);
        for &t in &run.t {
            let tau = controller.torque(&Kr5, t, &q, &v);
            run.error.push(path.at(t).q.iter().zip(&q).map(|(desired, q)| desired - q).collect());
            run.q.push(q);
            run.v.push(v);
            run.tau.push(tau);
            (q, v) = hold(t, &q, &v, &tau).context(|| format!("robot with {name}"))?;
            progress.advance();
        }
        Ok(run)
    }

    /// The largest error of any joint at every sample, deg.
    fn largest_error(&self) -> Vec<f64> {
        self.error.iter().map(|row| peak(row.iter().copied()).to_degrees()).collect()
    }

    fn csv(&self) -> Csv {
        let quantities = [("q", "rad"), ("v", "rad/s"), ("tau", "N m")];
        let mut columns = headers(Kr5::NV, &quantities);
        columns.extend((1..=Kr5::NV).map(|joint| format!("error{joint} [rad]")));
        let mut csv = Csv::new(&columns);
        for (k, &t) in self.t.iter().enumerate() {
            let joints = self.q[k].iter().chain(&self.v[k]).chain(&self.tau[k]).chain(&self.error[k]);
            csv.row(std::iter::once(t).chain(joints.copied()));
        }
        csv
    }
}

/// The robot one period later, under torques that stay as they are. The tolerances leave errors far below those of
/// tracking.
fn hold(t: f64, q: &Joints, v: &Joints, tau: &Joints) -> Result<(Joints, Joints), redysim::IntegrationError<f64>> {
    let mut robot = ForwardSimulation::new(&Kr5, |_: f64, _: &Joints, _: &Joints| *tau);
    let method = Ode45::new().rtol(1e-10).atol(1e-12).max_step(PERIOD);
    let start = robot.state(q, v);
    let end = method.integrate(&mut robot, (t, t + PERIOD), start)?;
    let parts = robot.split(&end.y);
    Ok((parts.q, parts.v))
}

/// The error that theory gives a continuous controller with the exact model: ë + Kd ė + Kp e = 0, critically damped.
/// The largest of any joint, deg.
fn theoretical_error(t: f64) -> f64 {
    let of_joint = |joint: usize| {
        let (e, rate) = (-START[joint], -START_VELOCITY[joint]);
        (e + (rate + DECAY * e) * t) * (-DECAY * t).exp()
    };
    peak((0..Kr5::NV).map(of_joint)).to_degrees()
}

/// Prints how large the errors are, and when.
fn report(runs: &[Run; 2]) {
    headline("KR5 under computed torque, 1 kHz, from 5° beside the path: tracking error |q_d − q| in deg");
    let mut table = Table::new(&[
        "\njoint",
        "start\n",
        "exact model\n0.25 s",
        "\n0.5 s",
        "\nend",
        "\nRMS",
        "Table 2's\n0.25 s",
        "\n0.5 s",
        "\nend",
        "\nRMS",
    ]);
    for joint in 0..Kr5::NV {
        let start = runs[0].error[0][joint].to_degrees().abs();
        let cells = runs.iter().flat_map(|run| summary(&column(&run.error, joint)));
        table.row([(joint + 1).to_string(), format!("{start:.1}")].into_iter().chain(cells));
    }
    table.print();
}

/// Errors after 0.25 s, after 0.5 s and at the end, and the root of the mean square over the whole run.
fn summary(error: &[f64]) -> [String; 4] {
    let square: f64 = error.iter().map(|error| error * error).sum();
    let root_mean_square = (square / error.len() as f64).sqrt();
    [error[SAMPLES / 4], error[SAMPLES / 2], error[SAMPLES], root_mean_square]
        .map(|error| format!("{:.4}", error.to_degrees().abs()))
}

/// Time per control cycle, from the sample to the torques: the median of passes through the samples of a run.
fn nanoseconds_per_cycle(controller: &mut impl TorqueLaw<f64, Kr5>, run: &Run) -> f64 {
    let mut pass = || {
        let begun = Instant::now();
        for ((&t, q), v) in run.t.iter().zip(&run.q).zip(&run.v) {
            black_box(controller.torque(&Kr5, black_box(t), black_box(q), black_box(v)));
        }
        begun.elapsed().as_nanos() as f64 / run.t.len() as f64
    };
    median((0..101).map(|_| pass()).collect())
}

fn tracking_figure(runs: &[Run; 2], path: &Path) -> Figure {
    let [exact, approximate] = runs.each_ref().map(|run| run.q.iter().map(|q| q.to_vec()).collect::<Rows>());
    let desired: Rows = runs[0].t.iter().map(|&t| path.at(t).q.to_vec()).collect();
    let series = |name, rows| Series { name, t: &runs[0].t, rows };
    let lines = [series(runs[0].name, &exact), series(runs[1].name, &approximate)];
    joint_grid("angle", "deg", 1_f64.to_degrees(), &lines, &[series("to follow", &desired)])
}

fn error_figure(runs: &[Run; 2]) -> Figure {
    let of_joints = |run: &Run| {
        let degrees: Rows = run.error.iter().map(|row| row.iter().map(|error| error.to_degrees()).collect()).collect();
        let mut title = run.name.to_owned();
        title[..1].make_ascii_uppercase();
        Panel::new(title, "error", "deg").joints(&run.t, &degrees)
    };
    let t = &runs[0].t;
    let theory: Vec<f64> = t.iter().copied().map(theoretical_error).collect();
    let largest = Panel::new("Largest error", "|error|", "deg")
        .logarithmic()
        .line(runs[0].name, 1, t, &runs[0].largest_error())
        .line(runs[1].name, 2, t, &runs[1].largest_error())
        .circles("continuous control with the exact model", t, &theory);
    Figure { columns: 1, panels: vec![of_joints(&runs[0]), of_joints(&runs[1]), largest], shared_legend: false }
}
