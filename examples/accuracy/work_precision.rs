//! Error against work, for every method on every problem.

use redysim::{
    Dop8, Dop853, Gauss4, Gauss6, IntegrationError, Integrator, Ode4, Ode5, Ode15s, Ode45, Radau5, SemiImplicitEuler,
};

use super::problem::{Problem, Run};
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

/// Tolerances 10⁻² … 10⁻¹³.
fn tolerances() -> impl Iterator<Item = f64> {
    (4..=26).map(|half| 10_f64.powf(-0.5 * f64::from(half)))
}

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
            Ok(run) if run.error < 1.0 => {
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
    add(runs("Ode45", problem, tolerances().map(|rtol| Ode45::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Dop853", problem, tolerances().map(|rtol| Dop853::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Ode15s", problem, tolerances().map(|rtol| Ode15s::new().rtol(rtol).atol(rtol / 100.0))));
    add(runs("Radau5", problem, tolerances().map(|rtol| Radau5::new().rtol(rtol).atol(rtol / 100.0))));
    drop(progress);
    print(problem, &methods);
    let figure = figure(problem, &methods);
    outputs.picture(problem.name(), problem.title(), &figure)?;
    outputs.numbers(problem.name(), "the same in numbers", &csv(&methods))
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
            let good = method.runs.iter().filter(|run| run.error <= target);
            let run = good.min_by(|one, other| one.milliseconds.total_cmp(&other.milliseconds));
            run.map_or("–".to_owned(), |run| format!("{:.0}, {:.3}", run.evaluations, run.milliseconds))
        };
        let best = method.runs.iter().map(|run| run.error).reduce(f64::min);
        let best = best.map_or("fails".to_owned(), |error| format!("{error:.0e}"));
        table.row(std::iter::once(method.name.to_owned()).chain(TARGETS.map(cheapest)).chain([best]));
    }
    table.print();
    remark(&format!("Error: {}. The quickest run that keeps it; a Jacobian counts", problem.quantity()));
    remark("as one evaluation for each component of the state.");
    for MethodRuns { name, failure, .. } in methods {
        if let Some(error) = failure {
            remark(&format!("{name}: {error}."));
        }
    }
}

fn figure(problem: &impl Problem, methods: &[MethodRuns]) -> Figure {
    let panel = |title: &str, across: &str, work: fn(&Run) -> f64| {
        let start = Panel::new(title, "error", "1").logarithmic().over(across);
        methods.iter().enumerate().fold(start, |panel, (index, method)| {
            let points: Vec<(f64, f64)> = method.runs.iter().map(|run| (work(run), run.error.max(1e-17))).collect();
            panel.dots(method.name, index, &points)
        })
    };
    let panels = vec![
        panel(problem.title(), "evaluations", |run| run.evaluations),
        panel("", "time [ms]", |run| run.milliseconds),
    ];
    Figure { columns: 2, panels, shared_legend: true }
}

fn csv(methods: &[MethodRuns]) -> Csv {
    let mut csv = Csv::new(&["method", "error", "evaluations", "time [ms]"].map(String::from));
    for method in methods {
        for Run { error, evaluations, milliseconds } in &method.runs {
            csv.named_row(method.name, [*error, *evaluations, *milliseconds]);
        }
    }
    csv
}
