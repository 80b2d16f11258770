//! The four-bar of the ReDySim paper: its Figures 10 and 11, against references; its closure and energy with and
//! without projection; and what its functions cost.
//!
//! `cargo run --release --example fourbar`

mod common;

use std::f64::consts::TAU;

use common::figure::{Figure, Panel, joint_grid};
use common::loop_inverse::{LoopInverseRun, along_loops};
use common::loop_motion::{LoopMotion, peaks, record};
use common::loop_speed::{self, Turn};
use common::reference::Reference;
use common::table::{Table, digits, headline, remark, tiny};
use common::{Context, Failure, Outputs, column, instants};
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    Assembly, ClosedLoop, ClosedLoopSimulation, Integrator, Mechanism, Motion, Ode4, Ode5, Ode45, Stabilisation,
    ZeroTorque, redysim,
};

redysim! {
    /// Crank, rocker and coupler, in the vertical plane.
    pub struct Fourbar("../models/fourbar.toml");
}

const CRANK: [usize; 1] = [0];
/// Rows of the loop's residual: x and y of the cut.
const ROWS: usize = 2;
/// 45 turns a minute.
const SPEED: f64 = 0.75 * TAU;
/// The start as ReDySim ships it, to four digits.
const SHIPPED: [f64; 3] = [0.0, 0.9844, 4.3144];

fn main() -> Result<(), Failure> {
    let mut outputs = Outputs::of("fourbar")?;
    inverse_dynamics(&mut outputs)?;
    free_fall(&mut outputs)?;
    long_fall(&mut outputs)?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/fourbar.toml");
    let model = Model::load(path).context(|| format!("cannot read {path}"))?.model;
    let turn = Turn { actuated: &CRANK, guess: &SHIPPED, trajectory: crank, period: TAU / SPEED };
    loop_speed::report(&Fourbar, &Fourbar::OPS, &GenericMechanism::new(model), &turn)?;
    outputs.print();
    Ok(())
}

/// The crank's motion in Figure 10.
fn crank(t: f64) -> Motion<[f64; 1], [f64; 1]> {
    Motion { q: [SPEED * t], v: [SPEED], a: [0.0] }
}

/// Figure 10: the crank turns once at constant speed.
fn inverse_dynamics(outputs: &mut Outputs) -> Result<(), Failure> {
    let text = include_str!("../tests/reference/golden_octave_ID_Hoken_Fourbar.csv");
    let redysim = Reference::loop_forces("ReDySim", text, Fourbar::NV, CRANK.len())?;
    let mut t = instants(1.333, 1333);
    t.push(1.3333);
    let run = along_loops(&Fourbar, &CRANK, SHIPPED, &crank, t)?;
    headline("Four-bar, inverse dynamics: a turn of the crank at 45 rpm, 1.3333 s (Fig 10)");
    let mut table = Table::new(&["force", "peak\nN m, N", "max |Δ| to ReDySim,\n134 instants", "\nof peak"]);
    for (name, (peak, deviation)) in ["τ crank", "λ x", "λ y"].into_iter().zip(run.force_deviations(&redysim)) {
        table.row([name.to_owned(), digits(peak), tiny(deviation), tiny(deviation / peak)]);
    }
    table.print();
    remark(&format!("Largest deviation: {} of the force's peak.", tiny(run.worst(&redysim))));
    remark(&format!(
        "The loop is closed to {} m, and its {} rows are independent all along.",
        tiny(run.position_residual),
        run.rank
    ));
    outputs.picture("fig10_joint_motion", "what the crank makes the others do", &joint_motion(&run, &redysim))?;
    outputs.picture("fig10_crank_torque", "the crank's torque and λ, and ReDySim's", &forces(&run, &redysim))?;
    outputs.numbers("inverse_dynamics", "motion, torque and λ, each 1 ms", &run.csv())
}

fn joint_motion(run: &LoopInverseRun, reference: &Reference) -> Figure {
    joint_grid("angle", "deg", 1_f64.to_degrees(), &[run.series(&run.q)], &[reference.series(&reference.q)])
}

