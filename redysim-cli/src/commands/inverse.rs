//! `redysim inverse SCENARIO`.

use std::time::Instant;

use redysim_runtime::{ClosedLoop, ClosedLoopInverse, InverseDynamics, LoopClosure, LoopForces, Motion, Trajectory};

use crate::failure::Failure;
use crate::interrupt;
use crate::output::tell;
use crate::progress::Progress;
use crate::results::{self, Ended, Record, Summary};
use crate::scenario::{Prescribed, Run, Scenario, Span};

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
    let scenario = Scenario::load(&results.scenario, Run::Inverse, quiet)?;
    let missing = |what: &str, help: &str| {
        Failure::input(format!("{} does not say {what}", results.scenario.display())).help(help)
    };
    let span = scenario.inverse.ok_or_else(|| {
        missing("at which instants forces are wanted", "add a table, as in: inverse = { end = 1.0, step = 0.01 }")
    })?;
    let trajectory = scenario.trajectory.as_ref().ok_or_else(|| {
        missing(
            "which motion is prescribed",
            "add a table, as in: trajectory = { from = [0], to = [\"60 deg\"], duration = 1.0 }",
        )
    })?;
    check_joints(&scenario, trajectory)?;
    interrupt::watch()?;
    let folder = results.folder(&scenario, "inverse")?;
    let (record, summary) = along(&scenario, trajectory, span, quiet);
    if !quiet {
        warn_of_passive(&scenario, &record);
    }
    results::finish(folder, results.format, &scenario, &record, &summary, quiet)
}

/// A tree moves as it is told: every joint must be.
fn check_joints(scenario: &Scenario, trajectory: &Prescribed) -> Result<(), Failure> {
    let free = scenario.joints.iter().enumerate().find(|(index, _)| !trajectory.joints.contains(index));
    match free {
        Some((_, joint)) if !scenario.loops() => {
            let message = format!("the trajectory does not prescribe the joint `{}`", joint.name);
            Err(Failure::input(message)
                .help("name all joints among its `joints`: without loops nothing else tells how they move"))
        }
        _ => Ok(()),
    }
}

/// Without loops nothing but its actuator moves a joint: where there is none, the motion cannot be.
fn warn_of_passive(scenario: &Scenario, record: &Record) {
    for (index, joint) in scenario.joints.iter().enumerate().filter(|(_, joint)| !joint.actuated) {
        let most = record.tau.iter().fold(0.0, |most: f64, row| most.max(row[index].abs()));
        if most > 0.0 {
            let (name, unit) = (&joint.name, joint.unit_of_force());
            tell(&format!(
                "warning: the joint `{name}` has no actuator, but the motion takes up to {most:.3e} {unit} there"
            ));
        }
    }
}

/// Motion, forces, multipliers and gap at one time.
type Balance = (Motion<Vec<f64>, Vec<f64>>, Vec<f64>, Vec<f64>, f64);

/// The forces at every instant, as far as there are.
fn along(scenario: &Scenario, trajectory: &Prescribed, span: Span, quiet: bool) -> (Record, Summary) {
    let (mechanism, times) = (&scenario.mechanism, span.instants());
    let loops = ClosedLoop::new(mechanism);
    let whole = trajectory.spread(scenario.joints.len());
    let mut of_loops = ClosedLoopInverse::new(loops, &trajectory.joints, scenario.initial.q.clone());
    let actuated = crate::scenario::indices(&scenario.joints, |joint| joint.actuated);
    of_loops = of_loops.actuated(&actuated);
    let mut balance = |t: f64| -> Result<Balance, Failure> {
        if !scenario.loops() {
            let motion = whole.at(t);
            let forces = mechanism.inverse_dynamics(&motion.q, &motion.v, &motion.a);
            return Ok((motion, forces, vec![], 0.0));
        }
        let failed = |reason| Failure::outside(format!("at t = {t:?} s: {}", loops.explain(reason)));
        let LoopForces { motion, forces, multipliers, .. } = of_loops.at(t, trajectory).map_err(failed)?;
        let residual: Vec<f64> = mechanism.loop_residual(&motion.q);
        let gap = residual.iter().fold(0.0, |gap: f64, value| gap.max(value.abs()));
        Ok((motion, forces, multipliers, gap))
    };
    let mut record = Record::default();
    let (mut ended, mut worst, mut work) = (Ended::Complete, 0.0, 0.0);
    let mut progress = Progress::new(times.len(), quiet);
    let begun = Instant::now();
    for (k, &t) in times.iter().enumerate() {
        if interrupt::asked() {
            ended = Ended::Interrupted;
            break;
        }
        let done = if k == 0 { Ok(0.0) } else { work_between(&mut balance, times[k - 1], t) };
        let (done, (motion, forces, multipliers, gap)) = match done.and_then(|done| Ok((done, balance(t)?))) {
            Ok(found) => found,
            Err(reason) => {
                ended = Ended::Failed(reason);
                break;
            }
        };
        work += done;
        worst = f64::max(worst, gap);
        record.state(mechanism, t, motion.q, motion.v, work);
        record.a.push(motion.a);
        record.tau.push(forces);
        record.lambda.push(multipliers);
        progress.reach(k + 1);
    }
    let at_start = |rows: &results::Rows| rows.first().cloned().unwrap_or_default();
    let summary = Summary {
        name: scenario.name.clone(),
        command: "inverse",
        method: if scenario.loops() { "ClosedLoopInverse".into() } else { "InverseDynamics".into() },
        instants: (span.start, record.until(), record.t.len()),
        statistics: None,
        seconds: begun.elapsed().as_secs_f64(),
        drift: record.worst_drift(),
        gap: scenario.loops().then_some(worst),
        start: [at_start(&record.q), at_start(&record.v)],
        ended,
    };
    (record, summary)
}

/// Nodes, in halves of the interval from its middle, and weights of Gauss's rule of order 6.
const GAUSS: [(f64, f64); 3] =
    [(-0.774_596_669_241_483_4, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.774_596_669_241_483_4, 5.0 / 18.0)];

/// The work of the joint forces from one time to another, ∫ τ·q̇ dt, J. It is what the energy is checked against.
fn work_between(balance: &mut impl FnMut(f64) -> Result<Balance, Failure>, from: f64, to: f64) -> Result<f64, Failure> {
    let half = 0.5 * (to - from);
    GAUSS.iter().try_fold(0.0, |work, (node, weight)| {
        let (motion, forces, ..) = balance(from + half + node * half)?;
        let power: f64 = forces.iter().zip(&motion.v).map(|(force, speed)| force * speed).sum();
        Ok(work + weight * (to - from) * power)
    })
}
