//! `redysim forward SCENARIO`.

use std::ops::ControlFlow;
use std::time::Instant;

use redysim_model::GenericMechanism;
use redysim_runtime::integrate::Observer;
use redysim_runtime::{
    ClosedLoop, ClosedLoopSimulation, ForwardSimulation, IntegrationError, LoopClosure, LoopError, MechanicalEnergy,
    SimulationState, Stabilisation, Step, TorqueLaw,
};

use crate::failure::Failure;
use crate::interrupt;
use crate::output::say;
use crate::progress::Progress;
use crate::results::{self, Ended, Record, Summary};
use crate::scenario::{Forward, Law, Run, Scenario};

/// Compute how a mechanism moves, and write it into a folder.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim forward scenarios/kuka.toml -o results/fall")]
pub struct Arguments {
    #[command(flatten)]
    results: results::Arguments,
}

/// Computes the motion and writes it.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let Arguments { results } = arguments;
    let scenario = Scenario::load(&results.scenario, Run::Forward, quiet)?;
    let forward = scenario.forward.as_ref().ok_or_else(|| {
        let message = format!("{} does not say which motion is to be computed", results.scenario.display());
        Failure::input(message).help("add a table, as in: forward = { end = 1.0, step = 0.01 }")
    })?;
    interrupt::watch()?;
    let folder = results.folder(&scenario, "forward")?;
    let (record, summary) =
        if scenario.loops() { of_loops(&scenario, forward, quiet)? } else { of_tree(&scenario, forward, quiet)? };
    results::finish(folder, results.format, &scenario, &record, &summary, quiet)
}

/// The motion of a tree.
fn of_tree(scenario: &Scenario, forward: &Forward, quiet: bool) -> Result<(Record, Summary), Failure> {
    let mechanism = &scenario.mechanism;
    let mut simulation = ForwardSimulation::new(mechanism, law(scenario, forward));
    let start = simulation.state(&scenario.initial.q, &scenario.initial.v);
    let times = forward.span.instants();
    let mut watch = Watch::new(mechanism, &times, &start, quiet);
    let begun = Instant::now();
    let solution = forward.integrator.run(&mut simulation, watch.interval(), start, &mut watch);
    let seconds = begun.elapsed().as_secs_f64();
    let ended = ended(solution.as_ref().err(), |error| named(scenario, error));
    let statistics = solution.ok().map(|solution| solution.statistics);
    let Watch { states, drift, .. } = watch;
    let mut record = Record::default();
    let mut law = law(scenario, forward);
    for (&t, state) in times.iter().zip(&states) {
        let SimulationState { q, v, actuator_energy } = simulation.split(state);
        record.tau.push(law.torque(t, &q, &v));
        record.state(mechanism, t, q, v, actuator_energy);
    }
    let summary = Summary {
        statistics,
        seconds,
        drift: drift.max(record.worst_drift()),
        gap: None,
        start: [scenario.initial.q.clone(), scenario.initial.v.clone()],
        ..summary(scenario, forward, &record, ended)
    };
    Ok((record, summary))
}

/// The motion of closed loops.
fn of_loops(scenario: &Scenario, forward: &Forward, quiet: bool) -> Result<(Record, Summary), Failure> {
    let mechanism = &scenario.mechanism;
    let loops = ClosedLoop::new(mechanism);
    let simulation = ClosedLoopSimulation::new(loops, law(scenario, forward));
    let mut simulation = simulation.stabilisation(forward.stabilisation);
    let start = start(scenario, forward, &simulation, quiet)?;
    let times = forward.span.instants();
    let mut watch = Watch::new(mechanism, &times, &start, quiet);
    let begun = Instant::now();
    let SimulationState { q, v, .. } = simulation.split(&start);
    let at_start = [q, v];
    let solution = forward.integrator.run(&mut simulation, watch.interval(), start, &mut watch);
    let seconds = begun.elapsed().as_secs_f64();
    // A law that has no forces is why the loops have no accelerations.
    let reason = simulation.law().last_error().or(simulation.last_error());
    let mut ended = ended(solution.as_ref().err(), |error| match reason {
        // The loops know better than the integrator what went wrong.
        Some(reason) => loops.explain(reason).to_string(),
        None => named(scenario, error),
    });
    let statistics = solution.ok().map(|solution| solution.statistics);
    let Watch { states, drift, gap, .. } = watch;
    let mut record = Record::default();
    let mut law = law(scenario, forward);
    for (&t, state) in times.iter().zip(&states) {
        match instant(&mut simulation, &mut law, t, state, forward.stabilisation) {
            Ok((SimulationState { q, v, actuator_energy }, tau, lambda)) => {
                record.tau.push(tau);
                record.lambda.push(lambda);
                record.state(mechanism, t, q, v, actuator_energy);
            }
            Err(reason) => {
                ended = Ended::Failed(Failure::outside(format!("at t = {t:?} s: {}", loops.explain(reason))));
                break;
            }
        }
    }
    let summary = Summary {
        statistics,
        seconds,
        drift: drift.max(record.worst_drift()),
        gap: Some(gap),
        start: at_start,
        ..summary(scenario, forward, &record, ended)
    };
    Ok((record, summary))
}

