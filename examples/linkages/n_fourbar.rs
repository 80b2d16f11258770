//! The N-four-bar (IFToMM A02): windows in a row, which lose rank whenever their cranks lie flat, and an exact answer.

use std::f64::consts::{FRAC_PI_2, PI};

use redysim::generic::{GenericMechanism, Model};
use redysim::{ClosedLoop, ClosedLoopSimulation, Ode4, Stabilisation, ZeroTorque, redysim};

use super::study::{Plan, Studies};
use crate::common::figure::{Figure, Panel};
use crate::common::loop_motion::{LoopMotion, peaks, record};
use crate::common::reference::read;
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Context, Failure, Outputs, instants, peak};

redysim! {
    /// Two windows: three cranks, two couplers.
    pub struct NFourbar2("../../models/n_fourbar_2.toml");
}

const STEPS: [(f64, &str); 5] = [(1e-2, "10 ms"), (3e-3, "3 ms"), (1e-3, "1 ms"), (3e-4, "0.3 ms"), (1e-4, "0.1 ms")];

/// The start: upright, the tips at 1 m/s towards +x; a crank, then pairs of coupler and crank.
fn rates(joint: usize) -> f64 {
    if joint.is_multiple_of(2) { -1.0 } else { 1.0 }
}

/// Moves two windows, compiled, and forty, generic, for 10 s.
pub fn move_both(studies: &mut Studies) -> Result<(), Failure> {
    let (law, t) = (ZeroTorque, || instants(10.0, 1000));
    let v = std::array::from_fn(rates);
    let plan = Plan { name: "n_fourbar_2", mechanism: &NFourbar2, law, q: [0.0; 5], v, held: &[], t: t() };
    studies.run(plan, &Ode4::new(1e-3))?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/n_fourbar_40.toml");
    let forty = GenericMechanism::new(Model::load(path).context(|| format!("cannot read {path}"))?.model);
    let (q, v) = (vec![0.0; 81], (0..81).map(rates).collect());
    let plan = Plan { name: "n_fourbar_40", mechanism: &forty, law, q, v, held: &[], t: t() };
    studies.run(plan, &Ode4::new(1e-2))
}

/// Against the exact motion.
pub fn compare(studies: &Studies, outputs: &mut Outputs) -> Result<(), Failure> {
    headline("N-four-bar, free motion of 10 s through singular positions: the tip B0 against the exact one");
    let mut table =
        Table::new(&["", "steps\n", "time\ns", "|ΔB0| at 10 s\nm", "worst |ΔB0|\nm", "open\nm", "drift\nJ"]);
    let exact = [exact(2)?, exact(40)?];
    let mut error = Panel::new("Distance of B0 from where it should be", "distance", "m").logarithmic();
    for (colour, (size, name)) in (1..).zip(STEPS) {
        let run = two_windows("n_fourbar_2", size, Stabilisation::Projection)?;
        let distances = row(&mut table, &format!("N = 2, Ode4, {name}"), &run, &exact[0]);
        let (t, distances) = peaks(&run.t, &distances);
        error = error.line(name, colour, &t, &distances);
    }
    let plain = "N = 2, Ode4, 1 ms, plain index 1";
    let failed = match two_windows(plain, 1e-3, Stabilisation::None) {
        Ok(run) => {
            row(&mut table, plain, &run, &exact[0]);
            None
        }
        Err(Failure(reason)) => Some(reason),
    };
    row(&mut table, "N = 40, generic, Ode4, 10 ms", &studies.get("n_fourbar_40")?.motion, &exact[1]);
    table.print();
    if let Some(reason) = failed {
        remark("Without projection it fails at a singular position:");
        remark(&reason);
    }
    let doubts = exact.each_ref().map(|exact| tiny(exact.doubt));
    remark(&format!("Exact: by elliptic functions, within {} and {} m of the references.", doubts[0], doubts[1]));
    let motion = &studies.get("n_fourbar_2")?.motion;
    let heights: Vec<f64> = motion.q.iter().map(|q| tip(-q[0])[1]).collect();
    let path = Panel::new("B0 of two windows", "height", "m").line("redysim, 1 ms", 1, &motion.t, &heights);
    let (t, heights): (Vec<_>, Vec<_>) = known(2)?.into_iter().map(|(t, tip)| (t, tip[1])).unzip();
    let path = path.circles("exact", &t, &heights);
    let figure = Figure { columns: 1, panels: vec![path, error], shared_legend: false };
    outputs.picture("n_fourbar_2", "the tip's way, and its error for several steps", &figure)
}

