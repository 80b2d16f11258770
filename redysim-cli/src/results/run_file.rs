//! The scenario as it was run: with every setting that it left open, and how it went.
//!
//! It is a scenario itself, beside copies of the model and the tables that it names, so that the run can be done again
//! from the folder alone.

use redysim_runtime::Statistics;
use toml_edit::{Array, DocumentMut, Item, TableLike, Value, value};

use super::names::{MODEL, RUN_FILE, TORQUE, TRAJECTORY, URDF, csv};
use super::{Ended, Ending, Folder, Outcome, Run, Summary};
use crate::failure::Failure;
use crate::scenario::contact::{HUNT_CROSSLEY, USUAL_EXPONENT, USUAL_NORMAL, USUAL_POINT};
use crate::scenario::{Absolute, HeldFrame, Integrator, Scenario, Tolerances, Torque, USUAL_THROUGH, keys, shorthand};
use crate::text::{self, set_default};

/// Writes it, and copies what it names.
pub fn write(folder: &Folder, scenario: &Scenario, summary: &Summary) -> Result<(), Failure> {
    let mut document = scenario.document.clone();
    folder.write(MODEL, scenario.model_text.as_bytes())?;
    document["model"] = value(MODEL);
    set_default(document.as_item_mut(), "name", value(&scenario.name));
    let names = |velocities: &[usize]| value(scenario.layout.names(velocities).into_iter().collect::<Array>());
    let initial = &mut document["initial"];
    set_default(initial, "q", numbers(&scenario.initial.q));
    set_default(initial, "v", numbers(&scenario.initial.v));
    if scenario.loops() {
        set_default(initial, "assemble", value(scenario.initial.assemble));
        set_default(initial, "held", names(&scenario.initial.held));
    }
    if let Some(trajectory) = &scenario.trajectory {
        let table = &mut document["trajectory"];
        shorthand::TRAJECTORY.expand(table);
        set_default(table, "joints", names(&trajectory.velocities));
        if let Some(read) = &trajectory.table {
            folder.write(&csv(TRAJECTORY), read.text.as_bytes())?;
            table["file"] = value(csv(TRAJECTORY));
            set_default(table, "through", value(USUAL_THROUGH));
        }
    }
    if let Some(span) = scenario.inverse {
        set_default(&mut document["inverse"], "start", value(span.start));
    }
    if let Some(forward) = &scenario.forward {
        let table = &mut document["forward"];
        set_default(table, "start", value(forward.span.start));
        settings(&mut table["integrator"], forward.integrator);
        shorthand::TORQUE.expand(&mut table["torque"]);
        if let Torque::Table { forces, .. } = forward.torque.unlimited() {
            folder.write(&csv(TORQUE), forces.table.text.as_bytes())?;
            table["torque"]["file"] = value(csv(TORQUE));
        }
        if let Some(driven) = forward.torque.driven() {
            set_default(&mut table["torque"], "joints", names(driven));
        }
        match forward.torque.unlimited() {
            Torque::Pid { tracking_rate, .. } => {
                set_default(&mut table["torque"], "tracking_rate", numbers(tracking_rate))
            }
            Torque::Impedance(held) => held_frame(&mut table["torque"], held),
            _ => {}
        }
        if scenario.loops() {
            shorthand::STABILISATION.expand(&mut table["stabilisation"]);
        }
    }
    if scenario.contacts.meet_ground {
        plane(&mut document["ground"]);
    }
    if let Some(array) = document.get_mut(keys::CONTACT.name) {
        contacts(array);
    }
    let before = document.remove(keys::RUN.name).and_then(|run| Some(run.get(URDF)?.as_str()?.to_owned()));
    let urdf = scenario.urdf.as_ref().map(|urdf| {
        let path = std::fs::canonicalize(urdf).unwrap_or_else(|_| urdf.clone());
        path.display().to_string()
    });
    let run = how_it_went(summary, urdf.or(before));
    folder.write(RUN_FILE, format!("{document}\n{}", run.to_toml()).as_bytes())
}

