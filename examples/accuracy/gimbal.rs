//! What fails on a free base: Euler angles near their gimbal, and the length of a quaternion that is not corrected.

use redysim::integrate::Tolerances;
use redysim::{
    Dop8, Dop853, ForwardSimulation, Gauss6, IntegrationError, Integrator, LengthMismatch, Ode, Ode4, Ode15s, Ode45,
    Radau5, Vector, ZeroTorque,
};

use super::problem::{Problem, Quantity, Run, timed};
use super::work_precision::over_evaluations;
use crate::common::csv::Csv;
use crate::common::figure::{Figure, Panel};
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Failure, Outputs};
use crate::scenes::floating::{DURATION, FloatingArm, PastGimbal, START, State, after, apart, arm};

/// How far from the gimbal the motion of the chart over work passes, rad.
const DISTANCE: f64 = 1e-3;
/// Steps of one size, and the tolerance, of the charts over the distance.
const STEPS: f64 = 1024.0;
const TOLERANCE: f64 = 1e-8;

/// The motion of [`Floating`](super::floating::Floating) in Euler angles.
struct InAngles(PastGimbal);

impl Problem for InAngles {
    fn name(&self) -> &'static str {
        "kr5_floating_angles"
    }
    fn title(&self) -> &'static str {
        "Euler angles, 1e-3 rad from the gimbal"
    }
    fn quantities(&self) -> &'static [Quantity] {
        &[Quantity { name: "error", what: "error of the configuration at the end on the tangent, rad or m" }]
    }
    fn duration(&self) -> f64 {
        DURATION
    }
    fn most_steps(&self) -> u64 {
        20_000
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let InAngles(motion) = self;
        let mut simulation = ForwardSimulation::new(&motion.mechanism, ZeroTorque);
        let (q, v) = &motion.start;
        let start: Vec<f64> = simulation.state(q, v);
        timed(
            || method.integrate(&mut simulation, (0.0, DURATION), start.clone()),
            |end| vec![motion.error(&end[..q.len()])],
        )
    }
}

/// An equation whose states are not corrected after accepted steps.
struct Uncorrected<O>(O);

impl<Y: Vector<f64>, O: Ode<f64, Y>> Ode<f64, Y> for Uncorrected<O> {
    fn derivative(&mut self, t: f64, y: &Y, dydt: &mut Y) {
        self.0.derivative(t, y, dydt);
    }
    fn check_lengths(&self, t: f64, y: &Y) -> Result<(), LengthMismatch> {
        self.0.check_lengths(t, y)
    }
    fn error_norm(&self, tolerances: &Tolerances<'_, f64>, error: &Y, y: &Y, z: &Y) -> f64 {
        self.0.error_norm(tolerances, error, y, z)
    }
    fn project_onto_tangent(&self, y: &Y, direction: &mut Y) {
        self.0.project_onto_tangent(y, direction);
    }
    fn tangent(&mut self, t: f64, y: &Y, direction: &Y, slope: &mut Y) -> bool {
        self.0.tangent(t, y, direction, slope)
    }
    fn coordinate_rates(&mut self, t: f64, y: &Y, rates: &mut Y) -> usize {
        self.0.coordinate_rates(t, y, rates)
    }
}

/// The motion of [`Floating`](super::floating::Floating), its quaternion left as the methods have it.
struct LengthOfQuaternion {
    arm: FloatingArm,
    end: [f64; FloatingArm::NQ],
}

impl Problem for LengthOfQuaternion {
    fn name(&self) -> &'static str {
        "kr5_floating_uncorrected"
    }
    fn title(&self) -> &'static str {
        "Quaternion without correction"
    }
    fn quantities(&self) -> &'static [Quantity] {
        &[
            Quantity { name: "length − 1", what: "how much longer or shorter than 1 the quaternion is at the end" },
            Quantity { name: "error", what: "error of the configuration at the end on the tangent, rad or m" },
        ]
    }
    fn duration(&self) -> f64 {
        DURATION
    }
    fn most_steps(&self) -> u64 {
        20_000
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let simulation = ForwardSimulation::new(&self.arm, ZeroTorque);
        let start = simulation.state(&START.0, &START.1);
        let mut uncorrected = Uncorrected(simulation);
        timed(
            || method.integrate(&mut uncorrected, (0.0, DURATION), start),
            |end| {
                let q = simulation.split(end).q;
                let length = q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
                vec![(length - 1.0).abs(), apart(&q, &self.end)]
            },
        )
    }
}

