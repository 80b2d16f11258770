//! `redysim inverse SCENARIO`.

use std::path::Path;

use redysim_model::GenericMechanism;
use redysim_runtime::{
    ClosedLoop, ClosedLoopInverse, ConfigurationSpace, InverseDynamics, LoopError, LoopForces, Motion, Trajectory,
};

use crate::failure::Failure;
use crate::interrupt;
use crate::number::{rounded, size};
use crate::output::to_stdout;
use crate::results::{self, Ended, Files, GroundSample, Outcome, Record, Sample, Sink, Summary};
use crate::scenario::{Dynamics, Prescribed, Scenario, Span, keys, missing};

/// Compute the forces that a prescribed motion takes, and write them into a folder.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim inverse scenarios/kuka.toml -o results/lift")]
pub struct Arguments {
    #[command(flatten)]
    results: results::Arguments,
}

/// Computes the forces and writes them.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let Arguments { results } = arguments;
    let scenario = Scenario::load(&results.scenario, Dynamics::Inverse, quiet)?;
    interrupt::watch()?;
    compute(results, &scenario, quiet).map(drop)
}

/// Computes the forces of a scenario and writes them; returns the warnings, which are printed unless `quiet`.
pub fn compute(results: &results::Arguments, scenario: &Scenario, quiet: bool) -> Result<Vec<String>, Failure> {
    let wanted = wanted(scenario, &results.scenario)?;
    let mut files = Files::begin(results, scenario, Dynamics::Inverse, quiet)?;
    let (summary, warnings) = compute_into(&mut files, scenario, wanted, quiet)?;
    files.finish(scenario, summary, quiet)?;
    Ok(warnings)
}

/// The instants and the motion that the scenario at `path` prescribes.
///
/// # Errors
/// If one of them is missing.
pub fn wanted<'s>(scenario: &'s Scenario, path: &Path) -> Result<(Span, &'s Prescribed), Failure> {
    let span = scenario.inverse.ok_or_else(|| missing(path, "at which instants forces are wanted", &keys::INVERSE))?;
    let motion = scenario.trajectory.as_ref();
    Ok((span, motion.ok_or_else(|| missing(path, "which motion is prescribed", &keys::TRAJECTORY))?))
}

