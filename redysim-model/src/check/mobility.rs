//! What is odd about the loops of a model: their constraints, and the mobility they leave, against what the file seems
//! to expect.

use crate::generic::GenericMechanism;
use crate::messages;
use crate::mobility::{Mobility, STARTS, constraints_of_loops, structural_rank};
use crate::model::Model;
use redysim_runtime::LoopClosure;
use redysim_toml::Message;

/// What is odd about the loops of a model without errors: each with the index of the loop, or of none where it is the
/// mechanism as a whole.
pub(super) fn check(model: &Model) -> Vec<(Option<usize>, Message)> {
    if model.loops.is_empty() {
        return Vec::new();
    }
    let mechanism = GenericMechanism::new(model.clone());
    let empty = (0..model.loops.len()).filter(|&cut| mechanism.tree().loops_of_rows().all(|other| other != cut));
    let mut findings: Vec<_> =
        empty.map(|cut| (Some(cut), messages::loop_without_constraints(&model.loops[cut].name))).collect();
    let (found, closed) = Mobility::found(&mechanism);
    let Mobility { constraints, rank, ref added, mobility, position_residual } = found;
    if let Some(residual) = position_residual {
        findings.push((None, messages::loops_stay_open(&model.name, STARTS, residual)));
    }
    if let Some(q) = closed.filter(|_| rank < constraints) {
        let structural = structural_rank(&mechanism.loop_jacobian(&q));
        let (loop_index, dependent) = first_redundant_loop(&mechanism, added);
        let counts = [constraints, model.dof() - structural, mobility];
        let message = messages::redundant_rows(&model.loops[loop_index].name, dependent, counts);
        findings.push((Some(loop_index), message));
    }
    let actuated = model.moving_links().filter(|link| link.actuated).count();
    if mobility == 0 {
        findings.push((None, messages::no_mobility(&model.name, model.dof(), rank)));
    } else if actuated > mobility {
        findings.push((None, messages::over_actuated(&model.name, actuated, mobility)));
    }
    findings
}

/// The first loop of which some constraints follow from those before, and how many.
fn first_redundant_loop(mechanism: &GenericMechanism, added: &[usize]) -> (usize, usize) {
    let dependent =
        constraints_of_loops(mechanism).into_iter().zip(added).map(|(rows, added)| rows.saturating_sub(*added));
    dependent.enumerate().find(|(_, dependent)| *dependent > 0).unwrap_or((added.len() - 1, 0))
}