type LoopInstant = (SimulationState<f64, Vec<f64>, Vec<f64>>, Vec<f64>, Vec<f64>);

/// State, joint forces and multipliers at an asked time. Within a step loops are only as closed as the method is accurate;
/// where steps are projected, so is what is written.
fn instant(
    simulation: &mut ClosedLoopSimulation<'_, f64, GenericMechanism, Law<'_>>,
    law: &mut Law<'_>,
    t: f64,
    state: &Vec<f64>,
    stabilisation: Stabilisation<f64>,
) -> Result<LoopInstant, LoopError<f64>> {
    let mut parts = simulation.split(state);
    if stabilisation == Stabilisation::Projection {
        let closed = simulation.loops().project(&parts.q, &parts.v)?;
        (parts.q, parts.v) = (closed.q, closed.v);
    }
    let tau = law.torque(t, &parts.q, &parts.v);
    if let Some(reason) = law.last_error() {
        return Err(reason);
    }
    let state = simulation.state(&parts.q, &parts.v);
    let lambda = simulation.motion(t, &state)?.multipliers;
    Ok((parts, tau, lambda))
}

/// The state to start from: with the loops closed, unless the scenario forbids it.
fn start(
    scenario: &Scenario,
    forward: &Forward,
    simulation: &ClosedLoopSimulation<'_, f64, GenericMechanism, Law<'_>>,
    quiet: bool,
) -> Result<Vec<f64>, Failure> {
    let initial = &scenario.initial;
    let loops = simulation.loops();
    let failed = |reason| Failure::input(format!("the start: {}", loops.explain(reason)));
    if !initial.assemble {
        return match forward.stabilisation {
            Stabilisation::Projection => simulation.start(&initial.q, &initial.v).map_err(failed),
            // Without projection, loops may be open: they stay as far open as they are, or feedback closes them.
            Stabilisation::Baumgarte { .. } | Stabilisation::None => Ok(simulation.state(&initial.q, &initial.v)),
        };
    }
    let closed = loops.assemble(&initial.q, &initial.v, &initial.held).map_err(failed)?;
    if !quiet {
        let moves = scenario.joints.iter().zip(closed.q.iter().zip(&initial.q));
        let moved = moves.filter(|(_, (to, from))| to != from);
        let told: Vec<_> =
            moved.map(|(joint, (to, from))| format!("{} by {:.3e} {}", joint.name, to - from, joint.unit())).collect();
        if !told.is_empty() {
            say(&format!("To close the loops, the start moves {}.", told.join(", ")));
        }
    }
    Ok(simulation.assembled(&closed))
}

fn law<'a>(scenario: &'a Scenario, forward: &'a Forward) -> Law<'a> {
    forward.torque.law(&scenario.mechanism)
}

fn summary(scenario: &Scenario, forward: &Forward, record: &Record, ended: Ended) -> Summary {
    Summary {
        name: scenario.name.clone(),
        command: "forward",
        method: forward.integrator.name(),
        instants: (forward.span.start, record.until(), record.t.len()),
        statistics: None,
        seconds: 0.0,
        drift: 0.0,
        gap: None,
        start: [vec![], vec![]],
        ended,
    }
}

