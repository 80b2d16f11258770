//! `redysim forward SCENARIO`.

mod gimbal;
mod ground;
mod growth;
mod observer;
mod system;

use std::path::Path;

use redysim_runtime::{ContactEvent, IntegrationError, Stabilisation};

use crate::failure::Failure;
use crate::interrupt;
use crate::number::size;
use crate::results::{self, Balance, Ended, Files, Outcome, Record, Sink, Summary};
use crate::scenario::{Dynamics, Forward, Ground, Integrator, Scenario, Tolerances, keys, missing};
use gimbal::Gimbals;
use growth::{Gains, Growth};
use observer::RunObserver;
use system::System;

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
    let scenario = Scenario::load(&results.scenario, Dynamics::Forward, quiet)?;
    interrupt::watch()?;
    compute(results, &scenario, quiet).map(drop)
}

/// Computes the motion of a scenario and writes it; returns the warnings, which are printed unless `quiet`.
pub fn compute(results: &results::Arguments, scenario: &Scenario, quiet: bool) -> Result<Vec<String>, Failure> {
    let forward = wanted(scenario, &results.scenario)?;
    let mut files = Files::begin(results, scenario, Dynamics::Forward, quiet)?;
    let (summary, warnings) = compute_into(&mut files, scenario, forward, quiet)?;
    files.finish(scenario, summary, quiet)?;
    Ok(warnings)
}

/// The motion that the scenario at `path` is for.
///
/// # Errors
/// If it is for none.
pub fn wanted<'s>(scenario: &'s Scenario, path: &Path) -> Result<&'s Forward, Failure> {
    let missing = || missing(path, "which motion is to be computed", &keys::FORWARD);
    scenario.forward.as_ref().ok_or_else(missing)
}

/// Computes a motion, whose rows go to `sink`; returns how it went, and the warnings, which are printed unless `quiet`.
///
/// # Errors
/// If the motion does not start, or a row cannot be written.
pub fn compute_into(
    sink: &mut (dyn Sink + 'static),
    scenario: &Scenario,
    forward: &Forward,
    quiet: bool,
) -> Result<(Summary, Vec<String>), Failure> {
    let ground = scenario.ground();
    let mut record = Record::begin(sink, scenario, Dynamics::Forward, forward.span, quiet);
    let (outcome, diagnostics) = move_on(scenario, (forward, &ground), &mut record, quiet)?;
    warn_of_drift(forward, &record, &diagnostics);
    record.end(outcome)
}

/// What a run shows of why it may be wrong.
struct Diagnostics<'a> {
    /// A motion that grows without bound.
    growth: Option<Growth>,
    gimbals: Gimbals<'a>,
}

/// The motion from the start to the end, as far as it goes, and why it may be wrong.
fn move_on<'a>(
    scenario: &'a Scenario,
    (forward, ground): (&'a Forward, &'a Ground<'a>),
    record: &mut Record<'a>,
    quiet: bool,
) -> Result<(Outcome, Diagnostics<'a>), Failure> {
    let mut system = System::new(scenario, forward, ground);
    let start = system.start(scenario, forward, quiet)?;
    warn_of_step(scenario, forward, &mut system, &start, record);
    let mut observer = RunObserver::new(scenario, (forward, ground), record, &start)?;
    let (integrator, interval, stops) = (&forward.integrator, forward.span.interval(), forward.stops());
    let mut touch_downs = Vec::new();
    let on_event = |event: ContactEvent<f64>| {
        if event.touching {
            touch_downs.push(event);
        }
    };
    let solution = integrator.run(ground, system.ode(), (interval, &stops), start, &mut observer, on_event);
    let RunObserver { steps, position_residual, growth, gimbals, failed, .. } = observer;
    let ended = match (&solution, failed) {
        (Err(error), _) => {
            let failure = explained(error, (scenario, forward), &system);
            // The remedies of an integration that fails are those for right motions.
            Ended::Failed(match (&growth, gimbals.advice()) {
                (Some(growth), _) if !growth.from_nowhere => {
                    failure.and(&format!("; {}", growth.warning)).help(&growth.help)
                }
                // A failure that has a remedy keeps it.
                (_, Some(advice)) if failure.advice().is_empty() => failure.help(advice),
                _ => failure,
            })
        }
        (Ok(_), Some(reason)) => Ended::Failed(reason),
        (Ok(_), None) if record.next().is_some() => Ended::Interrupted,
        (Ok(_), None) => Ended::Complete,
    };
    // A run that fails has both in its error.
    if let Some(growth) = growth.as_ref().filter(|growth| !growth.from_nowhere && !matches!(ended, Ended::Failed(_))) {
        record.warn(&growth.warning, &growth.help);
    }
    let outcome = Outcome {
        ended,
        integrator: Some(forward.integrator.name()),
        steps: Some(steps),
        statistics: solution.ok().map(|solution| solution.statistics),
        position_residual: scenario.loops().then_some(position_residual),
        contacts: Some((ground.contacts().len(), touch_downs)).filter(|(contacts, _)| *contacts > 0),
    };
    Ok((outcome, Diagnostics { growth, gimbals }))
}

