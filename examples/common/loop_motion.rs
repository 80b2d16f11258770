//! Motion of a mechanism with closed loops: what is drawn, and what is watched at the end of every step.

use std::time::Instant;

use redysim::{
    ClosedLoopSimulation, ConfigurationSpace, ForwardSimulation, Integrator, LoopClosure, Statistics, Step, TorqueLaw,
    TreeDynamics,
};

use super::compare::deviations;
use super::csv::{Csv, headers};
use super::progress::Progress;
use super::reference::Reference;
use super::{Failure, Rows, Series, peak};

/// A motion, recorded.
pub struct LoopMotion {
    /// The instants, s.
    pub t: Vec<f64>,
    /// Coordinates, velocities and multipliers there.
    pub q: Rows,
    pub v: Rows,
    pub lambda: Rows,
    /// At the end of every step, the first one's start included.
    pub steps: Watch,
    pub statistics: Statistics,
    /// Wall time, with what recording takes, s.
    pub seconds: f64,
}

/// What must stay, step by step.
#[derive(Default)]
pub struct Watch {
    /// The ends of the steps, s.
    pub t: Vec<f64>,
    /// The largest component of the loops' residual, m.
    pub position_residual: Vec<f64>,
    /// Kinetic and potential energy, less the work of the joint forces, J.
    pub energy: Vec<f64>,
}

/// Moves `simulation` from `start` by `integrator`, and records what is at the instants `t` and at each step.
pub fn record<M, L, I>(
    what: &'static str,
    simulation: &mut ClosedLoopSimulation<'_, f64, M, L>,
    integrator: &I,
    start: M::State,
    t: &[f64],
) -> Result<LoopMotion, Failure>
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
    L: TorqueLaw<f64, M>,
    I: Integrator<f64>,
{
    let mechanism = simulation.loops().mechanism();
    let mut steps = Watch::default();
    steps.see(mechanism, t[0], &start);
    let mut states = Vec::with_capacity(t.len());
    let mut progress = Progress::new(what, t.len());
    let begun = Instant::now();
    let on_step = |step: &Step<'_, f64, M::State>| {
        let (end, state) = step.end();
        while let Some(&instant) = t.get(states.len()).filter(|&&instant| instant <= end) {
            states.push(step.at(instant));
            progress.advance();
        }
        steps.see(mechanism, end, state);
    };
    let solution = integrator.each_step(simulation, (t[0], t[t.len() - 1]), start, on_step);
    let seconds = begun.elapsed().as_secs_f64();
    drop(progress);
    let statistics = match (solution, simulation.last_error()) {
        (Ok(solution), _) => solution.statistics,
        (Err(error), reason) => {
            // The loops know better than the integrator what went wrong.
            let reason = reason.map_or(error.to_string(), |reason| reason.to_string());
            return Err(Failure(format!("{what}, after {:.3} s: {reason}", steps.t[steps.t.len() - 1])));
        }
    };
    let mut motion = LoopMotion { t: t.to_vec(), q: vec![], v: vec![], lambda: vec![], steps, statistics, seconds };
    for (&t, state) in t.iter().zip(&states) {
        let parts = simulation.split(state);
        motion.q.push(parts.q.as_ref().to_vec());
        motion.v.push(parts.v.as_ref().to_vec());
        motion.lambda.push(simulation.motion(t, state)?.multipliers.as_ref().to_vec());
    }
    Ok(motion)
}

impl Watch {
    fn see<M>(&mut self, mechanism: &M, t: f64, state: &M::State)
    where
        M: TreeDynamics<f64> + LoopClosure<f64, M>,
    {
        let parts = ForwardSimulation::new(mechanism, ()).split(state);
        let energy = mechanism.energy(&parts.q, &parts.v).total() - parts.actuator_energy;
        self.t.push(t);
        self.position_residual.push(position_residual(mechanism, &parts.q));
        self.energy.push(energy);
    }

    /// The energy that has come from nowhere since the start, at each step, J.
    pub fn drift(&self) -> Vec<f64> {
        self.energy.iter().map(|energy| energy - self.energy[0]).collect()
    }
}

/// The largest component of the loops' residual, m.
pub fn position_residual<M>(mechanism: &M, q: &M::Coordinates) -> f64
where
    M: ConfigurationSpace<f64> + LoopClosure<f64, M>,
{
    peak(mechanism.loop_residual(q).as_ref().iter().copied())
}

impl LoopMotion {
    /// Some of its rows, under a name.
    pub fn series<'a>(&'a self, name: &'a str, rows: &'a Rows) -> Series<'a> {
        Series { name, t: &self.t, rows }
    }

    /// The largest deviations of coordinates, velocities and multipliers from the reference.
    pub fn deviations(&self, reference: &Reference) -> [f64; 3] {
        let blocks = [(&self.q, &reference.q), (&self.v, &reference.v), (&self.lambda, &reference.lambda)];
        blocks.map(|(ours, theirs)| peak(deviations(self.series("", ours), reference.series(theirs)).0))
    }

    /// The largest position residual at the end of any step, m.
    pub fn worst_position_residual(&self) -> f64 {
        peak(self.steps.position_residual.iter().copied())
    }

    /// The largest drift of the energy at the end of any step, J.
    pub fn worst_drift(&self) -> f64 {
        peak(self.steps.drift())
    }

    /// All numbers at the instants; the joints `sliding` are measured in metres.
    pub fn csv(&self, sliding: &[usize]) -> Csv {
        let joints = self.q[0].len();
        let mut columns = headers(joints, &[("q", "rad"), ("v", "rad/s")]);
        for &joint in sliding {
            columns[1 + joint] = format!("q{} [m]", joint + 1);
            columns[1 + joints + joint] = format!("v{} [m/s]", joint + 1);
        }
        columns.extend((1..=self.lambda[0].len()).map(|row| format!("lambda{row} [N]")));
        let mut csv = Csv::new(&columns);
        for (k, &t) in self.t.iter().enumerate() {
            let blocks = [&self.q[k], &self.v[k], &self.lambda[k]];
            csv.row(std::iter::once(t).chain(blocks.into_iter().flatten().copied()));
        }
        csv
    }
}

/// The largest magnitudes among every so many values, so that a picture shows each peak of a curve that has more points
/// than it has pixels.
pub fn peaks(t: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    const POINTS: usize = 700;
    let every = t.len().div_ceil(POINTS).max(1);
    let largest = values.chunks(every).map(|chunk| peak(chunk.iter().copied())).collect();
    (t.chunks(every).map(|chunk| chunk[chunk.len() - 1]).collect(), largest)
}
