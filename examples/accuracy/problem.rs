//! What is integrated, and what counts as error.

use std::time::Instant;

use redysim::integrate::Observer;
use redysim::{
    Assembly, ClosedLoop, ClosedLoopSimulation, ConfigurationSpace, ForwardSimulation, IntegrationError, Integrator,
    Ode15s, Pd, Radau5, Solution, Step, TorqueLaw, TreeDynamics, Vector, ZeroTorque,
};
use std::ops::ControlFlow;

use super::models::{DOF, DoublePendulum, Fourbar, Gripper, Kr5};
use crate::common::Failure;
use crate::common::reference::Reference;

/// One run of one method.
pub struct Run {
    /// An error for each of the problem's [`quantities`](Problem::quantities).
    pub errors: Vec<f64>,
    /// Evaluations of the right-hand side; a Jacobian counts as one for each component of the state.
    pub evaluations: f64,
    /// Wall time, ms.
    pub milliseconds: f64,
}

impl Run {
    /// The error of the problem's first quantity.
    pub fn error(&self) -> f64 {
        self.errors.first().copied().unwrap_or(f64::NAN)
    }
}

/// What the error of a problem is.
pub struct Quantity {
    /// As the axis of a chart has it.
    pub name: &'static str,
    /// In full, with its unit.
    pub what: &'static str,
}

/// A motion that any method can be tried on.
pub trait Problem {
    /// Its name, as files have it.
    fn name(&self) -> &'static str;
    /// What it is.
    fn title(&self) -> &'static str;
    /// What its errors are, the one that counts first.
    fn quantities(&self) -> &'static [Quantity] {
        &[Quantity { name: "error", what: "error of the joint angles at the end, rad" }]
    }
    /// Length of the motion, s.
    fn duration(&self) -> f64;
    /// Largest number of steps of one size that is tried.
    fn most_steps(&self) -> u64;
    /// The tolerances that are tried: 10⁻² … 10⁻¹³.
    fn tolerances(&self) -> impl Iterator<Item = f64> {
        (4..=26).map(|half| 10_f64.powf(-0.5 * f64::from(half)))
    }
    /// Integrates with `method`.
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>>
    where
        Self: Sized;
}

/// Integrates often enough to time it; `errors` judges the end.
pub fn timed<Y: Vector<f64>>(
    mut integrate: impl FnMut() -> Result<Solution<f64, Y>, IntegrationError<f64>>,
    errors: impl Fn(&Y) -> Vec<f64>,
) -> Result<Run, IntegrationError<f64>> {
    let (mut best, mut spent) = (f64::INFINITY, 0.0);
    loop {
        let begun = Instant::now();
        let Solution { y, statistics, .. } = integrate()?;
        let milliseconds = 1e3 * begun.elapsed().as_secs_f64();
        best = best.min(milliseconds);
        spent += milliseconds;
        if spent > 20.0 {
            let columns = y.as_ref().len() as u64;
            let evaluations = (statistics.evaluations + columns * statistics.jacobians) as f64;
            return Ok(Run { errors: errors(&y), evaluations, milliseconds: best });
        }
    }
}

/// The largest component of the difference of two configurations on the tangent.
fn apart<M: ConfigurationSpace<f64>>(mechanism: &M, found: &M::Coordinates, expected: &M::Coordinates) -> f64 {
    let difference = mechanism.difference(expected, found);
    difference.as_ref().iter().fold(0.0, |most, component| component.abs().max(most))
}

/// A tree that is let go or driven, judged by where its joints are at the end.
pub struct MotionProblem<M: ConfigurationSpace<f64> + 'static, L> {
    name: &'static str,
    title: &'static str,
    mechanism: &'static M,
    law: L,
    start: (M::Coordinates, M::Velocities),
    duration: f64,
    most_steps: u64,
    end: M::Coordinates,
}

impl<M: TreeDynamics<f64>, L: TorqueLaw<f64, M> + Clone> Problem for MotionProblem<M, L> {
    fn name(&self) -> &'static str {
        self.name
    }
    fn title(&self) -> &'static str {
        self.title
    }
    fn duration(&self) -> f64 {
        self.duration
    }
    fn most_steps(&self) -> u64 {
        self.most_steps
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let mut simulation = ForwardSimulation::new(self.mechanism, self.law.clone());
        let copy = ForwardSimulation::new(self.mechanism, ZeroTorque);
        let start = simulation.state(&self.start.0, &self.start.1);
        let integrate = || method.integrate(&mut simulation, (0.0, self.duration), start.clone());
        timed(integrate, |end| vec![apart(self.mechanism, &copy.split(end).q, &self.end)])
    }
}

/// The last row of a reference up to `duration`.
fn end_of<const N: usize>(text: &str, duration: f64) -> Result<[f64; N], Failure> {
    last(&Reference::motion("quad precision", text, N)?.until(duration))
}

fn last<const N: usize>(reference: &Reference) -> Result<[f64; N], Failure> {
    let row = reference.q.last().and_then(|row| row.as_slice().try_into().ok());
    row.ok_or_else(|| Failure(format!("the reference by {} has no row of {N} coordinates", reference.by)))
}

/// KR5 let go at q = 0, for a second.
pub fn kr5() -> Result<impl Problem, Failure> {
    let text = include_str!("../../tests/reference/golden_ref_kuka.csv");
    Ok(MotionProblem {
        name: "kr5_free_fall",
        title: "KR5, free fall of 1 s",
        mechanism: &Kr5,
        law: ZeroTorque,
        start: ([0.0; DOF], [0.0; DOF]),
        duration: 1.0,
        most_steps: 100_000,
        end: end_of(text, 1.0)?,
    })
}

