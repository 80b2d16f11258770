//! What is kept of a run: columns of its tables, each reduced to a number.

use redysim_toml::Key;
use redysim_toml::words::{did_you_mean, nearest, quoted, shortened};
use serde::{Deserialize, Serialize};

use super::keys;
use crate::failure::Failure;
use crate::results::{Ended, Format, Quantities, Row, Sink, Summary, names};
use crate::scenario::{Dynamics, Scenario};

/// How a column becomes a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Reduction {
    Last,
    Peak,
    Largest,
    Least,
    Mean,
    Rms,
}

impl Reduction {
    pub const ALL: [(Reduction, Key); 6] = [
        (Reduction::Last, keys::LAST),
        (Reduction::Peak, keys::PEAK),
        (Reduction::Largest, keys::LARGEST),
        (Reduction::Least, keys::LEAST),
        (Reduction::Mean, keys::MEAN),
        (Reduction::Rms, keys::RMS),
    ];

    fn name(self) -> &'static str {
        let named = Self::ALL.iter().find(|(reduction, _)| *reduction == self);
        named.map_or("", |(_, key)| key.name)
    }
}

/// A column of a table of the run, and how it becomes a number.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    reduction: Reduction,
    /// What is above the column, such as `tau crank [N m]`.
    quantity: String,
}

impl Outcome {
    /// What is above it in the rows: `peak tau crank [N m]`.
    pub fn header(&self) -> String {
        format!("{} {}", self.reduction.name(), self.quantity)
    }

    /// The outcomes that are `wanted` by symbol, or by symbol and name; without any, the usual ones.
    ///
    /// # Errors
    /// If the run has no such column.
    pub fn of(
        wanted: &[(Reduction, String)],
        scenario: &Scenario,
        dynamics: Dynamics,
    ) -> Result<Vec<Outcome>, Failure> {
        let usual = match dynamics {
            Dynamics::Forward => [(Reduction::Last, "q"), (Reduction::Last, "v"), (Reduction::Peak, "tau")].as_slice(),
            Dynamics::Inverse => &[(Reduction::Peak, "tau"), (Reduction::Rms, "tau")],
        };
        let usual: Vec<_> = usual.iter().map(|(reduction, symbol)| (*reduction, (*symbol).to_owned())).collect();
        let wanted = if wanted.is_empty() { &usual } else { wanted };
        let tables = Quantities::of(scenario, dynamics, Format::Csv);
        // The first column of each is the time.
        let headers = tables.iter().flat_map(|table| &table.headers[1..]);
        let labels: Vec<(&str, &String)> = headers.map(|header| (label(header), header)).collect();
        let mut outcomes: Vec<Outcome> = Vec::new();
        for (reduction, name) in wanted {
            let is_meant = |label: &str| {
                label.strip_prefix(name.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
            };
            let meant: Vec<_> = labels.iter().filter(|(label, _)| is_meant(label)).collect();
            if meant.is_empty() {
                let mut known: Vec<&str> = Vec::new();
                for (label, _) in &labels {
                    let symbol = if name.contains(' ') { label } else { label.split(' ').next().unwrap_or(label) };
                    if !known.contains(&symbol) {
                        known.push(symbol);
                    }
                }
                let message = format!("`outcomes.{}`: the run has no column {}", reduction.name(), quoted(name));
                let guess = did_you_mean(nearest(name, known.iter().copied()));
                return Err(Failure::input(message).help(format!("{guess}it has {}", shortened(&known))));
            }
            for (_, header) in meant {
                let outcome = Outcome { reduction: *reduction, quantity: (*header).clone() };
                // Positions and velocities are in two tables.
                if !outcomes.contains(&outcome) {
                    outcomes.push(outcome);
                }
            }
        }
        Ok(outcomes)
    }
}

/// What is above a column, without the unit.
fn label(header: &str) -> &str {
    header.rsplit_once(" [").map_or(header, |(label, _)| label)
}

/// What `[run]` of `run.toml` has of how a run went, kept of every sample that has it.
pub fn account(scenario: &Scenario, dynamics: Dynamics) -> Vec<&'static str> {
    let mut account = vec!["energy_drift", "energy_exchanged"];
    if scenario.loops() {
        account.push("worst_position_residual");
    }
    if dynamics == Dynamics::Forward {
        account.extend(["steps", "rejected", "evaluations"]);
    }
    account
}

