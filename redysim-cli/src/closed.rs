//! Positions in which closed loops are closed.

use std::cmp::Reverse;

use redysim_model::GenericMechanism;
use redysim_runtime::{ClosedLoop, LoopClosure, LoopRows};

/// As many closed positions are compared where none has as many independent constraints as there are constraints.
const POSITIONS: usize = 2;
/// Positions from which loops are closed: the one that is given, and others spread over the coordinates.
const STARTS: usize = 6;
/// Of the largest element of the loops' Jacobian, what is roundoff after its elimination.
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

/// Velocities that determine all others at the closed position `q`, as far as possible `preferred` ones: what Gaussian
/// elimination of the loops' Jacobian leaves without a pivot, with the others first.
pub fn independent_velocities(mechanism: &GenericMechanism, q: &[f64], preferred: &[bool]) -> Vec<usize> {
    let mut rows: Vec<Vec<f64>> = mechanism.loop_jacobian(&q.to_vec());
    let largest = |rows: &[Vec<f64>]| rows.iter().flatten().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let least = ROUNDOFF * largest(&rows);
    let mut order: Vec<usize> = (0..preferred.len()).collect();
    order.sort_by_key(|&velocity| (preferred[velocity], Reverse(velocity)));
    let mut independent = Vec::new();
    for velocity in order {
        let pivot = (0..rows.len()).max_by(|&a, &b| rows[a][velocity].abs().total_cmp(&rows[b][velocity].abs()));
        let Some(pivot) = pivot.filter(|&row| rows[row][velocity].abs() > least) else {
            independent.push(velocity);
            continue;
        };
        let pivot = rows.swap_remove(pivot);
        for row in &mut rows {
            let factor = row[velocity] / pivot[velocity];
            row.iter_mut().zip(&pivot).for_each(|(x, pivot)| *x -= factor * pivot);
        }
    }
    independent.sort_unstable();
    independent
}