fn forces(run: &LoopInverseRun, reference: &Reference) -> Figure {
    let of_crank = (&run.tau, &reference.tau, 0, "Torque of the crank", "torque", "N m");
    let rows = [(0, "Force of the crank on the coupler, x"), (1, "Force of the crank on the coupler, y")];
    let of_rows = rows.map(|(row, title)| (&run.lambda, &reference.lambda, row, title, "λ", "N"));
    let panels = std::iter::once(of_crank).chain(of_rows).map(|(ours, theirs, index, title, quantity, unit)| {
        Panel::new(title, quantity, unit).line("redysim", 1, &run.t, &column(ours, index)).circles(
            reference.by,
            &reference.t,
            &column(theirs, index),
        )
    });
    Figure { columns: 1, panels: panels.collect(), shared_legend: true }
}

/// Figure 11: the four-bar is let go. The paper does not state from where: at rest, or at the speeds that ship with it.
fn free_fall(outputs: &mut Outputs) -> Result<(), Failure> {
    let text = include_str!("../tests/reference/golden_ref_hoken_rest_consistent.csv");
    let rest = Fall::new("from rest", [0.0; 3], text)?;
    let text = include_str!("../tests/reference/golden_ref_hoken_spin_consistent.csv");
    let spinning = Fall::new("from the shipped speeds", [4.7124, 1.4045, 0.0], text)?;
    let (falls, mut lines, mut circles) = ([rest, spinning], Vec::new(), Vec::new());
    let runs = [falls[0].run()?, falls[1].run()?];
    for (fall, run) in falls.iter().zip(&runs) {
        lines.push(run.series(fall.name, &run.q));
        circles.push(fall.reference.series(&fall.reference.q));
    }
    let angles = joint_grid("angle", "deg", 1_f64.to_degrees(), &lines, &circles);
    outputs.picture("fig11_free_fall", "joint angles, and those in quad precision", &angles)?;
    outputs.picture("free_fall_lambda", "λ, and that in quad precision", &multipliers(&falls, &runs))?;
    outputs.numbers("free_fall_rest", "motion and λ, each 1 ms, from rest", &runs[0].csv(&[]))?;
    outputs.numbers("free_fall_spinning", "the same from the shipped speeds", &runs[1].csv(&[]))
}

fn multipliers(falls: &[Fall], runs: &[LoopMotion]) -> Figure {
    let titles = ["Force of the crank on the coupler, x", "Force of the crank on the coupler, y"];
    let panels = titles.into_iter().enumerate().map(|(row, title)| {
        let lines = (1..).zip(falls.iter().zip(runs));
        let panel = lines.fold(Panel::new(title, "λ", "N"), |panel, (colour, (fall, run))| {
            panel.line(fall.name, colour, &run.t, &column(&run.lambda, row))
        });
        falls
            .iter()
            .map(|fall| &fall.reference)
            .fold(panel, |panel, reference| panel.circles(reference.by, &reference.t, &column(&reference.lambda, row)))
    });
    Figure { columns: 1, panels: panels.collect(), shared_legend: true }
}

/// A free fall and its reference.
struct Fall {
    name: &'static str,
    start: Assembly<f64, [f64; 3], [f64; 3]>,
    reference: Reference,
}

impl Fall {
    /// The shipped start, closed by assembly with the crank held.
    fn new(name: &'static str, v: [f64; 3], text: &str) -> Result<Self, Failure> {
        let start = ClosedLoop::new(&Fourbar).assemble(&SHIPPED, &v, &CRANK)?;
        let reference = Reference::loop_motion("quad precision", text, Fourbar::NV, ROWS)?.until(0.68);
        Ok(Fall { name, start, reference })
    }

