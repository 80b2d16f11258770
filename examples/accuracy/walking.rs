//! A walking robot: ReDySim's quadruped on two kinds of ground, with events at touch-down and lift-off and without.

use redysim::{AnyContactLaw, Dop853, IntegrationError, Integrator, Radau5};

use super::problem::{Problem, Quantity, Run, timed};
use super::work_precision::over_evaluations;
use crate::common::figure::Figure;
use crate::common::{Failure, Outputs};
use crate::scenes::trot::{DURATION, HARD, SOFT, State, apart, stride};

/// A stride on ground of a law.
struct Stride {
    name: &'static str,
    title: &'static str,
    law: AnyContactLaw<f64>,
    with_events: bool,
    end: State,
}

impl Problem for Stride {
    fn name(&self) -> &'static str {
        self.name
    }
    fn title(&self) -> &'static str {
        self.title
    }
    fn quantities(&self) -> &'static [Quantity] {
        &[Quantity { name: "error", what: "error of the configuration at the end on the tangent, rad or m" }]
    }
    fn duration(&self) -> f64 {
        DURATION
    }
    fn most_steps(&self) -> u64 {
        10_000
    }
    fn tolerances(&self) -> impl Iterator<Item = f64> {
        (2..=9).map(|decade| 10_f64.powi(-decade))
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        timed(|| stride(self.law, method, self.with_events, |_| ()), |end| vec![apart(end, &self.end)])
    }
}

/// The end of the stride, as two methods of different kinds agree on it.
fn end(law: AnyContactLaw<f64>) -> Result<State, Failure> {
    let judge = stride(law, &Dop853::new().rtol(1e-13).atol(1e-15), true, |_| ())?.y;
    let other = stride(law, &Radau5::new().rtol(1e-10).atol(1e-12), true, |_| ())?.y;
    let apart = apart(&judge, &other);
    if apart > 1e-9 {
        return Err(Failure(format!("Dop853 and Radau5 differ by {apart:.1e} at the end of the stride")));
    }
    Ok(judge)
}

/// Charts of all four.
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    let (soft, hard) = (end(SOFT)?, end(HARD)?);
    let stride = |(name, title, law, end), with_events| Stride { name, title, law, with_events, end };
    let strides = [
        stride(("quadruped_soft", "ReDySim's ground, without events", SOFT, soft), false),
        stride(("quadruped_soft_events", "ReDySim's ground, with events", SOFT, soft), true),
        stride(("quadruped_hard", "Hunt and Crossley's ground, without events", HARD, hard), false),
        stride(("quadruped_hard_events", "Hunt and Crossley's ground, with events", HARD, hard), true),
    ];
    let mut panels = Vec::new();
    for stride in &strides {
        let mut panel = over_evaluations(stride, outputs)?;
        // The same axis for all.
        panel.held = vec![1e-11, 1.0];
        panels.push(panel);
    }
    let figure = Figure { columns: 2, panels, shared_legend: true };
    outputs.picture("quadruped_stride", "a stride of the quadruped, by every method", &figure)
}