/// The gripper let go 60° below the horizontal, for a second.
pub fn gripper() -> Result<impl Problem, Failure> {
    let text = include_str!("../../tests/reference/golden_ref_gripper_paper.csv");
    Ok(MotionProblem {
        name: "gripper_free_fall",
        title: "Gripper, free fall of 1 s",
        mechanism: &Gripper,
        law: ZeroTorque,
        start: ([-std::f64::consts::FRAC_PI_3, 0.0, 0.0, 0.0], [0.0; Gripper::NV]),
        duration: 1.0,
        most_steps: 100_000,
        end: end_of(text, 1.0)?,
    })
}

/// The law of the stiff problem: the same gains on all joints, far too many for the hand of 8 g.
pub type SpringsAndDampers = Pd<[f64; DOF], [f64; DOF]>;

/// kp = 1000 N m/rad and kd = 100 N m s/rad towards 0.5 rad.
pub const STIFF: SpringsAndDampers = Pd { target: [0.5; DOF], kp: [1e3; DOF], kd: [1e2; DOF] };

/// KR5 under a stiff PD control, for a second. As exact counts what two methods of different kinds agree on.
pub fn stiff() -> Result<impl Problem, Failure> {
    let mut problem = MotionProblem {
        name: "kr5_stiff_pd",
        title: "KR5 under PD control, kp = 1000, kd = 100, 1 s",
        mechanism: &Kr5,
        law: STIFF,
        start: ([0.0; DOF], [0.0; DOF]),
        duration: 1.0,
        most_steps: 20_000,
        end: [0.0; DOF],
    };
    let mut simulation = ForwardSimulation::new(problem.mechanism, problem.law);
    let start = simulation.state(&problem.start.0, &problem.start.1);
    let span = (0.0, problem.duration);
    let judge = Radau5::new().rtol(3e-14).atol(1e-16).integrate(&mut simulation, span, start)?;
    let other = Ode15s::new().rtol(1e-11).atol(1e-13).integrate(&mut simulation, span, start)?;
    problem.end = simulation.split(&judge.y).q;
    let apart = apart(&Kr5, &simulation.split(&other.y).q, &problem.end);
    if apart > 1e-8 {
        return Err(Failure(format!("Radau5 and Ode15s differ by {apart:.1e} rad at the end of the stiff problem")));
    }
    Ok(problem)
}

/// The paper's four-bar let go from rest, its loop held by projection, for 0.68 s.
pub struct FourbarFall {
    start: Assembly<f64, [f64; 3], [f64; 3]>,
    end: [f64; Fourbar::NQ],
}

/// See [`FourbarFall`].
pub fn fourbar() -> Result<FourbarFall, Failure> {
    let text = include_str!("../../tests/reference/golden_ref_hoken_rest_consistent.csv");
    let rows = Reference::loop_motion("quad precision", text, Fourbar::NV, 2)?.until(0.68);
    let start = ClosedLoop::new(&Fourbar).assemble(&[0.0, 0.9844, 4.3144], &[0.0; 3], &[0])?;
    Ok(FourbarFall { start, end: last(&rows)? })
}

impl Problem for FourbarFall {
    fn name(&self) -> &'static str {
        "fourbar_free_fall"
    }
    fn title(&self) -> &'static str {
        "Four-bar, free fall of 0.68 s, with projection"
    }
    fn duration(&self) -> f64 {
        0.68
    }
    fn most_steps(&self) -> u64 {
        50_000
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let mut simulation = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque);
        let copy = ClosedLoopSimulation::<f64, _, _>::new(ClosedLoop::new(&Fourbar), ZeroTorque);
        let start = simulation.assembled(&self.start);
        let integrate = || method.integrate(&mut simulation, (0.0, self.duration()), start);
        timed(integrate, |end| vec![apart(&Fourbar, &copy.split(end).q, &self.end)])
    }
}

/// A double pendulum that swings for 100 s, judged by its energy at the ends of all steps.
pub struct LongSwing;

/// Remembers how far the energy strays.
struct Energies {
    start: f64,
    worst: f64,
}

impl Energies {
    fn of(y: &[f64; 5]) -> f64 {
        DoublePendulum::energy(&[y[0], y[1]], &[y[2], y[3]]).total()
    }
}

impl Observer<f64, [f64; 5]> for Energies {
    fn needs_dense_output(&self, _from: f64, _to: f64) -> bool {
        false
    }

    fn step(&mut self, step: &Step<'_, f64, [f64; 5]>) -> ControlFlow<()> {
        self.worst = self.worst.max((Self::of(step.end().1) - self.start).abs() / self.start.abs());
        ControlFlow::Continue(())
    }
}

impl Problem for LongSwing {
    fn name(&self) -> &'static str {
        "double_pendulum_swing"
    }
    fn title(&self) -> &'static str {
        "Double pendulum, 100 s of swinging"
    }
    fn quantities(&self) -> &'static [Quantity] {
        &[Quantity { name: "error", what: "largest error of the energy, as a share of it" }]
    }
    fn duration(&self) -> f64 {
        100.0
    }
    fn most_steps(&self) -> u64 {
        1_000_000
    }
    fn run(&self, method: &impl Integrator<f64>) -> Result<Run, IntegrationError<f64>> {
        let hanging = -std::f64::consts::FRAC_PI_2;
        let mut simulation = ForwardSimulation::new(&DoublePendulum, ZeroTorque);
        let start = simulation.state(&[hanging + 0.3, 0.1], &[0.0; 2]);
        let mut energies = Energies { start: Energies::of(&start), worst: 0.0 };
        method.run(&mut simulation, (0.0, self.duration()), start, &mut energies)?;
        timed(|| method.integrate(&mut simulation, (0.0, self.duration()), start), |_| vec![energies.worst])
    }
}