/// Error and evaluations of a method over the distance from the gimbal.
struct Sweep<'p> {
    problems: &'p [(f64, InAngles)],
    error: Panel,
    work: Panel,
    table: Table,
    csv: Csv,
}

impl Sweep<'_> {
    fn with(&mut self, name: &str, colour: usize, method: &impl Integrator<f64>) {
        let (mut errors, mut evaluations, mut cells) = (Vec::new(), Vec::new(), vec![name.to_owned()]);
        for (distance, problem) in self.problems {
            match problem.run(method) {
                Ok(run) if run.error() < 1.0 => {
                    errors.push((*distance, run.error()));
                    evaluations.push((*distance, run.evaluations));
                    self.csv.named_row(name, [*distance, run.error(), run.evaluations]);
                    cells.push(format!("{}, {:.0}", tiny(run.error()), run.evaluations));
                }
                _ => cells.push("fails".to_owned()),
            }
        }
        self.table.row(cells);
        self.error = std::mem::replace(&mut self.error, Panel::gap()).dots(name, colour, &errors);
        self.work = std::mem::replace(&mut self.work, Panel::gap()).dots(name, colour, &evaluations);
    }
}

/// Error and evaluations over the distance from the gimbal.
fn over_distance((halfway, end): (&State, &State), outputs: &mut Outputs) -> Result<[Panel; 2], Failure> {
    headline("Euler angles z, x, y over the distance from the gimbal, in rad");
    let distances = (0..=8).map(|tenth| 10_f64.powi(-tenth));
    let problems: Vec<_> = distances.map(|d| (d, InAngles(PastGimbal::at(d, halfway, end)))).collect();
    let headers: Vec<String> = problems.iter().map(|(distance, _)| format!("{distance:.0e}\nerror, work")).collect();
    let mut sweep = Sweep {
        problems: &problems,
        error: Panel::new("Euler angles, 1024 steps or rtol 1e-8", "error", "1").logarithmic().over("distance [rad]"),
        work: Panel::new("", "evaluations", "1").logarithmic().over("distance [rad]"),
        table: Table::new(&std::iter::once("").chain(headers.iter().map(String::as_str)).collect::<Vec<_>>()),
        csv: Csv::new(&["method", "distance [rad]", "error", "evaluations"].map(String::from)),
    };
    let (step, atol) = (DURATION / STEPS, TOLERANCE / 100.0);
    sweep.with("Ode4", 1, &Ode4::new(step));
    sweep.with("Dop8", 3, &Dop8::new(step));
    sweep.with("Gauss6", 5, &Gauss6::new(step));
    sweep.with("Ode45", 6, &Ode45::new().rtol(TOLERANCE).atol(atol));
    sweep.with("Dop853", 7, &Dop853::new().rtol(TOLERANCE).atol(atol));
    sweep.with("Ode15s", 8, &Ode15s::new().rtol(TOLERANCE).atol(atol));
    sweep.with("Radau5", 9, &Radau5::new().rtol(TOLERANCE).atol(atol));
    let Sweep { error, work, table, csv, .. } = sweep;
    table.print();
    remark("1024 steps of one size, or rtol 1e-8. A quaternion takes the same steps at every distance.");
    outputs.numbers("gimbal_distance", "Euler angles over the distance from the gimbal", &csv)?;
    Ok([error, work])
}

/// Charts of both.
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    let (halfway, end) = (after(0.5 * DURATION, &START), after(DURATION, &START));
    let [error, work] = over_distance((&halfway, &end), outputs)?;
    let angles = over_evaluations(&InAngles(PastGimbal::at(DISTANCE, &halfway, &end)), outputs)?;
    let length = over_evaluations(&LengthOfQuaternion { arm: arm(), end: end.0 }, outputs)?;
    let figure = Figure { columns: 2, panels: vec![angles, error, length, work], shared_legend: true };
    outputs.picture("kr5_floating_gimbal", "Euler angles near their gimbal, quaternions without correction", &figure)
}