/// Warns before the run that its steps are too large, if that is so at the start.
fn warn_of_step(
    scenario: &Scenario,
    forward: &Forward,
    system: &mut System<'_>,
    start: &Vec<f64>,
    record: &Record<'_>,
) {
    let at_start = (forward.span.start, start);
    let Some(warning) = forward.integrator.step_warning(system.ode(), at_start, &scenario.mechanism) else { return };
    let joint = warning.stable.component.and_then(|component| scenario.layout.joint_of_velocity_in_state(component));
    let whose = joint.map_or(String::new(), |joint| format!(" of the joint `{}`", joint.name));
    // At the limit itself errors just do not grow.
    let (method, step, most) = (forward.integrator.name(), warning.step, two_digits(0.25 * warning.stable.step));
    let warning = format!("with steps of {step:?} s {method} is not stable near the start: errors{whose} grow");
    let help = format!(
        "take integrator = {{ method = \"{method}\", step = {most:.1e} }} or less, lower gains or dampings, or an \
         implicit method, as in: {}",
        implicit()
    );
    record.warn(&warning, &help);
}

/// No more than `value`, in two digits.
fn two_digits(value: f64) -> f64 {
    let unit = 10_f64.powf(value.log10().floor() - 1.0);
    (value / unit).floor() * unit
}

/// Warns that a motion is wrong, if its energy shows it.
fn warn_of_drift(forward: &Forward, record: &Record<'_>, Diagnostics { growth, gimbals }: &Diagnostics<'_>) {
    if matches!(forward.stabilisation, Stabilisation::Baumgarte { .. }) {
        // While it closes loops, its feedback does work that is not counted.
        return;
    }
    if growth.as_ref().is_some_and(|growth| !growth.from_nowhere) {
        // The energy of a motion without bound says nothing about the integrator.
        return;
    }
    let Balance { drift, .. } = record.balance();
    if let Some(part) = record.balance().wrong_part() {
        let smaller = smaller_steps(&forward.integrator);
        let help = match gimbals.advice() {
            Some(advice) => format!("{advice}; or {smaller}"),
            None => smaller,
        };
        let warning = format!(
            "the motion is wrong: {} J have come from nowhere, {:.0} % of the energy that was exchanged",
            size(*drift),
            100.0 * part
        );
        let gains = growth.as_ref().map_or(String::new(), |growth| format!("; if it still grows, {}", growth.help));
        record.warn(&warning, &(help + &gains));
    }
}

/// How to have smaller steps.
fn smaller_steps(integrator: &Integrator) -> String {
    match integrator {
        Integrator::Fixed(_, step) => format!("take a `step` of the integrator below {step:?} s"),
        Integrator::Adaptive(_, Tolerances { rtol, .. }) => format!("take `rtol` below {rtol:?}, and `atol` likewise"),
    }
}

/// An integrator for stiff equations, as a scenario has it.
fn implicit() -> String {
    keys::INTEGRATOR.example().replace(keys::METHOD.value(), "\"Ode15s\"")
}

/// Why the integration ended, in terms of scenarios.
fn explained(
    error: &IntegrationError<f64>,
    (scenario, forward): (&Scenario, &Forward),
    system: &System<'_>,
) -> Failure {
    match *error {
        IntegrationError::InvalidStep { .. } => Failure::input(error),
        // The remedies in the messages of these are for programs.
        IntegrationError::TooManySteps { t, limit } => {
            let message = format!("the end is not within {limit} steps of t = {t:?} s");
            Failure::input(message).help("take larger steps or tolerances in `integrator`, or an earlier `end`")
        }
        IntegrationError::Stiff { t, step, remaining } => {
            let steps = format!("the steps at {} s, and the rest would take about {remaining} of them", size(step));
            let Gains { help, drive_away } = Gains::of(forward.torque.unlimited());
            if drive_away {
                // An implicit method would follow the joints on their way.
                return Failure::input(format!("at t = {} s a motion that grows keeps {steps}", size(t))).help(help);
            }
            let message =
                format!("the equation is stiff at t = {t:?} s: stability, not accuracy, keeps {steps}");
            Failure::outside(message)
                .help(format!("take an implicit method, as in: {}, or lower gains or dampings", implicit()))
        }
        IntegrationError::Chattering { t, events } => {
            let message = format!(
                "contacts begin and end {events} times at t = {t:?} s: steps are too long for the stiffness and damping of \
                 the ground"
            );
            let softer = "give the contacts less `stiffness` or `damping`";
            Failure::outside(message).help(format!("{}, or {softer}", smaller_steps(&forward.integrator)))
        }
        // The loops know better than the integrator what went wrong.
        _ => match system.last_error() {
            Some(reason) if forward.prescribed.is_some() => Failure::outside(reason).help(
                "the joints in `prescribed` go where the links do not reach, or where the loops do not leave them free: \
                 prescribe another motion, or end before",
            ),
            Some(reason) => Failure::outside(reason),
            None => Failure::outside(named(scenario, error)),
        },
    }
}

/// The error with the name of the coordinate or velocity that it is about.
fn named(scenario: &Scenario, error: &IntegrationError<f64>) -> String {
    let (IntegrationError::NonFiniteState { component, .. } | IntegrationError::NonFiniteDerivative { component, .. }) =
        *error
    else {
        return error.to_string();
    };
    format!("{error} (component {component} is {})", scenario.layout.name_in_state(component))
}
