//! How many independent velocities closed loops leave, against what the file seems to expect.

use crate::diagnostic::{Message, messages};
use crate::generic::GenericMechanism;
use crate::model::Model;
use redysim_runtime::LoopClosure;
use redysim_runtime::closed_loop::{ClosedLoop, LoopError};

/// Positions from which the loops are closed, and how many of them have to succeed.
const STARTS: usize = 6;
const SUCCESSES: usize = 2;

/// What is odd about the loops of a model without errors: each with the index of the loop, or of none where it is the
/// mechanism as a whole.
pub(super) fn check(model: &Model) -> Vec<(Option<usize>, Message)> {
    if model.loops.is_empty() {
        return Vec::new();
    }
    let mechanism = GenericMechanism::new(model.clone());
    let empty = (0..model.loops.len()).filter(|&cut| mechanism.tree().loops_of_rows().all(|other| other != cut));
    let mut findings: Vec<_> =
        empty.map(|cut| (Some(cut), messages::loop_without_conditions(&model.loops[cut].name))).collect();
    let closed = match closed_positions(&mechanism) {
        Ok(closed) => closed,
        Err(gap) => {
            findings.push((None, messages::loops_stay_open(&model.name, STARTS, gap)));
            return findings;
        }
    };
    // A position may be singular; the rank of the mechanism is the largest.
    let Some((q, rank)) = closed.into_iter().max_by_key(|(_, rank)| *rank) else { return findings };
    let rows = LoopClosure::<f64, _>::nc(&mechanism);
    let mobility = model.dof() - rank;
    let actuated = model.moving_links().filter(|link| link.actuated).count();
    if rank < rows {
        let (loop_index, dependent) = first_redundant_loop(model, &q);
        let name = &model.loops[loop_index].name;
        findings.push((Some(loop_index), messages::redundant_rows(name, dependent, [model.dof(), rows, rank])));
    }
    if mobility == 0 {
        findings.push((None, messages::no_mobility(&model.name, model.dof(), rank)));
    } else if actuated > mobility {
        findings.push((None, messages::over_actuated(&model.name, actuated, mobility)));
    }
    findings
}

/// Closed positions with the rank of the loops there, or the smallest gap that any start leaves.
fn closed_positions(mechanism: &GenericMechanism) -> Result<Vec<(Vec<f64>, usize)>, f64> {
    let loops = ClosedLoop::new(mechanism);
    let (mut closed, mut smallest) = (Vec::new(), f64::INFINITY);
    let rest = vec![0.0; mechanism.tree().dof()];
    let starts = (0..STARTS).map(|start| if start == 0 { rest.clone() } else { mechanism.tree().sample(start) });
    for start in starts {
        match loops.assemble(&start, &rest, &[]) {
            Ok(assembly) => closed.push((assembly.q, assembly.rank)),
            Err(LoopError::CannotClose { gap, .. } | LoopError::NoConvergence { gap, .. }) => {
                smallest = smallest.min(gap)
            }
            Err(_) => {}
        }
        // No position has a larger rank than a full one.
        let full = closed.last().is_some_and(|(_, rank)| *rank == LoopClosure::<f64, _>::nc(mechanism));
        if full || closed.len() == SUCCESSES {
            break;
        }
    }
    if closed.is_empty() { Err(smallest) } else { Ok(closed) }
}

/// The first loop of which some rows follow from those before at the closed position `q`, and how many.
fn first_redundant_loop(model: &Model, q: &[f64]) -> (usize, usize) {
    let rest = vec![0.0; q.len()];
    let mut before = (0, 0);
    for last in 0..model.loops.len() {
        let part = Model { loops: model.loops[..=last].to_vec(), ..model.clone() };
        let mechanism = GenericMechanism::new(part);
        let rows = LoopClosure::<f64, _>::nc(&mechanism);
        let rank = ClosedLoop::new(&mechanism).assemble(&q.to_vec(), &rest, &[]).map_or(rows, |assembly| assembly.rank);
        let dependent = (rows - before.0).saturating_sub(rank - before.1);
        if dependent > 0 {
            return (last, dependent);
        }
        before = (rows, rank);
    }
    (model.loops.len() - 1, 0)
}
