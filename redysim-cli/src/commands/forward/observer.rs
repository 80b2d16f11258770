//! The observer of a run: writes the requested instants, and follows energy and position residuals at every step.

use std::ops::ControlFlow;

use redysim_runtime::integrate::algorithm::Formula;
use redysim_runtime::integrate::{ObservedStep, Observer};
use redysim_runtime::{IntegrationError, Ode, SimulationState, Step};

use super::gimbal::Gimbals;
use super::growth::{Distances, Growth};
use super::system::System;
use crate::failure::Failure;
use crate::interrupt;
use crate::results::Record;
use crate::scenario::{Forward, Ground, Scenario};

/// Writes the requested instants, and follows energy and position residuals.
pub struct RunObserver<'a, 'r> {
    scenario: &'a Scenario,
    forward: &'a Forward,
    record: &'r mut Record<'a>,
    /// The integrator has another.
    system: System<'a>,
    /// Accepted steps so far.
    pub steps: u64,
    /// The largest component of the loops' residual so far, m.
    pub position_residual: f64,
    distances: Distances,
    /// A motion that grows without bound, when it is first seen.
    pub growth: Option<Growth>,
    /// How near joints in Euler angles have come to gimbal lock.
    pub gimbals: Gimbals<'a>,
    /// Why an instant could not be written.
    pub failed: Option<Failure>,
}

impl<'a, 'r> RunObserver<'a, 'r> {
    /// Begins with the start.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn new(
        scenario: &'a Scenario,
        (forward, ground): (&'a Forward, &'a Ground<'a>),
        record: &'r mut Record<'a>,
        start: &Vec<f64>,
    ) -> Result<Self, Failure> {
        let system = System::new(scenario, forward, ground);
        let prescribed = forward.prescribed.as_ref().map_or(&[][..], |prescribed| &prescribed.velocities);
        let mut observer = RunObserver {
            scenario,
            forward,
            record,
            system,
            steps: 0,
            position_residual: 0.0,
            distances: Distances::new(),
            growth: None,
            gimbals: Gimbals::new(&scenario.layout, prescribed),
            failed: None,
        };
        observer.write(forward.span.start, start)?;
        observer.see(forward.span.start, start);
        Ok(observer)
    }

    fn write(&mut self, t: f64, state: &Vec<f64>) -> Result<(), Failure> {
        self.record.add(&self.system.sample(self.forward, t, state)?)
    }

    fn see(&mut self, t: f64, state: &Vec<f64>) {
        let SimulationState { q, v, actuator_energy } = self.system.split(t, state);
        self.record.see(&q, &v, actuator_energy);
        self.gimbals.see(t, &q);
        self.position_residual = self.position_residual.max(self.scenario.position_residual(&q));
        if self.growth.is_none() {
            let from_nowhere = self.record.balance().wrong_part().is_some();
            self.growth = self.distances.see(self.scenario, self.forward, (t, &q, self.steps), from_nowhere);
        }
    }
}

impl Observer<f64, Vec<f64>> for RunObserver<'_, '_> {
    fn needs_dense_output(&self, _from: f64, to: f64) -> bool {
        self.record.next().is_some_and(|t| t < to)
    }

    fn step(&mut self, step: &Step<'_, f64, Vec<f64>>) -> ControlFlow<()> {
        let (t, state) = step.end();
        self.steps += 1;
        self.see(t, state);
        self.record.show_progress();
        if self.failed.is_none() {
            let growth = self.growth.as_ref();
            self.failed = growth.and_then(|growth| growth.why_endless((t, self.steps), self.forward.span.end));
        }
        if self.failed.is_some() || interrupt::asked() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn observe<F: Formula<f64, Vec<f64>>, O: Ode<f64, Vec<f64>> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, f64, Vec<f64>, F, O>,
    ) -> Result<ControlFlow<()>, IntegrationError<f64>> {
        let step = observed.step();
        let (end, mut state) = (step.end().0, step.end().1.clone());
        while let Some(t) = self.record.next().filter(|&t| t <= end && !interrupt::asked()) {
            observed.write_state_at(t, &mut state)?;
            if let Err(reason) = self.write(t, &state) {
                self.failed = Some(reason);
                break;
            }
        }
        Ok(self.step(&observed.step()))
    }
}
