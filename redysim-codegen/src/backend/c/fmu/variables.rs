//! The variables of an FMU, in the order of their value references.

use crate::backend::c::units::Units;
use redysim_model::joint::LinkJoint;
use redysim_model::{Model, PublicInterface};
use redysim_runtime::ParameterRule;
use std::ops::Range;

/// A variable.
pub struct Variable {
    pub name: String,
    pub description: String,
    pub unit: String,
    pub role: Role,
    /// The value reference of the variable of which it is the derivative.
    pub derivative_of: Option<usize>,
}

/// What a variable is to a simulation.
#[derive(Clone, Copy, PartialEq)]
pub enum Role {
    /// The time.
    Time,
    /// A parameter with its value in the model, which may not be negative if so.
    Parameter { start: f64, not_negative: bool },
    /// An input, zero at the start.
    Input,
    /// A continuous state with its start value, which is an output, too.
    State { start: f64 },
    /// The rate of a coordinate.
    Rate,
    /// A computed output.
    Output,
}

impl Role {
    /// The value at the start, if it is not computed.
    pub fn start(self) -> Option<f64> {
        match self {
            Role::Parameter { start, .. } | Role::State { start } => Some(start),
            Role::Input => Some(0.0),
            Role::Time | Role::Rate | Role::Output => None,
        }
    }
}

/// All variables, and which value references those of each kind have.
pub struct Variables {
    pub all: Vec<Variable>,
    pub parameters: Range<usize>,
    pub tau: Range<usize>,
    pub q: Range<usize>,
    pub v: Range<usize>,
    pub rates: Range<usize>,
    pub a: Range<usize>,
    pub energy: Range<usize>,
    /// The first coordinate of each quaternion.
    pub quaternions: Vec<usize>,
}

impl Variables {
    /// The variables of a model.
    pub fn of(model: &Model, interface: &PublicInterface, units: &Units) -> Variables {
        let mut neutral = Vec::new();
        let mut quaternions = Vec::new();
        for joint in model.moving_links().filter_map(LinkJoint::of) {
            if !joint.quaternion().is_empty() {
                quaternions.push(neutral.len() + joint.quaternion().start);
            }
            let first = neutral.len();
            neutral.resize(first + joint.nq(), 0.0);
            joint.neutral(&mut neutral[first..]);
        }
        let mut all = vec![Variable {
            name: "time".into(),
            description: "Time".into(),
            unit: "s".into(),
            role: Role::Time,
            derivative_of: None,
        }];
        let mut add = |variables: Vec<Variable>| {
            let first = all.len();
            all.extend(variables);
            first..all.len()
        };
        let of_parameter = |(number, unit): (&redysim_model::ParameterNumber, &String)| Variable {
            name: format!("parameters.{}", number.name),
            description: format!("Parameter {} of the model", number.name),
            unit: fmi(unit),
            role: Role::Parameter { start: number.value, not_negative: number.rule == ParameterRule::NotNegative },
            derivative_of: None,
        };
        let parameters = add(interface.parameters.iter().zip(&units.parameters).map(of_parameter).collect());
        let of = |names: &[&str], units: &[String], name: &dyn Fn(&str) -> String, what: &str, role: Role| {
            let variable = |(each, unit): (&&str, &String)| Variable {
                name: name(each),
                description: format!("{what} {each}"),
                unit: fmi(unit),
                role,
                derivative_of: None,
            };
            names.iter().zip(units).map(variable).collect::<Vec<_>>()
        };
        let [coordinates, velocities]: [Vec<&str>; 2] =
            [interface.coordinate_names().collect(), interface.velocity_names().collect()];
        let tau = add(of(&velocities, &units.forces, &|name| format!("tau.{name}"), "Joint force along", Role::Input));
        let state = |mut variables: Vec<Variable>, starts: &[f64]| {
            variables.iter_mut().zip(starts).for_each(|(variable, &start)| variable.role = Role::State { start });
            variables
        };
        let at_rest = Role::State { start: 0.0 };
        let q = of(&coordinates, &units.coordinates, &|name| format!("q.{name}"), "Coordinate", at_rest);
        let q = add(state(q, &neutral));
        let v = add(of(&velocities, &units.velocities, &|name| format!("v.{name}"), "Velocity", at_rest));
        let per_second: Vec<String> = units.coordinates.iter().map(|unit| format!("{unit}/s")).collect();
        let derivatives = |mut variables: Vec<Variable>, of: &Range<usize>| {
            variables.iter_mut().zip(of.clone()).for_each(|(variable, of)| variable.derivative_of = Some(of));
            variables
        };
        let rates =
            of(&coordinates, &per_second, &|name| format!("der(q.{name})"), "Rate of the coordinate", Role::Rate);
        let rates = add(derivatives(rates, &q));
        let a = of(&velocities, &units.accelerations, &|name| format!("a.{name}"), "Acceleration", Role::Output);
        let a = add(derivatives(a, &v));
        let joules = ["J".to_string(), "J".to_string()];
        let energy = of(&["kinetic", "potential"], &joules, &|name| format!("energy.{name}"), "Energy,", Role::Output);
        let energy = add(energy);
        Variables { all, parameters, tau, q, v, rates, a, energy, quaternions }
    }

    /// The name of each variable if all are names of the structured convention.
    pub fn are_structured(&self) -> bool {
        let is_identifier = |part: &str| {
            part.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_')
                && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        };
        self.all.iter().all(|variable| {
            let name = variable.name.strip_prefix("der(").and_then(|name| name.strip_suffix(')'));
            name.unwrap_or(&variable.name).split('.').all(is_identifier)
        })
    }
}

/// A unit as FMI writes it.
fn fmi(unit: &str) -> String {
    unit.replace(' ', ".").replace('²', "2")
}

/// The exponents of kg, m, s and rad in a unit.
pub fn exponents(unit: &str) -> [i32; 4] {
    let mut exponents = [0; 4];
    for (place, group) in unit.split('/').enumerate() {
        for factor in group.split('.') {
            let name = factor.trim_end_matches(|c: char| c.is_ascii_digit());
            let power: i32 = factor[name.len()..].parse().unwrap_or(1);
            let base = match name {
                "kg" => [1, 0, 0, 0],
                "m" => [0, 1, 0, 0],
                "s" => [0, 0, 1, 0],
                "rad" => [0, 0, 0, 1],
                "N" => [1, 1, -2, 0],
                "J" => [1, 2, -2, 0],
                // The number 1.
                _ => [0; 4],
            };
            let sign = if place == 0 { 1 } else { -1 };
            exponents.iter_mut().zip(base).for_each(|(exponent, base)| *exponent += sign * power * base);
        }
    }
    exponents
}

#[cfg(test)]
mod tests {
    use super::exponents;

    #[test]
    fn units_have_the_exponents_of_their_factors() {
        let units = [
            ("1", [0, 0, 0, 0]),
            ("1/s", [0, 0, -1, 0]),
            ("m/s2", [0, 1, -2, 0]),
            ("N.m", [1, 2, -2, 0]),
            ("N.m.s/rad", [1, 2, -1, -1]),
            ("N/m", [1, 0, -2, 0]),
            ("kg.m2", [1, 2, 0, 0]),
        ];
        for (unit, expected) in units {
            assert_eq!(exponents(unit), expected, "{unit}");
        }
    }
}
