//! What stays open and what drifts, against the step, for each way to keep a loop closed.

use redysim::{ClosedLoop, ClosedLoopSimulation, Ode4, Stabilisation, ZeroTorque};

use super::models::Fourbar;
use crate::common::csv::Csv;
use crate::common::figure::{Figure, Panel};
use crate::common::loop_motion::record;
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Failure, Outputs, instants};

/// Steps, s.
const STEPS: [f64; 6] = [2e-2, 1e-2, 4e-3, 2e-3, 1e-3, 4e-4];

/// A way to keep loops closed: its name, and what it is with steps of a size.
type Way = (&'static str, fn(f64) -> Stabilisation<f64>);

/// The four-bar let go from rest, for 5 s by [`Ode4`].
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    headline("Four-bar, 5 s of free motion by Ode4: the worst position residual of the loop, and drift of the energy");
    let ways: [Way; 4] = [
        ("projection", |_| Stabilisation::Projection),
        ("Baumgarte, α = 20/s", |_| Stabilisation::Baumgarte { alpha: 20.0 }),
        ("Baumgarte, α = 0.5/h", |step| Stabilisation::Baumgarte { alpha: 0.5 / step }),
        ("nothing (plain index 1)", |_| Stabilisation::None),
    ];
    let start = ClosedLoop::new(&Fourbar).assemble(&[0.0, 0.9844, 4.3144], &[0.0; 3], &[0])?;
    let mut open = Panel::new("Position residual of the loop", "position residual", "m").logarithmic().over("step [s]");
    let mut drift = Panel::new("Drift of the energy", "drift", "J").logarithmic().over("step [s]");
    let headers: Vec<String> = STEPS.iter().map(|step| format!("h = {} ms\nm, J", 1e3 * step)).collect();
    let mut table = Table::new(&std::iter::once("").chain(headers.iter().map(String::as_str)).collect::<Vec<_>>());
    let mut csv = Csv::new(&["way", "step [s]", "position residual [m]", "drift [J]"].map(String::from));
    for (colour, (name, way)) in (1..).zip(ways) {
        let (mut residuals, mut drifts, mut cells) = (Vec::new(), Vec::new(), vec![name.to_owned()]);
        for step in STEPS {
            let mut simulation =
                ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque).stabilisation(way(step));
            let state = simulation.assembled(&start);
            match record(name, &mut simulation, &Ode4::new(step), state, &instants(5.0, 5)) {
                Ok(run) => {
                    residuals.push((step, run.worst_position_residual()));
                    drifts.push((step, run.worst_drift()));
                    csv.named_row(name, [step, run.worst_position_residual(), run.worst_drift()]);
                    cells.push(format!("{}, {}", tiny(run.worst_position_residual()), tiny(run.worst_drift())));
                }
                Err(_) => cells.push("fails".to_owned()),
            }
        }
        table.row(cells);
        open = open.dots(name, colour, &residuals);
        drift = drift.dots(name, colour, &drifts);
    }
    table.print();
    remark("α h ≥ 1.3 is refused. Without stabilisation the residual grows without bound as time goes on.");
    let figure = Figure { columns: 2, panels: vec![open, drift], shared_legend: true };
    outputs.picture("drift", "what stays open and what drifts, against the step", &figure)?;
    outputs.numbers("drift", "the same in numbers", &csv)
}
