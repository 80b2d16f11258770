//! Scenarios and results as data: they serialise and deserialise, and are read and written as the command does.

mod compute;
mod contact;
mod file;
mod in_space;
mod integrator;
mod results;
mod scenario;
mod torque;
mod trajectory;

pub use compute::{interrupt_computation, page_of_results};
pub use contact::{Contact, FrameNames, Ground};
pub use integrator::{AbsoluteTolerance, FixedStep, Integrator, Tolerances};
pub use results::{Results, Table};
pub use scenario::{Forward, Initial, Scenario, Span, Stabilisation, Values};
pub use torque::{AxisGains, Compensation, Impedance, Limits, Payload, Target, Torque};
pub use trajectory::{Through, Trajectory};

use serde::{Deserialize, Deserializer};

/// Reads a kind without keys of its own, beside which nothing may stand: without this, serde ignores what does.
fn nothing_else<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Nothing {}
    Nothing::deserialize(deserializer).map(|Nothing {}| ())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use redysim_toml::Keys;
    use serde::de::DeserializeOwned;

    use super::{
        Contact, Forward, Ground, Impedance, Initial, Integrator, Payload, Scenario, Span, Stabilisation, Target,
        Torque, Trajectory,
    };
    use crate::scenario::keys;

    /// Fails unless the fields of `T`, which `kind` selects, are the keys of a file. The message about a field that is
    /// unknown lists all fields.
    fn has<T: DeserializeOwned>(tag: &str, kind: &str, keys: &Keys) {
        let text = if tag.is_empty() { String::new() } else { format!("{tag} = '{kind}'\n") };
        let error = toml::from_str::<T>(&format!("{text}'?' = 0")).err().expect("it is unknown").message().to_owned();
        let (_, listed) = error.split_once("expected ").unwrap_or_else(|| panic!("{}: {error}", keys.owner));
        let fields: BTreeSet<_> = listed.split('`').skip(1).step_by(2).collect();
        let keys_of_file: BTreeSet<_> = keys.names().filter(|name| *name != tag && *name != keys::RUN.name).collect();
        assert_eq!(fields, keys_of_file, "{} {kind}", keys.owner);
    }

    #[test]
    fn the_fields_of_data_are_the_keys_of_files() {
        has::<Scenario>("", "", &keys::SCENARIO);
        has::<Initial>("", "", keys::INITIAL.tables[0]);
        has::<Span>("", "", keys::INVERSE.tables[0]);
        has::<Forward>("", "", keys::FORWARD.tables[0]);
        has::<Payload>("", "", keys::PAYLOAD.tables[0]);
        has::<Target>("", "", keys::POSE.tables[0]);
        let laws = ["p", "pd", "pid", "pd-gravity", "tracking-pd", "computed-torque", "impedance", "csv"];
        // The first law, `free`, has no field.
        for (law, keys) in laws.iter().zip(&keys::TORQUE.tables[1..]) {
            if *law == "impedance" {
                has::<Impedance>("law", law, keys);
            } else {
                has::<Torque>("law", law, keys);
            }
        }
        for (method, keys) in ["Ode4", "Ode45"].iter().zip(keys::INTEGRATOR.tables) {
            has::<Integrator>("method", method, keys);
        }
        let motions = ["cycloid", "constant-speed", "minimum-jerk", "csv"];
        for (motion, keys) in motions.iter().zip(keys::TRAJECTORY.tables) {
            has::<Trajectory>("kind", motion, keys);
        }
        has::<Trajectory>("kind", "cubic", &keys::VIA_POINTS);
        has::<Ground>("", "", keys::GROUND.tables[0]);
        for (law, keys) in ["redysim", "hunt-crossley"].iter().zip(keys::CONTACT.tables) {
            has::<Contact>("law", law, keys);
        }
        has::<Stabilisation>("kind", "baumgarte", &keys::BAUMGARTE);
        let counts = [keys::TORQUE.tables.len() - 1, keys::INTEGRATOR.tables.len(), keys::TRAJECTORY.tables.len()];
        assert_eq!(counts, [laws.len(), 2, motions.len()], "every kind of table is compared");
    }
}