/// Whether the text of a file is what [`write`] has written.
pub fn is_of_a_run(text: &str) -> bool {
    let document = text.parse::<DocumentMut>();
    document.is_ok_and(|document| document.get("run").and_then(|run| run.get("redysim")).is_some())
}

fn settings(table: &mut Item, integrator: Integrator) {
    shorthand::INTEGRATOR.expand(table);
    table["method"] = value(integrator.name());
    if let Integrator::Adaptive(_, Tolerances { rtol, atol, max_step }) = integrator {
        set_default(table, "rtol", number(rtol));
        set_default(table, "max_step", number(max_step));
        let Absolute { position, velocity, work } = atol;
        let parts = [("position", position), ("velocity", velocity), ("work", work)];
        if table.get("atol").is_some_and(Item::is_table_like) {
            parts.into_iter().for_each(|(key, part)| set_default(&mut table["atol"], key, number(part)));
        } else {
            set_default(table, "atol", number(position));
        }
    }
}

/// The settings that contacts leave open, whichever way their tables are written.
fn contacts(array: &mut Item) {
    match array {
        Item::ArrayOfTables(tables) => tables.iter_mut().for_each(|table| contact(table)),
        Item::Value(Value::Array(values)) => {
            values.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|table| contact(table));
        }
        _ => {}
    }
}

fn contact(table: &mut dyn TableLike) {
    if table.get(keys::CONTACT_LAW.name).and_then(Item::as_str) == Some(HUNT_CROSSLEY) {
        table.entry(keys::EXPONENT.name).or_insert(number(USUAL_EXPONENT));
    }
    if let Some(ground) = table.get_mut(keys::CONTACT_GROUND.name) {
        plane(ground);
    }
}

fn plane(table: &mut Item) {
    set_default(table, keys::POINT.name, numbers(&USUAL_POINT));
    set_default(table, keys::NORMAL.name, numbers(&USUAL_NORMAL));
}

fn held_frame(table: &mut Item, held: &HeldFrame) {
    set_default(table, "angular_stiffness", numbers(&held.stiffness.angular));
    set_default(table, "angular_damping", numbers(&held.damping.angular));
    set_default(table, "compensation", value(HeldFrame::name_of(held.compensation)));
    set_default(table, "null_space_damping", number(held.null_space_damping));
}

fn numbers(values: &[f64]) -> Item {
    value(values.iter().copied().collect::<Array>())
}

/// The table of how it went. A run that is done again has the URDF of the first one.
fn how_it_went(summary: &Summary, urdf: Option<String>) -> Run {
    let Summary {
        dynamics, instants: (from, until, count), seconds, balance, momentum, start: [q, v], outcome, ..
    } = summary;
    let Outcome { ended, steps, statistics, position_residual, contacts, .. } = outcome;
    let (ended, reason) = match ended {
        Ended::Complete => (Ending::Complete, None),
        Ended::Interrupted => (Ending::Interrupted, None),
        Ended::Failed(reason) => (Ending::Failed, Some(reason.message().to_owned())),
    };
    let counted = |count: fn(&Statistics) -> u64| statistics.as_ref().map(count);
    Run {
        command: *dynamics,
        redysim: env!("CARGO_PKG_VERSION").to_owned(),
        ended,
        reason,
        from: *from,
        until: *until,
        instants: *count as u64,
        seconds: *seconds,
        steps: *steps,
        rejected: counted(|statistics| statistics.rejected),
        evaluations: counted(|statistics| statistics.evaluations),
        corrections: counted(|statistics| statistics.corrections),
        jacobians: counted(|statistics| statistics.jacobians),
        decompositions: counted(|statistics| statistics.decompositions),
        touch_downs: contacts.as_ref().map(|(_, touch_downs)| touch_downs.len() as u64),
        energy_drift: balance.drift,
        energy_exchanged: balance.exchanged,
        linear_momentum_drift: momentum.map(|drift| drift.linear),
        angular_momentum_drift: momentum.map(|drift| drift.angular),
        worst_position_residual: *position_residual,
        start_q: q.clone(),
        start_v: v.clone(),
        urdf,
    }
}

fn number(number: f64) -> Item {
    Item::Value(Value::Float(text::number(number)))
}