fn ended(error: Option<&IntegrationError<f64>>, said: impl FnOnce(&IntegrationError<f64>) -> String) -> Ended {
    match error {
        Some(error @ (IntegrationError::BadRelativeTolerance { .. } | IntegrationError::BadStep { .. })) => {
            Ended::Failed(Failure::input(said(error)))
        }
        // What these say of remedies is for programs.
        Some(IntegrationError::TooManySteps { t, limit }) => {
            let message = format!("the end is not within {limit} steps of t = {t:?} s");
            Ended::Failed(
                Failure::input(message).help("take larger steps or tolerances in `integrator`, or an earlier `end`"),
            )
        }
        Some(IntegrationError::Stiff { t, step, remaining }) => {
            let message = format!(
                "the equation is stiff at t = {t:?} s: stability, not accuracy, keeps the steps at {step:.1e} s, and the rest \
                 would take about {remaining} of them"
            );
            let help = "take an implicit method, as in: integrator = { method = \"Ode15s\", rtol = 1e-6, atol = 1e-8 }, or \
                        lower gains or dampings";
            Ended::Failed(Failure::outside(message).help(help))
        }
        Some(error) => Ended::Failed(Failure::outside(said(error))),
        None if interrupt::asked() => Ended::Interrupted,
        None => Ended::Complete,
    }
}

/// The error with the name of the joint that it is about.
fn named(scenario: &Scenario, error: &IntegrationError<f64>) -> String {
    let (IntegrationError::NonFiniteState { component, .. } | IntegrationError::NonFiniteDerivative { component, .. }) =
        *error
    else {
        return error.to_string();
    };
    let count = scenario.joints.len();
    match scenario.joints.get(component % count.max(1)).filter(|_| component < 2 * count) {
        Some(joint) => {
            let what = if component < count { "coordinate" } else { "velocity" };
            format!("{error} (component {component} is the {what} of the joint `{}`)", joint.name)
        }
        None => format!("{error} (component {component} is the work of the actuators)"),
    }
}

/// Looks at every step: keeps the state at the asked times, and watches what must stay.
struct Watch<'a> {
    mechanism: &'a GenericMechanism,
    times: &'a [f64],
    states: Vec<Vec<f64>>,
    /// Energy less the work of the actuators at the start, J.
    energy: f64,
    /// Its largest change so far, J.
    drift: f64,
    /// The largest component of the loops' residual so far, m.
    gap: f64,
    progress: Progress,
}

impl<'a> Watch<'a> {
    fn new(mechanism: &'a GenericMechanism, times: &'a [f64], start: &Vec<f64>, quiet: bool) -> Self {
        let progress = Progress::new(times.len(), quiet);
        let mut watch = Watch { mechanism, times, states: Vec::new(), energy: 0.0, drift: 0.0, gap: 0.0, progress };
        watch.energy = watch.energy_of(start);
        watch.states.push(start.clone());
        watch.see(start);
        watch
    }

    fn interval(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    fn energy_of(&self, state: &Vec<f64>) -> f64 {
        let SimulationState { q, v, actuator_energy } = ForwardSimulation::new(self.mechanism, ()).split(state);
        self.mechanism.energy(&q, &v).total() - actuator_energy
    }

    fn see(&mut self, state: &Vec<f64>) {
        self.drift = self.drift.max((self.energy_of(state) - self.energy).abs());
        let q = state[..self.mechanism.model().dof()].to_vec();
        let residual: Vec<f64> = self.mechanism.loop_residual(&q);
        self.gap = residual.iter().fold(self.gap, |gap, value| gap.max(value.abs()));
    }

    fn next(&self) -> Option<f64> {
        self.times.get(self.states.len()).copied()
    }
}

impl Observer<f64, Vec<f64>> for Watch<'_> {
    fn looks_within(&self, _from: f64, to: f64) -> bool {
        self.next().is_some_and(|t| t < to)
    }

    fn step(&mut self, step: &Step<'_, f64, Vec<f64>>) -> ControlFlow<()> {
        let (end, state) = step.end();
        while let Some(t) = self.next().filter(|&t| t <= end) {
            self.states.push(step.at(t));
        }
        self.see(state);
        self.progress.reach(self.states.len());
        if interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
