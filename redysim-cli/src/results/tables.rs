//! The tables of a run, in this program's form and in ReDySim's.

use std::fmt::Write;

use redysim_model::GenericMechanism;
use redysim_runtime::LinkKinematics;

use super::{Folder, Record, Rows};
use crate::failure::Failure;
use crate::scenario::{Scenario, indices};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Comma-separated values, with names and units above.
    Csv,
    /// ReDySim's columns, between spaces, without names.
    Dat,
}

/// The names of all tables that there may be.
pub const NAMES: [&str; 8] = ["timevar", "statevar", "traj", "tor", "lambda", "energy", "envar", "kinematics"];

/// A table: its name, what is above the columns, and its rows.
struct Table {
    name: &'static str,
    headers: Vec<String>,
    rows: Rows,
}

/// Writes all tables of a run.
pub fn write(folder: &Folder, format: Format, scenario: &Scenario, record: &Record) -> Result<(), Failure> {
    let tables = match format {
        Format::Csv => named(scenario, record),
        Format::Dat => redysim(scenario, record),
    };
    for table in tables {
        table.check()?;
        match format {
            Format::Csv => folder.write(&format!("{}.csv", table.name), &table.csv()?)?,
            Format::Dat => folder.write(&format!("{}.dat", table.name), table.dat().as_bytes())?,
        }
    }
    Ok(())
}

/// The tables with names and units, each with the time first.
fn named(scenario: &Scenario, record: &Record) -> Vec<Table> {
    let joints = |symbol: &str, per: &str| -> Vec<String> {
        scenario.joints.iter().map(|joint| format!("{symbol} {} [{}{per}]", joint.name, joint.unit())).collect()
    };
    let forces =
        scenario.joints.iter().map(|joint| format!("tau {} [{}]", joint.name, joint.unit_of_force())).collect();
    let [q, v, a] = [("q", ""), ("v", "/s"), ("a", "/s^2")].map(|(symbol, per)| joints(symbol, per));
    let timed = |name, headers: Vec<Vec<String>>, rows: Rows| {
        let headers = std::iter::once("t [s]".to_owned()).chain(headers.into_iter().flatten()).collect();
        let rows = beside(&[&record.t.iter().map(|&t| vec![t]).collect(), &rows]);
        Table { name, headers, rows }
    };
    let mut tables = vec![
        timed("timevar", vec![], vec![vec![]; record.t.len()]),
        timed("statevar", vec![q.clone(), v.clone()], beside(&[&record.q, &record.v])),
        timed("tor", vec![forces], record.tau.clone()),
        timed("energy", vec![energy_headers()], energies(record)),
        timed("kinematics", vec![kinematics_headers(scenario)], kinematics(&scenario.mechanism, record)),
    ];
    if !record.a.is_empty() {
        tables.push(timed("traj", vec![q, v, a], beside(&[&record.q, &record.v, &record.a])));
    }
    if scenario.loops() {
        tables.push(timed("lambda", vec![lambda_headers(&scenario.mechanism)], record.lambda.clone()));
    }
    tables
}

/// ReDySim's files: the time has one of its own. Its states are q, q̇ and, of forward dynamics, the energy of the
/// actuators, which is minus their work, of inverse dynamics q̈; with closed loops its joint forces are those of the
/// actuated joints and then λ; its energies are potential, kinetic, of the actuators, and the sum of these. What it does not
/// write, kinematics and the λ of forward dynamics, is written as in the tables with names.
fn redysim(scenario: &Scenario, record: &Record) -> Vec<Table> {
    let plain = |name, rows| Table { name, headers: vec![], rows };
    let actuators: Rows = record.work.iter().map(|&work| vec![0.0 - work]).collect();
    let inverse = !record.a.is_empty();
    let states = if inverse { &record.a } else { &actuators };
    let actuated = indices(&scenario.joints, |joint| joint.actuated);
    let of_actuated = record.tau.iter().map(|row| actuated.iter().map(|&joint| row[joint]).collect()).collect();
    let energies =
        record.energy.iter().zip(&actuators).map(|(energy, actuators)| {
            vec![energy.potential, energy.kinetic, actuators[0], energy.total() + actuators[0]]
        });
    let mut tables = vec![
        plain("timevar", record.t.iter().map(|&t| vec![t]).collect()),
        plain("statevar", beside(&[&record.q, &record.v, states])),
        plain("envar", energies.collect()),
        plain("kinematics", kinematics(&scenario.mechanism, record)),
    ];
    match (scenario.loops(), inverse) {
        (true, true) => tables.push(plain("tor", beside(&[&of_actuated, &record.lambda]))),
        (true, false) => tables.extend([plain("tor", record.tau.clone()), plain("lambda", record.lambda.clone())]),
        (false, _) => tables.push(plain("tor", record.tau.clone())),
    }
    tables
}

