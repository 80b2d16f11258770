//! How many independent velocities closed loops leave.

use crate::denoc;
use crate::generic::GenericMechanism;
use crate::model::Model;
use crate::tree::Tree;
use redysim_runtime::{ClosedLoop, LoopClosure, LoopError, LoopRows};

/// Positions from which the loops are closed, and how many of them have to succeed.
pub(crate) const STARTS: usize = 6;
const SUCCESSES: usize = 2;
/// A smaller element of the Jacobian counts as zero.
const ROUNDOFF: f64 = 1e-12;

/// The constraints that the loops of a mechanism set, and what they leave.
///
/// ```
/// use redysim_model::{Mobility, Model};
///
/// # let pendulum = "name = 'pendulum'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'rod'\nparent = 'base'\n\
/// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 1.0\ncom = [0.5, 0, 0]";
/// let pendulum = Model::from_toml(pendulum, "pendulum.toml").unwrap().model;
/// assert_eq!(Mobility::of(&pendulum), Mobility { mobility: 1, ..Mobility::default() });
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mobility {
    /// Constraints that the loops set: NC.
    pub constraints: usize,
    /// How many of them are independent: the largest rank of the loops' Jacobian at closed positions. Where no closed
    /// position was found, what the rank is unless lengths and directions conspire.
    pub rank: usize,
    /// Of each loop, in the model's order, how many of its constraints do not follow from those of the loops before it:
    /// their sum is the rank.
    pub added: Vec<usize>,
    /// Independent joint velocities: NV − rank.
    pub mobility: usize,
    /// The smallest position residual that was left, m, where the loops could not be closed from any start.
    pub position_residual: Option<f64>,
}

impl Mobility {
    /// Of a checked model. The loops are closed from a few positions, the same in every run.
    pub fn of(model: &Model) -> Mobility {
        if model.loops.is_empty() {
            return Mobility { mobility: model.dof(), ..Mobility::default() };
        }
        Mobility::found(&GenericMechanism::new(model.clone())).0
    }

    /// The same, with a closed position at which the rank was found.
    pub(crate) fn found(mechanism: &GenericMechanism) -> (Mobility, Option<Vec<f64>>) {
        let constraints = mechanism.nc();
        let (rank, added, position_residual, position) = match closed_position(mechanism) {
            // A position may be singular; the rank of the mechanism is the largest.
            Ok((q, rank)) => {
                let added = added(mechanism, rank, |loops| rank_at(mechanism.model(), loops, &q));
                (rank, added, None, Some(q))
            }
            // Without a closed position, the structure alone says what the constraints could determine.
            Err(residual) => {
                let jacobian: Vec<Vec<f64>> = mechanism.loop_jacobian(&mechanism.tree().sample(1));
                let rows: Vec<usize> = mechanism.tree().loops_of_rows().collect();
                let of_first = |loops: usize| rows.iter().filter(|cut| **cut < loops).count();
                let rank = structural_rank(&jacobian);
                let added = added(mechanism, rank, |loops| structural_rank(&jacobian[..of_first(loops)]));
                (rank, added, Some(residual), None)
            }
        };
        let mobility = mechanism.tree().nv() - rank;
        (Mobility { constraints, rank, added, mobility, position_residual }, position)
    }
}

/// How many constraints each loop sets.
pub(crate) fn constraints_of_loops(mechanism: &GenericMechanism) -> Vec<usize> {
    let count = |cut| mechanism.tree().loops_of_rows().filter(|other| *other == cut).count();
    (0..mechanism.model().loops.len()).map(count).collect()
}

/// By how much each loop raises the rank of so many `first` loops, up to `all`, the rank of all of them.
fn added(mechanism: &GenericMechanism, all: usize, first: impl Fn(usize) -> usize) -> Vec<usize> {
    let constraints = constraints_of_loops(mechanism);
    if constraints.iter().sum::<usize>() == all {
        return constraints;
    }
    let mut before = 0;
    let of_loop = |loops: usize| {
        // What is small in the first loops may be roundoff beside the others, so that their rank may be the larger one.
        let rank = if loops == constraints.len() { all } else { first(loops).clamp(before, all) };
        rank - std::mem::replace(&mut before, rank)
    };
    (1..=constraints.len()).map(of_loop).collect()
}

/// The rank of the first `count` loops at `q`, or no more than is known of all.
fn rank_at(model: &Model, count: usize, q: &[f64]) -> usize {
    let mechanism = GenericMechanism::new(Model { loops: model.loops[..count].to_vec(), ..model.clone() });
    ClosedLoop::new(&mechanism).rank::<f64>(&q.to_vec()).unwrap_or(usize::MAX)
}

/// The largest number of rows that can be paired with columns of their own in which they are not zero: what the rank
/// is, unless lengths and directions conspire (augmenting paths).
pub(crate) fn structural_rank(jacobian: &[Vec<f64>]) -> usize {
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

/// The positions from which loops are closed: the zero position, then others spread by a fixed rule.
pub(crate) fn starts(tree: &Tree) -> impl Iterator<Item = Vec<f64>> {
    std::iter::once(denoc::neutral(tree)).chain((1..STARTS).map(|start| tree.sample(start)))
}

/// A closed position at which the rank of the loops is largest, and that rank; or the smallest residual that any
/// start leaves.
fn closed_position(mechanism: &GenericMechanism) -> Result<(Vec<f64>, usize), f64> {
    let loops = ClosedLoop::new(mechanism);
    let (mut closed, mut smallest) = (Vec::<(Vec<f64>, usize)>::new(), f64::INFINITY);
    let rest = vec![0.0; mechanism.tree().nv()];
    for start in starts(mechanism.tree()) {
        match loops.assemble(&start, &rest, &[]) {
            Ok(assembly) => closed.push((assembly.q, assembly.rank)),
            Err(
                LoopError::CannotClose { position_residual, .. } | LoopError::NoConvergence { position_residual, .. },
            ) => {
                smallest = smallest.min(position_residual);
            }
            Err(_) => {}
        }
        // No position has a larger rank than a full one.
        let full = closed.last().is_some_and(|(_, rank)| *rank == mechanism.nc());
        if full || closed.len() == SUCCESSES {
            break;
        }
    }
    closed.into_iter().max_by_key(|(_, rank)| *rank).ok_or(smallest)
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