/// The cells of [`account`].
fn accounted(summary: &Summary) -> Vec<String> {
    let mut cells = vec![cell(summary.balance.drift), cell(summary.balance.exchanged)];
    cells.extend(summary.outcome.position_residual.map(cell));
    let counts = summary.outcome.statistics.iter().flat_map(|of| [of.rejected, of.evaluations]);
    cells.extend(summary.outcome.steps.into_iter().chain(counts).map(|count| count.to_string()));
    cells
}

/// A number in a row: the shortest decimals that read back as exactly this.
fn cell(number: f64) -> String {
    format!("{number:?}")
}

/// What becomes of one column.
struct Reduced {
    reduction: Reduction,
    /// The table among those that are made, and the column.
    at: (usize, usize),
    value: f64,
}

/// Takes the rows of a run, of which it keeps outcomes.
pub struct Reducer {
    tables: Vec<Quantities>,
    outcomes: Vec<Reduced>,
    rows: usize,
}

/// The tables whose numbers must be finite in every run.
const ALWAYS: [&str; 4] = [names::TRAJ, names::TOR, names::ENERGY, names::LAMBDA];

impl Reducer {
    /// Takes the rows of a run of `scenario`.
    ///
    /// # Errors
    /// If one of the outcomes is not among its columns.
    pub fn new(outcomes: &[Outcome], scenario: &Scenario, dynamics: Dynamics) -> Result<Reducer, Failure> {
        let mut tables = Quantities::of(scenario, dynamics, Format::Csv);
        let has = |table: &Quantities, outcome: &Outcome| table.headers.contains(&outcome.quantity);
        // Of two tables with a column, the one that is made anyway.
        tables.sort_by_key(|table| !ALWAYS.contains(&table.name));
        let mut made = ALWAYS.to_vec();
        for outcome in outcomes {
            let Some(table) = tables.iter().find(|table| has(table, outcome)) else {
                let message = format!("the run has no column `{}`, as that of the first sample", outcome.quantity);
                return Err(Failure::input(message));
            };
            made.push(table.name);
        }
        tables.retain(|table| made.contains(&table.name));
        let reduced = outcomes.iter().filter_map(|outcome| {
            let of_table = |table: &Quantities| table.headers.iter().position(|header| *header == outcome.quantity);
            let at = tables.iter().enumerate().find_map(|(table, of)| Some((table, of_table(of)?)))?;
            let value = match outcome.reduction {
                Reduction::Largest => f64::NEG_INFINITY,
                Reduction::Least => f64::INFINITY,
                _ => 0.0,
            };
            Some(Reduced { reduction: outcome.reduction, at, value })
        });
        let outcomes = reduced.collect();
        Ok(Reducer { tables, outcomes, rows: 0 })
    }

    /// The cells of a run that came to its end: its outcomes, and how it went.
    ///
    /// # Errors
    /// Why it did not; `None` if it was interrupted.
    pub fn finish(self, summary: Summary) -> Option<Result<Vec<String>, Failure>> {
        let count = self.rows as f64;
        let value = |of: &Reduced| match of.reduction {
            Reduction::Mean => of.value / count,
            Reduction::Rms => (of.value / count).sqrt(),
            _ => of.value,
        };
        let kept = self.outcomes.iter().map(value).map(cell).chain(accounted(&summary)).collect();
        match summary.outcome.ended {
            Ended::Complete => Some(Ok(kept)),
            Ended::Failed(reason) => Some(Err(reason)),
            Ended::Interrupted => None,
        }
    }
}

impl Sink for Reducer {
    fn rows(&self, row: &Row<'_>) -> Result<Vec<Vec<f64>>, Failure> {
        self.tables.iter().map(|table| table.row(row, self.rows)).collect()
    }

    fn keep(&mut self, rows: Vec<Vec<f64>>) -> Result<(), Failure> {
        for Reduced { reduction, at: (table, column), value } in &mut self.outcomes {
            let next = rows[*table][*column];
            *value = match reduction {
                Reduction::Last => next,
                Reduction::Peak => value.max(next.abs()),
                Reduction::Largest => value.max(next),
                Reduction::Least => value.min(next),
                Reduction::Mean => *value + next,
                Reduction::Rms => *value + next * next,
            };
        }
        self.rows += 1;
        Ok(())
    }
}
