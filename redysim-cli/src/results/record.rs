//! A run, followed instant by instant.

use std::cell::RefCell;
use std::time::Instant;

use redysim_runtime::{Energy, MechanicalEnergy, Reaction};

use super::momentum::{self, MomentumDrift};
use super::tables::Row;
use super::{Balance, Ended, Outcome, Summary};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::scenario::{Dynamics, Scenario, Span};

/// What is computed of an instant.
pub struct Sample {
    /// When it is, s.
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Accelerations.
    pub a: Vec<f64>,
    /// Joint forces.
    pub tau: Vec<f64>,
    /// Multipliers of the loops' rows.
    pub lambda: Vec<f64>,
    /// The work that the actuators have done since the start, J, less what damping and friction of the joints have
    /// taken.
    pub work: f64,
    /// What the ground does.
    pub ground: GroundSample,
}

/// What the ground does at an instant.
#[derive(Default)]
pub struct GroundSample {
    /// For each contact.
    pub reactions: Vec<Reaction<f64>>,
    /// What its damping and friction have taken since the start, J.
    pub loss: f64,
}

impl GroundSample {
    /// The elastic energy that is stored in the ground, J.
    pub fn energy(&self) -> f64 {
        self.reactions.iter().map(|reaction| reaction.energy).sum()
    }
}

/// What takes the rows of a run, one after the other, a row of each of its tables at a time.
pub trait Sink {
    /// Makes the next rows.
    ///
    /// # Errors
    /// If a number is infinite or NaN.
    fn rows(&self, row: &Row<'_>) -> Result<Vec<Vec<f64>>, Failure>;

    /// Keeps them.
    ///
    /// # Errors
    /// If they cannot be written.
    fn keep(&mut self, rows: Vec<Vec<f64>>) -> Result<(), Failure>;
}

/// A run as far as it is computed. Its rows are in the sink already: however many they are, none is kept here.
pub struct Record<'a> {
    scenario: &'a Scenario,
    dynamics: Dynamics,
    span: Span,
    quiet: bool,
    warnings: RefCell<Vec<String>>,
    sink: &'a mut (dyn Sink + 'static),
    /// Why a row could not be written.
    broken: Option<Failure>,
    count: usize,
    /// Position and velocity at the first instant.
    start: [Vec<f64>; 2],
    balance: Balance,
    /// Of a motion on which nothing outside acts, as far as it is known.
    momentum: Option<MomentumDrift>,
    progress: Progress,
    begun: Instant,
}

impl<'a> Record<'a> {
    /// Begins a run of `scenario` over `span`.
    pub fn begin(
        sink: &'a mut (dyn Sink + 'static),
        scenario: &'a Scenario,
        dynamics: Dynamics,
        span: Span,
        quiet: bool,
    ) -> Record<'a> {
        Record {
            scenario,
            dynamics,
            span,
            quiet,
            warnings: RefCell::default(),
            sink,
            broken: None,
            count: 0,
            start: [vec![], vec![]],
            balance: Balance::default(),
            momentum: (dynamics == Dynamics::Forward
                && scenario.ground().contacts().is_empty()
                && momentum::floats(&scenario.mechanism))
            .then(MomentumDrift::default),
            progress: Progress::new(span.count(), quiet),
            begun: Instant::now(),
        }
    }

    /// The instant that is to be computed next; none if all are.
    pub fn next(&self) -> Option<f64> {
        (self.count < self.span.count()).then(|| self.span.instant(self.count))
    }

    /// Adds the next instant.
    ///
    /// # Errors
    /// If a number is infinite or NaN, or if it cannot be written.
    pub fn add(&mut self, sample: &Sample) -> Result<(), Failure> {
        let mechanism = &self.scenario.mechanism;
        let energy = mechanism.energy(&sample.q, &sample.v);
        let Sample { work, ground, .. } = sample;
        let with_ground = Energy { potential: energy.potential + ground.energy(), ..energy };
        let drift = self.balance.see(with_ground, work - ground.loss);
        let momentum = momentum::about_base(mechanism, &sample.q, &sample.v);
        self.momentum = self.momentum.filter(|_| !momentum::is_held(mechanism, &sample.tau));
        self.momentum.iter_mut().for_each(|drift| drift.see(momentum.0));
        let rows = self.sink.rows(&Row { scenario: self.scenario, sample, energy, drift, momentum })?;
        self.sink.keep(rows).inspect_err(|failure| self.broken = Some(failure.clone()))?;
        if self.count == 0 {
            self.start = [sample.q.clone(), sample.v.clone()];
        }
        self.count += 1;
        self.show_progress();
        Ok(())
    }

    /// Watches energy and momentum in a state between instants, too; of `work` the loss in the ground is subtracted.
    pub fn see(&mut self, q: &Vec<f64>, v: &Vec<f64>, work: f64) {
        let Scenario { mechanism, .. } = self.scenario;
        self.balance.see(self.scenario.ground().energy(q, v), work);
        self.momentum.iter_mut().for_each(|drift| drift.see(momentum::about_base(mechanism, q, v).0));
    }

    /// Shows how far it is, if one has to wait.
    pub fn show_progress(&mut self) {
        self.progress.reach(self.count);
    }

    /// Keeps a warning, and prints it unless the run is quiet.
    pub fn warn(&self, warning: &str, help: &str) {
        let warning = format!("warning: {warning}\n  = help: {help}\n");
        if !self.quiet {
            self.progress.report(&warning);
        }
        self.warnings.borrow_mut().push(warning);
    }

    /// The position at the first instant, if there is one.
    pub fn start_position(&self) -> &[f64] {
        &self.start[0]
    }

    /// How energy and work agree so far.
    pub fn balance(&self) -> &Balance {
        &self.balance
    }

    /// Ends the run. Returns how it went, and the warnings.
    ///
    /// # Errors
    /// If a row could not be written, or if it ended before there is a result.
    pub fn end(self, outcome: Outcome) -> Result<(Summary, Vec<String>), Failure> {
        if let Some(failure) = self.broken {
            return Err(failure);
        }
        // The start of a motion is not a result; the forces at its first instant are.
        let least = if self.dynamics == Dynamics::Forward { 2 } else { 1 };
        if self.count < least {
            return Err(match outcome.ended {
                Ended::Failed(reason) => reason,
                _ => Failure::interrupted("nothing was computed yet, so that nothing is written"),
            });
        }
        let summary = Summary {
            name: self.scenario.name.clone(),
            dynamics: self.dynamics,
            instants: (self.span.start, self.span.instant(self.count - 1), self.count),
            seconds: self.begun.elapsed().as_secs_f64(),
            balance: self.balance,
            momentum: self.momentum,
            start: self.start,
            outcome,
        };
        Ok((summary, self.warnings.into_inner()))
    }
}