/// Ten seconds of two windows.
fn two_windows(what: &'static str, step: f64, stabilisation: Stabilisation<f64>) -> Result<LoopMotion, Failure> {
    let mut simulation =
        ClosedLoopSimulation::new(ClosedLoop::new(&NFourbar2), ZeroTorque).stabilisation(stabilisation);
    let start = simulation.start(&[0.0; 5], &std::array::from_fn(rates))?;
    record(what, &mut simulation, &Ode4::new(step), start, &instants(10.0, 1000))
}

/// Adds a row, and returns how far the tip is from the exact one at each instant.
fn row(table: &mut Table, name: &str, run: &LoopMotion, exact: &Exact) -> Vec<f64> {
    let distances: Vec<f64> =
        run.q.iter().zip(&exact.alpha).map(|(q, &alpha)| distance(tip(-q[0]), tip(alpha))).collect();
    let (steps, time) = (run.statistics.steps.to_string(), format!("{:.3}", run.seconds));
    let last = distances[distances.len() - 1];
    let numbers = [last, peak(distances.iter().copied()), run.worst_position_residual(), run.worst_drift()].map(tiny);
    table.row([name.to_owned(), steps, time].into_iter().chain(numbers));
    distances
}

/// B0 with the cranks turned by `alpha` from upright towards +x.
fn tip(alpha: f64) -> [f64; 2] {
    let (x, y) = alpha.sin_cos();
    [x, y]
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The exact motion for 10 s.
struct Exact {
    /// α, each 10 ms.
    alpha: Vec<f64>,
    /// How far its tips are from the known ones, m.
    doubt: f64,
}

/// While its cranks stay parallel, the mechanism is the pendulum α̈ = c sin α, c = g ((N+1)/2 + N) / ((N+1)/3 + N),
/// which turns over: with 1 + 4 c = w² and k² = 4 c / w², (α + π)/2 is the amplitude of w t/2 + K(k).
fn exact(windows: u32) -> Result<Exact, Failure> {
    let n = f64::from(windows);
    let c = 9.81 * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n);
    let w = (1.0 + 4.0 * c).sqrt();
    let alpha = |t: f64| 2.0 * amplitude(0.5 * w * t, 1.0 / w) - PI;
    let known = known(windows)?;
    let doubt = peak(known.iter().map(|&(t, exact)| distance(tip(alpha(t)), exact)));
    Ok(Exact { alpha: instants(10.0, 1000).into_iter().map(alpha).collect(), doubt })
}

/// am(u + K), by the arithmetic-geometric mean of 1 and k' = √(1 − k²) (Abramowitz and Stegun, § 16.4).
fn amplitude(u: f64, complement: f64) -> f64 {
    let (mut a, mut b, mut ratios) = (1.0_f64, complement, Vec::new());
    while ratios.last().is_none_or(|&ratio| ratio > 1e-17) && ratios.len() < 8 {
        let half = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        ratios.push(half / a);
    }
    let doubled = 2_f64.powi(ratios.len() as i32);
    // K = π/(2 a).
    let start = doubled * (a * u + FRAC_PI_2);
    ratios.iter().rev().fold(start, |phi, ratio| 0.5 * (phi + (ratio * phi.sin()).asin()))
}

/// Where B0 is at some times, by elliptic functions.
fn known(windows: u32) -> Result<Vec<(f64, [f64; 2])>, Failure> {
    let text = include_str!("../../tests/reference/exact_n_fourbar.csv");
    let rows = read("elliptic functions", text, 4)?.into_iter();
    let rows = rows.filter(|row| row[0] == f64::from(windows) && row[1] <= 10.0);
    Ok(rows.map(|row| (row[1], [row[2], row[3]])).collect())
}
