//! Whether loops close a mechanism whose tree has a singular mass matrix: a rod without mass that a loop holds moves
//! with the links at its ends.

use super::singular::pivotless;
use crate::generic::GenericMechanism;
use crate::mobility::starts;
use crate::model::Model;
use redysim_runtime::ClosedLoop;

/// Whether the mass matrix is positive definite on the velocities that closed loops leave free, at one closed position
/// at least.
///
/// M is so on the null space of J exactly if M + w JᵀJ is positive definite, for any w > 0.
pub(super) fn is_well_posed(model: &Model) -> bool {
    if model.loops.is_empty() {
        return false;
    }
    let mechanism = GenericMechanism::new(model.clone());
    let (loops, tree) = (ClosedLoop::new(&mechanism), mechanism.tree());
    let rest = vec![0.0; tree.nv()];
    starts(tree).filter_map(|start| loops.assemble(&start, &rest, &[]).ok()).any(|closed| {
        let matrix = loops.augmented_mass_matrix::<f64>(&closed.q);
        let sizes: Vec<f64> = (0..tree.nv()).map(|velocity| matrix[velocity][velocity]).collect();
        pivotless(tree, &matrix, &sizes).is_empty()
    })
}
