//! What is odd about the loops of a model: their constraints, and the mobility they leave, against what the file seems
//! to expect.

use crate::generic::GenericMechanism;
use crate::lint::Lint;
use crate::messages;
use crate::mobility::{Mobility, STARTS, constraints_of_loops, structural_rank};
use crate::model::{Link, Model};
use redysim_runtime::LoopClosure;
use redysim_toml::Message;

/// What is odd about the loops and the actuators of a model without errors: each with the index of the loop, or of none
/// where it is the mechanism as a whole.
pub(super) fn check(model: &Model) -> Vec<(Lint, Option<usize>, Message)> {
    let actuated = model.moving_links().flat_map(Link::actuated_velocities).filter(|actuated| *actuated).count();
    let mut findings = Vec::new();
    let mobility = if model.loops.is_empty() { model.dof() } else { closed(model, actuated, &mut findings) };
    if actuated < mobility {
        findings.push((Lint::UnderActuated, None, messages::under_actuated(&model.name, actuated, mobility)));
    }
    findings
}

/// What is odd about the loops; returns the mobility that they leave.
fn closed(model: &Model, actuated: usize, findings: &mut Vec<(Lint, Option<usize>, Message)>) -> usize {
    let mechanism = GenericMechanism::new(model.clone());
    let empty = (0..model.loops.len()).filter(|&cut| mechanism.tree().loops_of_rows().all(|other| other != cut));
    findings.extend(empty.map(|cut| {
        (Lint::LoopWithoutConstraints, Some(cut), messages::loop_without_constraints(&model.loops[cut].name))
    }));
    let (found, closed) = Mobility::found(&mechanism);
    let Mobility { constraints, rank, ref added, mobility, position_residual } = found;
    if let Some(residual) = position_residual {
        findings.push((Lint::LoopOpen, None, messages::loops_stay_open(&model.name, STARTS, residual)));
    }
    if let Some(q) = closed.filter(|_| rank < constraints) {
        let structural = structural_rank(&mechanism.loop_jacobian(&q));
        let (loop_index, dependent) = first_redundant_loop(&mechanism, added);
        let counts = [constraints, model.dof() - structural, mobility];
        let message = messages::redundant_rows(&model.loops[loop_index].name, dependent, counts);
        findings.push((Lint::RedundantConstraints, Some(loop_index), message));
    }
    if mobility == 0 {
        findings.push((Lint::NoMobility, None, messages::no_mobility(&model.name, model.dof(), rank)));
    } else if actuated > mobility {
        findings.push((Lint::OverActuated, None, messages::over_actuated(&model.name, actuated, mobility)));
    }
    mobility
}

/// The first loop of which some constraints follow from those before, and how many.
fn first_redundant_loop(mechanism: &GenericMechanism, added: &[usize]) -> (usize, usize) {
    let dependent =
        constraints_of_loops(mechanism).into_iter().zip(added).map(|(rows, added)| rows.saturating_sub(*added));
    dependent.enumerate().find(|(_, dependent)| *dependent > 0).unwrap_or((added.len() - 1, 0))
}
