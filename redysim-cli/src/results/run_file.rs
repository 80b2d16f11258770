//! The scenario as it was run: with every setting that it left open, and how it went.
//!
//! It is a scenario itself, beside copies of the model and the tables that it names, so that the run can be done again
//! from the folder alone.

use redysim_runtime::Statistics;
use toml_edit::{Array, DocumentMut, Item, RawString, value};

use super::names::{MODEL, RUN_FILE, TORQUE, TRAJECTORY, URDF};
use super::{Ended, Ending, Folder, Outcome, Run, Summary};
use crate::failure::Failure;
use crate::scenario::{Absolute, HeldFrame, Integrator, Scenario, Tolerances, Torque, USUAL_THROUGH, keys};

/// Writes it, and copies what it names.
pub fn write(folder: &Folder, scenario: &Scenario, summary: &Summary) -> Result<(), Failure> {
    let mut document = scenario.document.clone();
    folder.write(MODEL, scenario.model_text.as_bytes())?;
    document["model"] = value(MODEL);
    keep(document.as_item_mut(), "name", value(&scenario.name));
    let name = |joint: &usize| scenario.layout.joints[*joint].name.as_str();
    let initial = &mut document["initial"];
    keep(initial, "q", numbers(&scenario.initial.q));
    keep(initial, "v", numbers(&scenario.initial.v));
    if scenario.loops() {
        keep(initial, "assemble", value(scenario.initial.assemble));
        keep(initial, "held", value(scenario.initial.held.iter().map(name).collect::<Array>()));
    }
    if let Some(trajectory) = &scenario.trajectory {
        let table = &mut document["trajectory"];
        keep(table, "kind", value("cycloid"));
        keep(table, "joints", value(trajectory.joints.iter().map(name).collect::<Array>()));
        if let Some(read) = &trajectory.table {
            folder.write(TRAJECTORY, read.text.as_bytes())?;
            table["file"] = value(TRAJECTORY);
            keep(table, "through", value(USUAL_THROUGH));
        }
    }
    if let Some(span) = scenario.inverse {
        keep(&mut document["inverse"], "start", value(span.start));
    }
    if let Some(forward) = &scenario.forward {
        let table = &mut document["forward"];
        keep(table, "start", value(forward.span.start));
        settings(&mut table["integrator"], forward.integrator);
        named(&mut table["torque"], "law");
        keep(&mut table["torque"], "law", value("free"));
        if let Torque::Table { forces, .. } = forward.torque.unlimited() {
            folder.write(TORQUE, forces.table.text.as_bytes())?;
            table["torque"]["file"] = value(TORQUE);
        }
        if let Some(joints) = forward.torque.joints() {
            keep(&mut table["torque"], "joints", value(joints.iter().map(name).collect::<Array>()));
        }
        match forward.torque.unlimited() {
            Torque::Pid { tracking_rate, .. } => keep(&mut table["torque"], "tracking_rate", numbers(tracking_rate)),
            Torque::Impedance(held) => held_frame(&mut table["torque"], held),
            _ => {}
        }
        if scenario.loops() {
            named(&mut table["stabilisation"], "kind");
            keep(&mut table["stabilisation"], "kind", value("projection"));
        }
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

/// Sets a key to its resolved value, unless the scenario has it.
fn keep(table: &mut Item, key: &str, resolved: Item) {
    if table.get(key).is_some() {
        return;
    }
    // The blank before the brace that closes an inline table is to stand after the new value.
    if let Some((_, last)) = table.as_inline_table_mut().and_then(|table| table.iter_mut().last())
        && last.decor().suffix().and_then(RawString::as_str).is_some_and(|blank| blank.trim().is_empty())
    {
        last.decor_mut().set_suffix("");
    }
    table[key] = resolved;
}

/// A name that stands for a table becomes that table.
fn named(item: &mut Item, tag: &str) {
    if let Some(name) = item.as_str().map(str::to_owned) {
        *item = Item::None;
        item[tag] = value(name);
    }
}

fn settings(table: &mut Item, integrator: Integrator) {
    if table.is_integer() {
        *table = Item::None;
    }
    named(table, "method");
    table["method"] = value(integrator.name());
    if let Integrator::Adaptive(_, Tolerances { rtol, atol, max_step }) = integrator {
        keep(table, "rtol", number(rtol));
        keep(table, "max_step", number(max_step));
        let Absolute { position, velocity, work } = atol;
        let parts = [("position", position), ("velocity", velocity), ("work", work)];
        if table.get("atol").is_some_and(Item::is_table_like) {
            parts.into_iter().for_each(|(key, part)| keep(&mut table["atol"], key, number(part)));
        } else {
            keep(table, "atol", number(position));
        }
    }
}

fn held_frame(table: &mut Item, held: &HeldFrame) {
    keep(table, "angular_stiffness", numbers(&held.stiffness.angular));
    keep(table, "angular_damping", numbers(&held.damping.angular));
    keep(table, "compensation", value(HeldFrame::name_of(held.compensation)));
    keep(table, "null_space_damping", number(held.null_space_damping));
}

fn numbers(values: &[f64]) -> Item {
    value(values.iter().copied().collect::<Array>())
}

/// The table of how it went. A run that is done again has the URDF of the first one.
fn how_it_went(summary: &Summary, urdf: Option<String>) -> Run {
    let Summary { dynamics, instants: (from, until, count), seconds, balance, start: [q, v], outcome, .. } = summary;
    let Outcome { ended, steps, statistics, position_residual, .. } = outcome;
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
        energy_drift: balance.drift,
        energy_exchanged: balance.exchanged,
        worst_position_residual: *position_residual,
        start_q: q.clone(),
        start_v: v.clone(),
        urdf,
    }
}

/// A number that may be very small, with an exponent.
fn number(number: f64) -> Item {
    format!("{number:?}").parse().map_or_else(|_| value(number), Item::Value)
}
