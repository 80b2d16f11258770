//! Free fall of a mechanism: no torques, from rest.

use std::time::Instant;

use redysim::{Energy, ForwardSimulation, Integrator, Ode5, Ode45, Statistics, TreeDynamics, ZeroTorque, uniform};

use super::compare::deviations;
use super::csv::{Csv, headers};
use super::figure::{Figure, Panel};
use super::reference::Reference;
use super::speed::median;
use super::table::{Table, headline, remark, tiny};
use super::{Context, Failure, Rows, Series, peak};

/// A free fall by one method.
pub struct FreeFall {
    /// The method and its settings.
    pub method: &'static str,
    /// The instants, s.
    pub t: Vec<f64>,
    /// Coordinates, rad, and velocities, rad/s.
    pub q: Rows,
    pub v: Rows,
    pub energy: Vec<Energy<f64>>,
    statistics: Statistics,
    milliseconds: f64,
}

/// The same free fall from rest at `start` by several methods, the most accurate first, at the instants `t`.
pub fn by_several_methods<M>(mechanism: &M, start: &M::Coordinates, t: &[f64]) -> Result<Vec<FreeFall>, Failure>
where
    M: TreeDynamics<f64>,
{
    let tight = Ode45::new().rtol(3e-14).atol(1e-15);
    let shipped = Ode45::new().rtol(1e-4).atol(1e-6);
    Ok(vec![
        free_fall("Ode45, rtol 3e-14, atol 1e-15", &tight, mechanism, start, t)?,
        free_fall("Ode45, ReDySim's 1e-4 and 1e-6", &shipped, mechanism, start, t)?,
        free_fall("Ode5, steps of 1 ms", &Ode5::new(1e-3), mechanism, start, t)?,
    ])
}

fn free_fall<M, I>(
    method: &'static str,
    integrator: &I,
    mechanism: &M,
    start: &M::Coordinates,
    t: &[f64],
) -> Result<FreeFall, Failure>
where
    M: TreeDynamics<f64>,
    I: Integrator<f64>,
{
    let mut simulation = ForwardSimulation::new(mechanism, ZeroTorque);
    let state = simulation.state(start, &uniform(mechanism, 0.0));
    let interval = (t[0], t[t.len() - 1]);
    let mut states = Vec::new();
    let times = t.iter().copied();
    let solution = integrator.solve(&mut simulation, interval, state.clone(), times, |_, y| states.push(y.clone()));
    let statistics = solution.context(|| format!("free fall by {method}"))?.statistics;
    let mut durations = Vec::new();
    for _ in 0..5 {
        let begun = Instant::now();
        integrator.integrate(&mut simulation, interval, state.clone()).context(|| format!("free fall by {method}"))?;
        durations.push(1e3 * begun.elapsed().as_secs_f64());
    }
    let parts = states.iter().map(|state| simulation.split(state));
    let (q, (v, energy)) = parts
        .map(|part| {
            let energy = mechanism.energy(&part.q, &part.v);
            (part.q.as_ref().to_vec(), (part.v.as_ref().to_vec(), energy))
        })
        .unzip();
    Ok(FreeFall { method, t: t.to_vec(), q, v, energy, statistics, milliseconds: median(durations) })
}

impl FreeFall {
    /// The joint angles under a name.
    pub fn angles<'a>(&'a self, name: &'a str) -> Series<'a> {
        Series { name, t: &self.t, rows: &self.q }
    }

    fn velocities(&self) -> Series<'_> {
        Series { name: self.method, t: &self.t, rows: &self.v }
    }

    /// Change of the total energy since the start, J.
    fn drift(&self) -> Vec<f64> {
        self.energy.iter().map(|energy| energy.total() - self.energy[0].total()).collect()
    }

    /// Prints, for each joint, the end and the largest deviations from the reference.
    pub fn report(&self, title: &str, reference: &Reference) {
        headline(title);
        let (q, instants) = deviations(self.angles(self.method), reference.series(&reference.q));
        let (v, _) = deviations(self.velocities(), reference.series(&reference.v));
        let mut table =
            Table::new(&["joint", "q at the end\ndeg", "v at the end\ndeg/s", "max |Δq|\nrad", "max |Δv|\nrad/s"]);
        let last = self.t.len() - 1;
        for joint in 0..q.len() {
            let end = [self.q[last][joint], self.v[last][joint]].map(|value| format!("{:.6}", value.to_degrees()));
            table.row([(joint + 1).to_string()].into_iter().chain(end).chain([tiny(q[joint]), tiny(v[joint])]));
        }
        table.print();
        remark(&format!("By {}. Deviations: at {instants} instants, to {}.", self.method, reference.by));
    }

    /// All numbers of the run.
    pub fn csv(&self) -> Csv {
        let mut columns = headers(self.q[0].len(), &[("q", "rad"), ("v", "rad/s")]);
        columns.extend(["kinetic energy [J]", "potential energy [J]"].map(str::to_owned));
        let mut csv = Csv::new(&columns);
        for (k, &t) in self.t.iter().enumerate() {
            let joints = self.q[k].iter().chain(&self.v[k]).copied();
            let energies = [self.energy[k].kinetic, self.energy[k].potential];
            csv.row(std::iter::once(t).chain(joints).chain(energies));
        }
        csv
    }

    /// Energies, and how well their sum is kept.
    pub fn energy_figure(&self) -> Figure {
        let of = |part: fn(&Energy<f64>) -> f64| self.energy.iter().map(part).collect::<Vec<_>>();
        let energies = Panel::new("Energy", "energy", "J")
            .line("kinetic", 1, &self.t, &of(|energy| energy.kinetic))
            .line("potential", 2, &self.t, &of(|energy| energy.potential))
            .line("total", 0, &self.t, &of(Energy::total));
        let drift = Panel::new("Change of the total energy since the start", "change", "J")
            .line("", 0, &self.t, &self.drift())
            .prefixed();
        Figure { columns: 1, panels: vec![energies, drift], shared_legend: false }
    }
}

/// Prints what each method takes and gives.
pub fn report_methods(runs: &[FreeFall], reference: &Reference) {
    let mut table = Table::new(&[
        "method",
        "steps\n",
        "evaluations\n",
        "time\nms",
        "max |Δq|\nrad",
        "max |Δv|\nrad/s",
        "energy drift\nJ",
    ]);
    for run in runs {
        let (q, _) = deviations(run.angles(run.method), reference.series(&reference.q));
        let (v, _) = deviations(run.velocities(), reference.series(&reference.v));
        table.row([
            run.method.to_owned(),
            run.statistics.steps.to_string(),
            run.statistics.evaluations.to_string(),
            format!("{:.2}", run.milliseconds),
            tiny(peak(q)),
            tiny(peak(v)),
            tiny(peak(run.drift())),
        ]);
    }
    println!();
    table.print();
}
