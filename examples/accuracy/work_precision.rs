//! Error against work, for every method on every problem.

use redysim::{
    Dop8, Dop853, Gauss4, Gauss6, IntegrationError, Integrator, Ode4, Ode5, Ode15s, Ode45, Radau5, SemiImplicitEuler,
};

use super::problem::{Problem, Quantity, Run};
use crate::common::csv::Csv;
use crate::common::figure::{Figure, Panel};
use crate::common::progress::Progress;
use crate::common::table::{Table, headline, remark};
use crate::common::{Failure, Outputs};

/// A method, and its runs from loose to tight.
struct MethodRuns {
    name: &'static str,
    runs: Vec<Run>,
    /// Why its last run failed, if one did.
    failure: Option<IntegrationError<f64>>,
}

/// The errors that the table asks for.
const TARGETS: [f64; 4] = [1e-2, 1e-4, 1e-7, 1e-10];

/// Numbers of steps 16, 32, … up to `most`.
fn step_counts(most: u64) -> impl Iterator<Item = u64> {
    (4..).map(|power| 1 << power).take_while(move |&count| count <= most)
}

/// The runs of a method over its settings. Those that find no error below 1 are left out, and a method that has failed
/// at a setting and after one that worked is not tried at the tighter ones.
fn runs<I: Integrator<f64>>(
    name: &'static str,
    problem: &impl Problem,
    methods: impl Iterator<Item = I>,
) -> MethodRuns {
    let mut method = MethodRuns { name, runs: Vec::new(), failure: None };
    for integrator in methods {
        match problem.run(&integrator) {
            Ok(run) if run.error() < 1.0 => {
                method.failure = None;
                method.runs.push(run);
            }
            Ok(_) => {}
            Err(error) => {
                method.failure = Some(error);
                if !method.runs.is_empty() {
                    break;
                }
            }
        }
    }
    method
}

/// Tries every method on `problem` and shows what comes out.
pub fn report(problem: &impl Problem, outputs: &mut Outputs) -> Result<(), Failure> {
    let methods = measured(problem);
    outputs.picture(problem.name(), problem.title(), &figure(problem, &methods))?;
    outputs.numbers(problem.name(), "the same in numbers", &csv(problem, &methods))
}

/// Tries every method on `problem`, and shows its first quantity over evaluations in a panel.
pub fn over_evaluations(problem: &impl Problem, outputs: &mut Outputs) -> Result<Panel, Failure> {
    let methods = measured(problem);
    outputs.numbers(problem.name(), "the same in numbers", &csv(problem, &methods))?;
    Ok(panel(problem.title(), (0, &problem.quantities()[0]), &methods, ("evaluations", |run| run.evaluations)))
}

/// Tries every method on `problem` and prints what comes out.
fn measured(problem: &impl Problem) -> Vec<MethodRuns> {
    let size = |count: u64| problem.duration() / count as f64;
    let counts = || step_counts(problem.most_steps());
    let mut progress = Progress::new(problem.name(), 10);
    let mut methods = Vec::new();
    let mut add = |method| {
        methods.push(method);
        progress.advance();
    };
    add(runs("Euler", problem, counts().map(|count| SemiImplicitEuler::new(size(count)))));
    add(runs("Ode4", problem, counts().map(|count| Ode4::new(size(count)))));
    add(runs("Ode5", problem, counts().map(|count| Ode5::new(size(count)))));
    add(runs("Dop8", problem, counts().map(|count| Dop8::new(size(count)))));
    add(runs("Gauss4", problem, counts().map(|count| Gauss4::new(size(count)))));
    add(runs("Gauss6", problem, counts().map(|count| Gauss6::new(size(count)))));
    add(runs("Ode45", problem, problem.tolerances().map(|rtol| Ode45::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Dop853", problem, problem.tolerances().map(|rtol| Dop853::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Ode15s", problem, problem.tolerances().map(|rtol| Ode15s::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Radau5", problem, problem.tolerances().map(|rtol| Radau5::new().rtol(rtol).atol(rtol / 100.0))));
    drop(progress);
    print(problem, &methods);
    methods
}

fn print(problem: &impl Problem, methods: &[MethodRuns]) {
    headline(problem.title());
    let heads: Vec<String> = TARGETS.iter().map(|target| format!("error ≤ {target:.0e}\nevaluations, ms")).collect();
    let mut headers = vec![""];
    headers.extend(heads.iter().map(String::as_str));
    headers.push("at best\nerror");
    let mut table = Table::new(&headers);
    for method in methods {
        let cheapest = |target: f64| {
            let good = method.runs.iter().filter(|run| run.error() <= target);
            let run = good.min_by(|one, other| one.milliseconds.total_cmp(&other.milliseconds));
            run.map_or("–".to_owned(), |run| format!("{:.0}, {:.3}", run.evaluations, run.milliseconds))
        };
        let best = method.runs.iter().map(Run::error).reduce(f64::min);
        let best = best.map_or("fails".to_owned(), |error| format!("{error:.0e}"));
        table.row(std::iter::once(method.name.to_owned()).chain(TARGETS.map(cheapest)).chain([best]));
    }
    table.print();
    let what = problem.quantities().first().map_or("", |quantity| quantity.what);
    remark(&format!("Error: {what}. The quickest run that keeps it; a Jacobian counts"));
    remark("as one evaluation for each component of the state.");
    for MethodRuns { name, failure, .. } in methods {
        if let Some(error) = failure {
            remark(&format!("{name}: {error}."));
        }
    }
}

/// Each quantity over evaluations, and a single one over time, too.
fn figure(problem: &impl Problem, methods: &[MethodRuns]) -> Figure {
    let over_evaluations = |(index, quantity): (usize, &Quantity)| {
        let title = if index == 0 { problem.title() } else { "" };
        panel(title, (index, quantity), methods, ("evaluations", |run| run.evaluations))
    };
    let mut panels: Vec<Panel> = problem.quantities().iter().enumerate().map(over_evaluations).collect();
    if let [single] = problem.quantities() {
        panels.push(panel("", (0, single), methods, ("time [ms]", |run| run.milliseconds)));
    }
    Figure { columns: panels.len(), panels, shared_legend: true }
}

/// A quantity of the problem, by its number, against the work.
fn panel(
    title: &str,
    (index, quantity): (usize, &Quantity),
    methods: &[MethodRuns],
    (across, work): (&str, fn(&Run) -> f64),
) -> Panel {
    let start = Panel::new(title, quantity.name, "1").logarithmic().over(across);
    methods.iter().enumerate().fold(start, |panel, (colour, method)| {
        let points: Vec<(f64, f64)> = method.runs.iter().map(|run| (work(run), run.errors[index].max(1e-17))).collect();
        panel.dots(method.name, colour, &points)
    })
}

/// All numbers of the runs.
fn csv(problem: &impl Problem, methods: &[MethodRuns]) -> Csv {
    let quantities = problem.quantities().iter().map(|quantity| quantity.name);
    let headers = std::iter::once("method").chain(quantities).chain(["evaluations", "time [ms]"]);
    let mut csv = Csv::new(&headers.map(String::from).collect::<Vec<_>>());
    for method in methods {
        for Run { errors, evaluations, milliseconds } in &method.runs {
            csv.named_row(method.name, errors.iter().copied().chain([*evaluations, *milliseconds]));
        }
    }
    csv
}