/// Computes the forces of a motion, whose rows go to `sink`; returns how it went, and the warnings, which are printed
/// unless `quiet`.
///
/// # Errors
/// If the first forces cannot be computed, or a row cannot be written.
pub fn compute_into(
    sink: &mut (dyn Sink + 'static),
    scenario: &Scenario,
    (span, trajectory): (Span, &Prescribed),
    quiet: bool,
) -> Result<(Summary, Vec<String>), Failure> {
    let mut record = Record::begin(sink, scenario, Dynamics::Inverse, span, quiet);
    let (outcome, most) = along(scenario, trajectory, &mut record);
    warn_of_passive(scenario, &most, &record);
    warn_of_work(span, &record);
    if scenario.loops() && !quiet {
        report_start(scenario, trajectory, &record);
    }
    record.end(outcome)
}

/// The forces are those of each instant; the work between instants is only as exact as these are close.
fn warn_of_work(span: Span, record: &Record<'_>) {
    if let Some(part) = record.balance().wrong_part() {
        let warning = format!(
            "rows each {:?} s are too far apart to add up the work between them: it is wrong by {:.0} % of the energy \
             that was exchanged; the forces are right",
            span.step,
            100.0 * part
        );
        record.warn(&warning, "give [inverse] a smaller `step`");
    }
}

/// Reports on which branch the loops were closed.
fn report_start(scenario: &Scenario, trajectory: &Prescribed, record: &Record<'_>) {
    let others = scenario.layout.coordinates.iter().zip(record.start_position()).enumerate();
    let others = others.filter(|(index, _)| !trajectory.coordinates.contains(index));
    let at: Vec<_> = others.map(|(_, (of, q))| format!("{} at {} {}", of.name, rounded(*q), of.unit())).collect();
    if !at.is_empty() {
        to_stdout(&format!("The loops begin closed with {}.", at.join(", ")));
    }
}

/// A part of the largest force that is its rounding: of a recorded motion, what a free base takes is not exactly zero.
const ROUNDING: f64 = 1e-12;

/// Warns of forces at joints without an actuator: in a mechanism without loops, such a motion is impossible. `most` has
/// the largest force along each velocity.
fn warn_of_passive(scenario: &Scenario, most: &[f64], record: &Record<'_>) {
    let layout = &scenario.layout;
    let rounding = ROUNDING * most.iter().copied().fold(0.0, f64::max);
    for (velocity, &most) in layout.velocities.iter().zip(most) {
        let joint = &layout.joints[velocity.joint];
        if most > rounding && !velocity.actuated {
            let (name, unit) = (&joint.name, velocity.unit_of_force());
            let there = if joint.v.len() == 1 { "there".to_owned() } else { format!("along `{}`", velocity.name) };
            let warning = format!(
                "the joint `{name}` has no actuator, but the motion takes up to {} {unit} {there}",
                rounded(most)
            );
            record
                .warn(&warning, "prescribe a motion that needs none there, or give the joint an actuator in the model");
        }
    }
}

/// What the motion takes at one time.
struct Required {
    motion: Motion<Vec<f64>, Vec<f64>>,
    forces: Vec<f64>,
    multipliers: Vec<f64>,
    /// The largest component of the loops' residual, m.
    position_residual: f64,
}

/// The forces at every instant, as far as there are, and the largest of each joint.
fn along(scenario: &Scenario, trajectory: &Prescribed, record: &mut Record<'_>) -> (Outcome, Vec<f64>) {
    let mechanism = &scenario.mechanism;
    let loops = ClosedLoop::new(mechanism);
    let whole = trajectory.spread(&scenario.layout);
    let mut of_loops = ClosedLoopInverse::new(loops, &trajectory.velocities, scenario.initial.q.clone());
    let actuated = scenario.actuated_velocities();
    of_loops = of_loops.actuated(&actuated);
    let mut required_at = |t: f64| -> Result<Required, Failure> {
        if !scenario.loops() {
            let motion = whole.at(t);
            let forces = mechanism.inverse_dynamics(&motion.q, &motion.v, &motion.a);
            return Ok(Required { motion, forces, multipliers: vec![], position_residual: 0.0 });
        }
        let failed = |reason| match reason {
            LoopError::Unreachable { velocity, position_residual, .. } => {
                unreachable(scenario, t, velocity, position_residual)
            }
            _ => Failure::outside(format!("at t = {t:?} s: {}", loops.with_names(reason))),
        };
        let LoopForces { motion, forces, multipliers, .. } = of_loops.at(t, trajectory).map_err(failed)?;
        let position_residual = scenario.position_residual(&motion.q);
        Ok(Required { motion, forces, multipliers, position_residual })
    };
    let (mut worst, mut work, mut before) = (0.0, 0.0, None);
    let mut most = vec![0.0; scenario.layout.nv()];
    let mut compute = |t: f64, record: &mut Record<'_>| -> Result<(), Failure> {
        work += before.map_or(Ok(0.0), |before| work_between(mechanism, &mut required_at, before, t))?;
        let Required { motion: Motion { q, v, a }, forces: tau, multipliers: lambda, position_residual } =
            required_at(t)?;
        before = Some(t);
        worst = f64::max(worst, position_residual);
        most.iter_mut().zip(&tau).for_each(|(most, force)| *most = f64::max(*most, force.abs()));
        record.add(&Sample { t, q, v, a, tau, lambda, work, ground: GroundSample::default() })
    };
    let ended = loop {
        let Some(t) = record.next() else { break Ended::Complete };
        if interrupt::asked() {
            break Ended::Interrupted;
        }
        if let Err(reason) = compute(t, record) {
            break Ended::Failed(reason);
        }
    };
    let outcome = Outcome {
        ended,
        integrator: None,
        steps: None,
        statistics: None,
        position_residual: scenario.loops().then_some(worst),
        contacts: None,
    };
    (outcome, most)
}

/// The failure of loops that stay open by `residual` at time `t`, with the joint of `velocity` on the trajectory.
fn unreachable(scenario: &Scenario, t: f64, velocity: usize, residual: f64) -> Failure {
    let (name, open) = (&scenario.layout.velocities[velocity].name, size(residual));
    let what = format!("where the trajectory places `{name}`, they stay open by {open} m (or the sine of an angle)");
    let is_start = scenario.inverse.is_none_or(|span| t <= span.start);
    if is_start {
        let failure = Failure::input(format!("the loops cannot be closed at the start, t = {t:?} s: {what}"));
        return failure
            .help("give another `initial.q`, nearer to a closed position, or a trajectory that begins within reach of the links");
    }
    let failure = Failure::outside(format!("the loops cannot be closed at t = {t:?} s: {what}"));
    failure.help("keep the trajectory within reach of the links, or take a smaller `step`")
}

/// Nodes, in halves of the interval from its middle, and weights of Gauss's rule of order 6.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];

/// The work of the joint forces from one time to another, less what damping and friction take, ∫ τ·q̇ − P dt, J. It is
/// what the energy is checked against.
fn work_between(
    mechanism: &GenericMechanism,
    required_at: &mut impl FnMut(f64) -> Result<Required, Failure>,
    from: f64,
    to: f64,
) -> Result<f64, Failure> {
    let half = 0.5 * (to - from);
    GAUSS.iter().try_fold(0.0, |work, (node, weight)| {
        let Required { motion, forces, .. } = required_at(from + half + node * half)?;
        let power: f64 = forces.iter().zip(&motion.v).map(|(force, speed)| force * speed).sum();
        let dissipated: f64 = mechanism.dissipated_power(&motion.q, &motion.v);
        Ok(work + weight * (to - from) * (power - dissipated))
    })
}
