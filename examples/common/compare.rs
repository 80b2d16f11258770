//! Deviations of a run from a reference, joint by joint.

use super::{Series, peak};

/// The largest deviation of each joint at the reference's instants, in the values' unit, and at how many instants.
/// Instants of the reference after the run's end do not count; any other must be one of the run's.
pub fn deviations(run: Series<'_>, reference: Series<'_>) -> (Vec<f64>, usize) {
    let joints = run.rows[0].len();
    let end = run.t.last().copied().unwrap_or(f64::NEG_INFINITY) + SAME;
    let pairs: Vec<_> = (0..reference.t.len())
        .filter(|&k| reference.t[k] <= end)
        .map(|k| (&run.rows[index_of(run.t, reference.t[k])], &reference.rows[k]))
        .collect();
    let of_joint = |joint: usize| peak(pairs.iter().map(|(ours, theirs)| ours[joint] - theirs[joint]));
    ((0..joints).map(of_joint).collect(), pairs.len())
}

/// Instants are equal up to the roundings of their decimals, s.
const SAME: f64 = 1e-9;

fn index_of(t: &[f64], instant: f64) -> usize {
    let index = t.partition_point(|&t| t < instant - SAME);
    assert!((t[index] - instant).abs() < SAME, "the run has no instant {instant} s");
    index
}
