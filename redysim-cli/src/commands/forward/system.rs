//! What moves: a tree, or closed loops.

use redysim_runtime::{
    ClosedLoop, ClosedLoopHybridSimulation, ClosedLoopSimulation, ForcedMotion, ForwardDynamics, ForwardSimulation,
    HybridMotion, HybridSimulation, LoopError, LoopRows, Ode, SimulationState, Stabilisation, ZeroTorque,
};

use super::ground::OnGround;
use crate::failure::Failure;
use crate::layout::Component;
use crate::number::{rounded, size};
use crate::output::to_stdout;
use crate::results::{GroundSample, Sample};
use crate::scenario::{Forward, Ground, Scenario, Spread};

/// The equation of motion of a scenario, and what is known beyond it.
pub enum System<'a> {
    Tree(ForwardSimulation<'a, Ground<'a>, OnGround<'a>>),
    /// A tree of which some joints are prescribed.
    Hybrid(HybridSimulation<'a, Ground<'a>, Spread<'a>, OnGround<'a>>),
    Loops(ClosedLoopSimulation<'a, f64, Ground<'a>, OnGround<'a>>),
    /// Closed loops of which some joints are prescribed.
    HybridLoops(ClosedLoopHybridSimulation<'a, f64, Ground<'a>, Spread<'a>, OnGround<'a>>),
}

impl<'a> System<'a> {
    pub fn new(scenario: &'a Scenario, forward: &'a Forward, ground: &'a Ground<'a>) -> Self {
        let law = forward.torque.law(ground, &scenario.layout, &scenario.initial);
        let law = OnGround::new(law, ground);
        if let Some(prescribed) = &forward.prescribed {
            let motion = prescribed.trajectory.spread(&scenario.layout);
            if scenario.loops() {
                let loops = ClosedLoop::new(ground);
                let simulation = ClosedLoopHybridSimulation::new(loops, &prescribed.velocities, motion, law);
                return System::HybridLoops(simulation.stabilisation(forward.stabilisation));
            }
            System::Hybrid(HybridSimulation::new(ground, motion, law))
        } else if scenario.loops() {
            let simulation = ClosedLoopSimulation::new(ClosedLoop::new(ground), law);
            System::Loops(simulation.stabilisation(forward.stabilisation))
        } else {
            System::Tree(ForwardSimulation::new(ground, law))
        }
    }

    pub fn ode(&mut self) -> &mut dyn Ode<f64, Vec<f64>> {
        match self {
            System::Tree(simulation) => simulation,
            System::Hybrid(simulation) => simulation,
            System::Loops(simulation) => simulation,
            System::HybridLoops(simulation) => simulation,
        }
    }

    /// The parts of a state at `t`.
    pub fn split(&self, t: f64, state: &Vec<f64>) -> SimulationState<f64, Vec<f64>, Vec<f64>> {
        match self {
            System::Tree(simulation) => simulation.split(state),
            System::Hybrid(simulation) => simulation.split(t, state),
            System::Loops(simulation) => simulation.split(state),
            System::HybridLoops(simulation) => simulation.split(t, state),
        }
    }

    fn ground(&self) -> &'a Ground<'a> {
        match self {
            System::Tree(simulation) => simulation.mechanism(),
            System::Hybrid(simulation) => simulation.mechanism(),
            System::Loops(simulation) => simulation.loops().mechanism(),
            System::HybridLoops(simulation) => simulation.loops().mechanism(),
        }
    }

    /// Why there were no derivatives, if the system knows better than the integrator.
    pub fn last_error(&self) -> Option<String> {
        let (loops, reason) = match self {
            System::Tree(_) | System::Hybrid(_) => return None,
            // A law that has no forces is why the loops have no accelerations.
            System::Loops(simulation) => {
                (simulation.loops(), simulation.law().law.last_error().or(simulation.last_error())?)
            }
            System::HybridLoops(simulation) => (simulation.loops(), simulation.last_error()?),
        };
        Some(loops.with_names(reason).to_string())
    }

    /// The state to start from; loops are closed there, unless the scenario forbids it.
    pub fn start(&self, scenario: &Scenario, forward: &Forward, quiet: bool) -> Result<Vec<f64>, Failure> {
        let initial = &scenario.initial;
        let start = forward.span.start;
        let state = |q: &Vec<f64>, v: &Vec<f64>| match self {
            System::Tree(simulation) => simulation.extended_state(q, v),
            System::Hybrid(simulation) => simulation.extended_state(start, q, v),
            System::Loops(simulation) => simulation.extended_state(q, v),
            System::HybridLoops(simulation) => simulation.extended_state(start, q, v),
        };
        if !scenario.loops() {
            return Ok(state(&initial.q, &initial.v));
        }
        let loops = ClosedLoop::new(self.ground());
        let failed = |reason: LoopError<f64>| {
            let name = reason.row().and_then(|row| self.ground().loop_name(row));
            let whose = name.map_or("a loop".to_owned(), |name| format!("the loop `{name}`"));
            match reason {
                LoopError::NotClosed { position_residual, .. } => {
                    let open = size(position_residual);
                    let failure = Failure::input(format!("the start leaves {whose} open by {open} m (or a sine)"));
                    failure.help("leave `initial.assemble` out: the start is then moved until the loops are closed")
                }
                LoopError::CannotClose { position_residual, .. }
                | LoopError::NoConvergence { position_residual, .. } => {
                    let open = size(position_residual);
                    let failure = Failure::input(format!(
                        "the start cannot be moved until {whose} is closed: it stays open by {open} m (or a sine)"
                    ));
                    failure.help(
                        "give another `initial.q`, nearer to a closed position, or other joints in `initial.held`",
                    )
                }
                _ => Failure::input(format!("the start: {}", loops.with_names(reason))),
            }
        };
        if !initial.assemble {
            // Without projection, loops may be open: they stay as far open as they are, or feedback closes them.
            if forward.stabilisation == Stabilisation::Projection {
                ClosedLoopSimulation::new(loops, ZeroTorque).start(&initial.q, &initial.v).map_err(failed)?;
            }
            return Ok(state(&initial.q, &initial.v));
        }
        let closed = loops.assemble(&initial.q, &initial.v, &initial.held).map_err(failed)?;
        if !quiet {
            let changes = |components: &[Component], to: &[f64], from: &[f64], per: &str| {
                let changed = components.iter().zip(to.iter().zip(from)).filter(|(_, (to, from))| to != from);
                let by = |(component, (to, from)): (&Component, (&f64, &f64))| {
                    format!("{} by {} {}{per}", component.name, rounded(to - from), component.unit())
                };
                changed.map(by).collect::<Vec<_>>().join(", ")
            };
            let layout = &scenario.layout;
            let moved = changes(&layout.coordinates, &closed.q, &initial.q, "");
            if !moved.is_empty() {
                to_stdout(&format!("To close the loops, the start moves {moved}."));
            }
            let changed = changes(&layout.velocities, &closed.v, &initial.v, "/s");
            if !changed.is_empty() {
                to_stdout(&format!("So that they stay closed, its speeds change: {changed}."));
            }
        }
        Ok(state(&closed.q, &closed.v))
    }

    /// What is written of a state. Within a step loops are only as closed as the method is accurate; where steps are
    /// projected, so is what is written.
    pub fn sample(&mut self, forward: &Forward, t: f64, state: &Vec<f64>) -> Result<Sample, Failure> {
        let SimulationState { mut q, mut v, actuator_energy } = self.split(t, state);
        let ground = self.ground();
        let (tau, a, lambda) = match self {
            System::Tree(simulation) => {
                let tau = simulation.torque(t, state);
                let a = simulation.mechanism().forward_dynamics(&q, &v, &tau);
                (tau, a, vec![])
            }
            System::Hybrid(simulation) => {
                let HybridMotion { a, tau } = simulation.forced_motion(t, state);
                (tau, a, vec![])
            }
            System::Loops(simulation) => {
                let loops = simulation.loops();
                let failed =
                    |reason: LoopError<f64>| Failure::outside(format!("at t = {t:?} s: {}", loops.with_names(reason)));
                if forward.stabilisation == Stabilisation::Projection {
                    let closed = loops.project(&q, &v).map_err(failed)?;
                    (q, v) = (closed.q, closed.v);
                }
                let mut closed = state.clone();
                for (element, &value) in closed.iter_mut().zip(q.iter().chain(&v)) {
                    *element = value;
                }
                let forced = simulation.forced_motion(t, &closed);
                simulation.law().law.last_error().map_or(Ok(()), Err).map_err(failed)?;
                let ForcedMotion { tau, motion } = forced.map_err(failed)?;
                (tau, motion.accelerations, motion.multipliers)
            }
            System::HybridLoops(simulation) => {
                let loops = simulation.loops();
                let failed =
                    |reason: LoopError<f64>| Failure::outside(format!("at t = {t:?} s: {}", loops.with_names(reason)));
                SimulationState { q, v, .. } = simulation.closed(t, state).map_err(failed)?;
                let mut closed = state.clone();
                for (element, &value) in closed.iter_mut().zip(q.iter().chain(&v)) {
                    *element = value;
                }
                let found = simulation.forced_motion(t, &closed).map_err(failed)?;
                (found.motion.tau, found.motion.a, found.multipliers)
            }
        };
        let mut sample = GroundSample::default();
        ground.reactions(&q, &v, |_, reaction| sample.reactions.push(*reaction));
        if let (false, Some(&loss)) = (sample.reactions.is_empty(), state.last()) {
            sample.loss = loss;
        }
        // E_act is without what the ground has taken.
        let work = actuator_energy + sample.loss;
        Ok(Sample { t, q, v, a, tau, lambda, work, ground: sample })
    }
}
