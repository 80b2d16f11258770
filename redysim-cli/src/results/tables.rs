//! The tables of a run, in this program's form and in ReDySim's: their columns, and how rows are made.

use redysim_model::GenericMechanism;
use redysim_runtime::{CenterOfMass, Energy, LinkKinematics, Momentum, Reaction};

use super::{Sample, names};
use crate::failure::Failure;
use crate::layout::{Component, Layout};
use crate::scenario::{Dynamics, Scenario};

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// Comma-separated values, with names and units above.
    Csv,
    /// ReDySim's columns, between spaces, without names.
    Dat,
}

/// What rows are made of.
pub struct Row<'a> {
    pub scenario: &'a Scenario,
    pub sample: &'a Sample,
    pub energy: Energy<f64>,
    /// What of it has come from nowhere, J.
    pub drift: f64,
    /// The angular momentum is about the origin of the base frame.
    pub momentum: (Momentum<f64>, CenterOfMass<f64>),
}

type Make = fn(&Row<'_>) -> Vec<f64>;

/// A table: its name, what is above the columns, and how a row is made.
pub struct Quantities {
    pub name: &'static str,
    pub headers: Vec<String>,
    make: Make,
}

impl Quantities {
    /// The tables of a run in a form.
    pub fn of(scenario: &Scenario, dynamics: Dynamics, format: Format) -> Vec<Quantities> {
        match format {
            Format::Csv => named(scenario),
            Format::Dat => redysim(scenario, dynamics),
        }
    }

    /// The row after so many.
    ///
    /// # Errors
    /// If a number is infinite or NaN.
    pub fn row(&self, row: &Row<'_>, above: usize) -> Result<Vec<f64>, Failure> {
        let row = (self.make)(row);
        let Some(column) = row.iter().position(|value| !value.is_finite()) else { return Ok(row) };
        let name = self.headers.get(column).map_or(format!("column {}", column + 1), |name| format!("`{name}`"));
        let message = format!("{}, row {}: {name} is {:?}", self.name, above + 1, row[column]);
        Err(Failure::outside(message).help("look for a singular position or a force without bound there"))
    }
}

impl Row<'_> {
    /// The time, and what else stands in a row.
    fn timed(&self, parts: &[&[f64]]) -> Vec<f64> {
        [&[self.sample.t], parts.concat().as_slice()].concat()
    }

    /// ReDySim's energy of the actuators is minus their work; what the ground takes is part of it.
    fn actuators(&self) -> f64 {
        self.sample.ground.loss - self.sample.work
    }

    /// Potential energy of the mechanism and the ground.
    fn potential(&self) -> f64 {
        self.energy.potential + self.sample.ground.energy()
    }

    /// Kinetic and potential energy, that of the ground with it.
    fn total(&self) -> f64 {
        self.energy.total() + self.sample.ground.energy()
    }

    fn contacts(&self) -> Vec<f64> {
        let of_contact = self.sample.ground.reactions.iter().flat_map(|reaction| {
            let Reaction { force: [x, y, z], normal_force, penetration, touching, .. } = *reaction;
            [x, y, z, normal_force, penetration, f64::from(u8::from(touching))]
        });
        of_contact.collect()
    }

    fn momentum(&self) -> Vec<f64> {
        let (Momentum { linear, angular }, CenterOfMass { position, velocity }) = self.momentum;
        [linear, angular, position, velocity].concat()
    }

    fn kinematics(&self) -> Vec<f64> {
        let links = self.scenario.mechanism.link_kinematics(&self.sample.q, &self.sample.v);
        let of_link = links
            .iter()
            .flat_map(|link| link.origin.into_iter().chain(link.com).chain(link.rotation.into_iter().flatten()));
        of_link.collect()
    }
}

/// The tables with names and units, each with the time first.
fn named(scenario: &Scenario) -> Vec<Quantities> {
    let Headers { q, v, a, forces } = Headers::of(&scenario.layout);
    let contacts = &scenario.contacts.names;
    let ground = if contacts.is_empty() { &[][..] } else { &["ground", "ground_loss"] };
    let energies = ["kinetic", "potential", "total", "work", "drift"];
    let energies: Vec<_> = energies.iter().chain(ground).map(|name| format!("{name} [J]")).collect();
    let timed = |name, headers: &[&[String]], make: Make| {
        let headers = [&["t [s]".to_owned()], headers.concat().as_slice()].concat();
        Quantities { name, headers, make }
    };
    let mut tables = vec![
        timed(names::TIMEVAR, &[], |at| at.timed(&[])),
        timed(names::STATEVAR, &[&q, &v], |at| at.timed(&[&at.sample.q, &at.sample.v])),
        timed(names::TRAJ, &[&q, &v, &a], |at| at.timed(&[&at.sample.q, &at.sample.v, &at.sample.a])),
        timed(names::TOR, &[&forces], |at| at.timed(&[&at.sample.tau])),
        timed(names::ENERGY, &[&energies], |at| {
            let Energy { kinetic, potential } = at.energy;
            let ground = [at.sample.ground.energy(), at.sample.ground.loss];
            let ground = if at.sample.ground.reactions.is_empty() { &[][..] } else { &ground };
            at.timed(&[&[kinetic, potential, at.total(), at.sample.work, at.drift], ground])
        }),
        timed(names::KINEMATICS, &[&kinematics_headers(scenario)], |at| at.timed(&[&at.kinematics()])),
        timed(names::MOMENTUM, &[&momentum_headers()], |at| at.timed(&[&at.momentum()])),
    ];
    if !contacts.is_empty() {
        tables.push(timed(names::CONTACTS, &[&contact_headers(contacts)], |at| at.timed(&[&at.contacts()])));
    }
    if scenario.loops() {
        tables.push(timed(names::LAMBDA, &[&lambda_headers(&scenario.mechanism)], |at| at.timed(&[&at.sample.lambda])));
    }
    tables
}

