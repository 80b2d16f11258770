//! A run, written instant by instant.

use std::time::Instant;

use redysim_runtime::{Energy, MechanicalEnergy, Reaction};

use super::momentum::{self, MomentumDrift};
use super::tables::{Row, Tables};
use super::{Arguments, Balance, Ended, Folder, Outcome, Summary, leftover, run_file};
use crate::failure::Failure;
use crate::output::{to_stderr, to_stdout};
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

/// A run as far as it is computed. Its rows are in the files already: however many they are, none is kept in memory.
pub struct Record<'a> {
    scenario: &'a Scenario,
    dynamics: Dynamics,
    span: Span,
    quiet: bool,
    folder: Folder,
    tables: Tables,
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
    /// Begins the folder of a run of `scenario` over `span`. It is made before anything is computed, so that what
    /// cannot be written is reported at once.
    pub fn begin(
        arguments: &Arguments,
        scenario: &'a Scenario,
        dynamics: Dynamics,
        span: Span,
        quiet: bool,
    ) -> Result<Record<'a>, Failure> {
        let target = arguments.folder(scenario, dynamics);
        if !quiet {
            leftover::warnings(&target).iter().for_each(|warning| to_stderr(warning));
        }
        let folder = Folder::draft(target, arguments.force)?;
        Ok(Record {
            scenario,
            dynamics,
            span,
            quiet,
            tables: Tables::begin(&folder, arguments.format, scenario, dynamics)?,
            folder,
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
        })
    }

    /// The instant that is to be computed next; none if all are.
    pub fn next(&self) -> Option<f64> {
        (self.count < self.span.count()).then(|| self.span.instant(self.count))
    }

    /// Adds the next instant.
    ///
    /// # Errors
    /// If a number is infinite or none, or if it cannot be written.
    pub fn add(&mut self, sample: &Sample) -> Result<(), Failure> {
        let mechanism = &self.scenario.mechanism;
        let energy = mechanism.energy(&sample.q, &sample.v);
        let Sample { work, ground, .. } = sample;
        let with_ground = Energy { potential: energy.potential + ground.energy(), ..energy };
        let drift = self.balance.see(with_ground, work - ground.loss);
        let momentum = momentum::about_base(mechanism, &sample.q, &sample.v);
        self.momentum = self.momentum.filter(|_| !momentum::is_held(mechanism, &sample.tau));
        self.momentum.iter_mut().for_each(|drift| drift.see(momentum.0));
        let rows = self.tables.rows(&Row { scenario: self.scenario, sample, energy, drift, momentum })?;
        self.tables.write(&rows).inspect_err(|failure| self.broken = Some(failure.clone()))?;
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

    /// Warns, unless the run is quiet.
    pub fn warn(&self, warning: &str, help: &str) {
        if !self.quiet {
            self.progress.report(&format!("warning: {warning}\n  = help: {help}\n"));
        }
    }

    /// The position at the first instant, if there is one.
    pub fn start_position(&self) -> &[f64] {
        &self.start[0]
    }

    /// How energy and work agree so far.
    pub fn balance(&self) -> &Balance {
        &self.balance
    }

    /// Ends the run, reports how it went, and fails if it did not come to its end.
    pub fn finish(self, outcome: Outcome) -> Result<(), Failure> {
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
        self.tables.finish()?;
        run_file::write(&self.folder, self.scenario, &summary)?;
        drop(self.progress);
        let complete = matches!(summary.outcome.ended, Ended::Complete);
        let target = self.folder.finish(complete)?;
        if !self.quiet {
            to_stdout(&format!("{summary}\n  written to {}", target.display()));
        }
        let (_, until, count) = summary.instants;
        let kept = format!("{count} instants, until {until:?} s, are in {}", target.display());
        match summary.outcome.ended {
            Ended::Complete => Ok(()),
            Ended::Interrupted => Err(Failure::interrupted(kept)),
            Ended::Failed(reason) => Err(reason.and(&format!("; what was computed before is kept: {kept}"))),
        }
    }
}
