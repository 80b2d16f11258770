//! Positions in which closed loops are closed.

use std::cmp::Reverse;

use nalgebra::{DMatrix, DVector};
use redysim_model::GenericMechanism;
use redysim_runtime::{ClosedLoop, LoopClosure, LoopRows};

/// As many closed positions are compared where none has as many independent constraints as there are constraints.
const POSITIONS: usize = 2;
/// Positions from which loops are closed: the one that is given, and others spread over the coordinates.
const STARTS: usize = 6;
/// Of the largest element of the loops' Jacobian, what is roundoff in the part of a column that others leave.
const ROUNDOFF: f64 = 1e-9;

/// A position with closed loops, where possible one from which they can move.
pub fn closed_position(mechanism: &GenericMechanism, start: Vec<f64>) -> Result<Vec<f64>, String> {
    let loops = ClosedLoop::new(mechanism);
    let rest = vec![0.0; mechanism.tree().nv()];
    let starts = std::iter::once(start).chain((1..STARTS).map(|position| mechanism.tree().sample(position)));
    let (mut found, mut why) = (Vec::new(), None);
    for start in starts {
        match loops.assemble::<f64>(&start, &rest, &[]) {
            Ok(assembly) => found.push((assembly.q, assembly.rank)),
            Err(error) => why = why.or(Some(loops.with_names(error).to_string())),
        }
        let full = found.last().is_some_and(|(_, rank)| *rank == mechanism.nc());
        if full || found.len() == POSITIONS {
            break;
        }
    }
    let best = found.into_iter().min_by_key(|(_, rank)| Reverse(*rank));
    best.map(|(q, _)| q).ok_or_else(|| why.unwrap_or_default())
}

/// Velocities that determine all others at the closed position `q`, as far as possible `preferred` ones: those whose
/// columns of the loops' Jacobian depend on the columns before them, with the preferred ones last.
pub fn independent_velocities(mechanism: &GenericMechanism, q: &[f64], preferred: &[bool]) -> Vec<usize> {
    let rows: Vec<Vec<f64>> = mechanism.loop_jacobian(&q.to_vec());
    let jacobian = DMatrix::from_fn(rows.len(), preferred.len(), |row, velocity| rows[row][velocity]);
    let least = ROUNDOFF * jacobian.amax();
    let mut order: Vec<usize> = (0..preferred.len()).collect();
    order.sort_by_key(|&velocity| (preferred[velocity], Reverse(velocity)));
    let (mut basis, mut independent) = (Vec::<DVector<f64>>::new(), Vec::new());
    for velocity in order {
        let mut column = jacobian.column(velocity).into_owned();
        // Gram-Schmidt, twice, so that roundoff of the first leaves nothing.
        for direction in basis.iter().chain(&basis) {
            column.axpy(-direction.dot(&column), direction, 1.0);
        }
        match column.try_normalize(least) {
            Some(direction) => basis.push(direction),
            None => independent.push(velocity),
        }
    }
    independent.sort_unstable();
    independent
}