/// Rows side by side.
fn beside(blocks: &[&Rows]) -> Rows {
    let count = blocks.first().map_or(0, |rows| rows.len());
    (0..count).map(|k| blocks.iter().flat_map(|rows| rows[k].iter().copied()).collect()).collect()
}

fn energy_headers() -> Vec<String> {
    ["kinetic", "potential", "total", "work", "drift"].map(|name| format!("{name} [J]")).to_vec()
}

fn energies(record: &Record) -> Rows {
    let drift = record.drift();
    let row = |k: usize| {
        let energy = record.energy[k];
        vec![energy.kinetic, energy.potential, energy.total(), record.work[k], drift[k]]
    };
    (0..record.t.len()).map(row).collect()
}

fn kinematics_headers(scenario: &Scenario) -> Vec<String> {
    let of_link = |name: &str| {
        let lengths = ["x", "y", "z", "com_x", "com_y", "com_z"].map(|symbol| format!("{symbol} {name} [m]"));
        let elements = (1..=3).flat_map(|row| (1..=3).map(move |column| (row, column)));
        let rotation = elements.map(|(row, column)| format!("r{row}{column} {name} [1]"));
        lengths.into_iter().chain(rotation).collect::<Vec<_>>()
    };
    scenario.mechanism.model().links.iter().flat_map(|link| of_link(&link.name)).collect()
}

fn kinematics(mechanism: &GenericMechanism, record: &Record) -> Rows {
    let row = |(q, v)| {
        let links = mechanism.link_kinematics(q, v);
        links
            .iter()
            .flat_map(|link| link.origin.into_iter().chain(link.com).chain(link.rotation.into_iter().flatten()))
            .collect()
    };
    record.q.iter().zip(&record.v).map(row).collect()
}

/// `lambda <loop> <k> [unit]` for each row: the first three rows of a cut, as far as they are kept, are forces.
fn lambda_headers(mechanism: &GenericMechanism) -> Vec<String> {
    let loops = mechanism.model().loops.iter().zip(&mechanism.tree().cuts);
    let headers = loops.flat_map(|(each, cut)| {
        let kept = cut.rows.iter().enumerate().filter(|(_, kept)| **kept);
        kept.zip(1..).map(|((row, _), k)| {
            let unit = if row < 3 { "N" } else { "N m" };
            format!("lambda {} {k} [{unit}]", each.name)
        })
    });
    headers.collect()
}

impl Table {
    /// Fails if a number is infinite or none.
    fn check(&self) -> Result<(), Failure> {
        let faulty = |row: &Vec<f64>| row.iter().position(|value| !value.is_finite());
        match self.rows.iter().enumerate().find_map(|(k, row)| Some((k, faulty(row)?))) {
            None => Ok(()),
            Some((row, column)) => {
                let name =
                    self.headers.get(column).map_or(format!("column {}", column + 1), |name| format!("`{name}`"));
                let message = format!("{}, row {}: {name} is {:?}", self.name, row + 1, self.rows[row][column]);
                Err(Failure::outside(message).help("look for a singular position or a force without bound there"))
            }
        }
    }

    fn csv(&self) -> Result<Vec<u8>, Failure> {
        let failed = |error: csv::Error| Failure::outside(format!("cannot write the table {}: {error}", self.name));
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.headers).map_err(failed)?;
        for row in &self.rows {
            writer.write_record(row.iter().map(shortest)).map_err(failed)?;
        }
        writer.into_inner().map_err(|error| Failure::outside(error.to_string()))
    }

    fn dat(&self) -> String {
        let mut text = String::new();
        for row in &self.rows {
            let numbers: Vec<_> = row.iter().map(shortest).collect();
            // A `String` takes everything.
            let _ = writeln!(text, "{}", numbers.join(" "));
        }
        text
    }
}

/// The shortest decimals that read back as exactly this number.
fn shortest(value: &f64) -> String {
    format!("{value:?}")
}