/// The headers of coordinates, velocities, accelerations and forces.
struct Headers {
    q: Vec<String>,
    v: Vec<String>,
    a: Vec<String>,
    forces: Vec<String>,
}

impl Headers {
    fn of(layout: &Layout) -> Self {
        let headers = |components: &[Component], header: &dyn Fn(&Component) -> String| {
            components.iter().map(header).collect::<Vec<_>>()
        };
        let [v, a] = [("v", "/s"), ("a", "/s^2")].map(|(symbol, per)| {
            headers(&layout.velocities, &|of| format!("{symbol} {} [{}{per}]", of.name, of.unit()))
        });
        Headers {
            q: headers(&layout.coordinates, &|of| format!("q {} [{}]", of.name, of.unit())),
            v,
            a,
            forces: headers(&layout.velocities, &|of| format!("tau {} [{}]", of.name, of.unit_of_force())),
        }
    }
}

/// ReDySim's files: the time has one of its own. Its states are q, q̇ and, of forward dynamics, the energy of the
/// actuators, of inverse dynamics q̈; with closed loops its joint forces are those of the actuated joints and then λ;
/// its energies are potential, kinetic, of the actuators, and the sum of these. What it does not write, kinematics,
/// momentum and the λ of forward dynamics, is written as in the tables with names.
fn redysim(scenario: &Scenario, dynamics: Dynamics) -> Vec<Quantities> {
    let plain = |name, make: Make| Quantities { name, headers: vec![], make };
    let mut tables = vec![
        plain(names::TIMEVAR, |at| vec![at.sample.t]),
        plain(names::ENVAR, |at| vec![at.potential(), at.energy.kinetic, at.actuators(), at.total() + at.actuators()]),
        plain(names::KINEMATICS, |at| at.kinematics()),
        plain(names::MOMENTUM, |at| at.momentum()),
    ];
    tables.push(match dynamics {
        Dynamics::Forward => plain(names::STATEVAR, |at| [&*at.sample.q, &at.sample.v, &[at.actuators()]].concat()),
        Dynamics::Inverse => plain(names::STATEVAR, |at| [&*at.sample.q, &at.sample.v, &at.sample.a].concat()),
    });
    if !scenario.contacts.names.is_empty() {
        tables.push(plain(names::CONTACTS, |at| at.contacts()));
    }
    match (scenario.loops(), dynamics) {
        (true, Dynamics::Inverse) => tables.push(plain(names::TOR, |at| {
            let actuated = at.scenario.actuated_velocities();
            actuated.iter().map(|&velocity| at.sample.tau[velocity]).chain(at.sample.lambda.iter().copied()).collect()
        })),
        (true, Dynamics::Forward) => {
            tables.push(plain(names::TOR, |at| at.sample.tau.clone()));
            tables.push(plain(names::LAMBDA, |at| at.sample.lambda.clone()));
        }
        (false, _) => tables.push(plain(names::TOR, |at| at.sample.tau.clone())),
    }
    tables
}

/// Linear and angular momentum, centre of mass and its velocity.
fn momentum_headers() -> Vec<String> {
    let of = |(symbol, unit): (&str, &str)| ["x", "y", "z"].map(|axis| format!("{symbol} {axis} [{unit}]"));
    [("linear", "N s"), ("angular", "N m s"), ("com", "m"), ("com_velocity", "m/s")].map(of).concat()
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

fn contact_headers(names: &[String]) -> Vec<String> {
    let symbols = [
        ("force_x", "N"),
        ("force_y", "N"),
        ("force_z", "N"),
        ("normal", "N"),
        ("penetration", "m"),
        ("touching", "1"),
    ];
    let of_contact = |name: &String| symbols.map(|(symbol, unit)| format!("{symbol} {name} [{unit}]"));
    names.iter().flat_map(of_contact).collect()
}

/// `lambda <loop> <k> [unit]` for each row of a cut that is kept.
fn lambda_headers(mechanism: &GenericMechanism) -> Vec<String> {
    let loops = mechanism.model().loops.iter().zip(&mechanism.tree().cuts);
    let headers = loops.flat_map(|(each, cut)| {
        let kept = cut.rows.iter().enumerate().filter(|(_, kept)| **kept);
        kept.zip(1..).map(|((row, _), k)| {
            let unit = cut.joint.rows()[row].measure().unit_of_force();
            format!("lambda {} {k} [{unit}]", each.name)
        })
    });
    headers.collect()
}

#[cfg(test)]
mod tests {
    use super::Headers;
    use crate::layout::tests::free_base_with_arm;

    #[test]
    fn a_free_joint_has_columns_for_seven_coordinates_and_six_velocities() {
        let Headers { q, v, a, forces } = Headers::of(&free_base_with_arm());
        assert_eq!([q.len(), v.len(), a.len(), forces.len()], [8, 7, 7, 7]);
        assert_eq!((&*q[0], &*q[6], &*q[7]), ("q base.x [m]", "q base.qw [1]", "q arm [rad]"));
        assert_eq!((&*v[2], &*v[3], &*v[6]), ("v base.vz [m/s]", "v base.wx [rad/s]", "v arm [rad/s]"));
        assert_eq!((&*a[5], &*forces[0], &*forces[5]), ("a base.wz [rad/s^2]", "tau base.vx [N]", "tau base.wz [N m]"));
    }
}
