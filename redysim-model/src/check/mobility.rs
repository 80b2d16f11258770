//! How many independent velocities closed loops leave, against what the file seems to expect.

use crate::diagnostic::{Message, messages};
use crate::generic::GenericMechanism;
use crate::model::Model;
use redysim_runtime::LoopClosure;
use redysim_runtime::closed_loop::{ClosedLoop, LoopError};

/// Positions from which the loops are closed, and how many of them have to succeed.
const STARTS: usize = 6;
const SUCCESSES: usize = 2;
/// A smaller element of the Jacobian is none.
const ROUNDOFF: f64 = 1e-12;

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
    let rows = LoopClosure::<f64, _>::nc(&mechanism);
    let rank = match closed_positions(&mechanism) {
        // Without a closed position, the structure alone says what the conditions could determine.
        Err(gap) => {
            findings.push((None, messages::loops_stay_open(&model.name, STARTS, gap)));
            structural_rank(&mechanism.loop_jacobian(&mechanism.tree().sample(1)))
        }
        Ok(closed) => {
            // A position may be singular; the rank of the mechanism is the largest.
            let Some((q, rank)) = closed.into_iter().max_by_key(|(_, rank)| *rank) else { return findings };
            if rank < rows {
                let structural = structural_rank(&mechanism.loop_jacobian(&q));
                let (loop_index, dependent) = first_redundant_loop(model, &q);
                let counts = [rows, model.dof() - structural, model.dof() - rank];
                let message = messages::redundant_rows(&model.loops[loop_index].name, dependent, counts);
                findings.push((Some(loop_index), message));
            }
            rank
        }
    };
    let mobility = model.dof() - rank;
    let actuated = model.moving_links().filter(|link| link.actuated).count();
    if mobility == 0 {
        findings.push((None, messages::no_mobility(&model.name, model.dof(), rank)));
    } else if actuated > mobility {
        findings.push((None, messages::over_actuated(&model.name, actuated, mobility)));
    }
    findings
}

/// The largest number of rows that can be paired with columns of their own in which they are not zero: what the rank
/// is, unless lengths and directions conspire (augmenting paths).
fn structural_rank(jacobian: &[Vec<f64>]) -> usize {
    fn pair(row: usize, jacobian: &[Vec<f64>], seen: &mut [bool], rows_of: &mut [Option<usize>]) -> bool {
        for column in 0..rows_of.len() {
            if jacobian[row][column].abs() < ROUNDOFF || std::mem::replace(&mut seen[column], true) {
                continue;
            }
            if rows_of[column].is_none_or(|other| pair(other, jacobian, seen, rows_of)) {
                rows_of[column] = Some(row);
                return true;
            }
        }
        false
    }
    let columns = jacobian.first().map_or(0, Vec::len);
    let mut rows_of = vec![None; columns];
    (0..jacobian.len()).filter(|&row| pair(row, jacobian, &mut vec![false; columns], &mut rows_of)).count()
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

#[cfg(test)]
mod tests {
    use super::structural_rank;

    #[test]
    fn rows_that_share_their_only_column_have_one_between_them() {
        assert_eq!(structural_rank(&[vec![1.0, 0.0, 0.0], vec![2.0, 0.0, 0.0]]), 1);
        assert_eq!(structural_rank(&[vec![1.0, 1.0, 0.0], vec![2.0, 0.0, 0.0], vec![0.0, 3.0, 1.0]]), 3);
        // Dependent by value, not by structure.
        assert_eq!(structural_rank(&[vec![1.0, 1.0], vec![1.0, 1.0]]), 2);
        assert_eq!(structural_rank(&[]), 0);
    }
}