    /// Falls by several methods, with projection and without, prints what each takes and gives, and returns the best.
    fn run(&self) -> Result<LoopMotion, Failure> {
        headline(&format!("Four-bar, free fall of 0.68 s {} (Fig 11)", self.name));
        let Assembly { largest_displacement, position_residual, .. } = self.start;
        let joint = Fourbar.velocity_name(self.start.velocity).unwrap_or("");
        let moved = tiny(largest_displacement.abs());
        remark(&format!(
            "Assembly moves {joint} by {moved} rad, the most of all, and leaves {} m open.",
            tiny(position_residual)
        ));
        let mut table = Table::new(&[
            "method",
            "steps\n",
            "time\nms",
            "max |Δq|\nrad",
            "max |Δv|\nrad/s",
            "max |Δλ|\nN",
            "open\nm",
            "energy drift\nJ",
        ]);
        let tight = Ode45::new().rtol(3e-14).atol(1e-15);
        let best = self.by("Ode45, rtol 3e-14, projection", &tight, Stabilisation::Projection, &mut table)?;
        self.by("Ode45, rtol 3e-14, plain index 1", &tight, Stabilisation::None, &mut table)?;
        let shipped = Ode45::new().rtol(1e-4).atol(1e-6);
        self.by("Ode45, ReDySim's 1e-4, projection", &shipped, Stabilisation::Projection, &mut table)?;
        self.by("Ode45, ReDySim's 1e-4, plain index 1", &shipped, Stabilisation::None, &mut table)?;
        self.by("Ode5, 1 ms, projection", &Ode5::new(1e-3), Stabilisation::Projection, &mut table)?;
        self.by("Ode5, 1 ms, plain index 1", &Ode5::new(1e-3), Stabilisation::None, &mut table)?;
        table.print();
        remark("Deviations: at 69 instants, to quad precision. Open, and drift: the worst at the end of any step.");
        Ok(best)
    }

    fn by(
        &self,
        method: &'static str,
        integrator: &impl Integrator<f64>,
        stabilisation: Stabilisation<f64>,
        table: &mut Table,
    ) -> Result<LoopMotion, Failure> {
        let mut simulation =
            ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque).stabilisation(stabilisation);
        let start = simulation.assembled(&self.start);
        let run = record(method, &mut simulation, integrator, start, &instants(0.68, 680))?;
        let deviations = run.deviations(&self.reference);
        let time = format!("{:.2}", 1e3 * run.seconds);
        let numbers = deviations.into_iter().chain([run.worst_position_residual(), run.worst_drift()]).map(tiny);
        table.row([method.to_owned(), run.statistics.steps.to_string(), time].into_iter().chain(numbers));
        Ok(run)
    }
}

/// What projection is for: ten seconds, with it and without.
fn long_fall(outputs: &mut Outputs) -> Result<(), Failure> {
    headline("Four-bar, free motion of 10 s from rest: Ode4, steps of 0.1 ms");
    let start = ClosedLoop::new(&Fourbar).assemble(&SHIPPED, &[0.0; 3], &CRANK)?;
    let mut table = Table::new(&["", "steps\n", "time\ns", "open\nm", "energy drift\nJ"]);
    let mut open = Panel::new("Position residual of the loop", "position residual", "m").logarithmic();
    let mut drift = Panel::new("Drift of the energy", "drift", "J").logarithmic();
    let kinds = [("projection", Stabilisation::Projection), ("plain index 1", Stabilisation::None)];
    for (colour, (name, stabilisation)) in (1..).zip(kinds) {
        let mut simulation =
            ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque).stabilisation(stabilisation);
        let start = simulation.assembled(&start);
        let run = record(name, &mut simulation, &Ode4::new(1e-4), start, &instants(10.0, 1000))?;
        let (steps, time) = (run.statistics.steps.to_string(), format!("{:.2}", run.seconds));
        table.row([name.to_owned(), steps, time, tiny(run.worst_position_residual()), tiny(run.worst_drift())]);
        let (t, residual) = peaks(&run.steps.t, &run.steps.position_residual);
        open = open.line(name, colour, &t, &residual);
        let (t, energy) = peaks(&run.steps.t, &run.steps.drift());
        drift = drift.line(name, colour, &t, &energy);
    }
    table.print();
    let figure = Figure { columns: 1, panels: vec![open, drift], shared_legend: true };
    outputs.picture(
        "closure_and_energy",
        "what stays open and what drifts in 10 s, with projection and without",
        &figure,
    )
}
