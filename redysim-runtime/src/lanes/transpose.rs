//! From states, each of which lies together, to lanes, in which the same entry of several states lies together, and
//! back.

use super::Lanes;
use crate::Real;

/// Entry `i` of all `W` states in lanes, for each `i`.
///
/// ```
/// use redysim_runtime::lanes::{F64x4, pack, unpack};
///
/// let states = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0], [7.0, 8.0]];
/// let [first, second]: [F64x4; 2] = pack(&states);
/// assert_eq!(first.to_array(), [1.0, 3.0, 5.0, 7.0]);
/// assert_eq!(second.to_array(), [2.0, 4.0, 6.0, 8.0]);
/// assert_eq!(unpack([first, second]), states);
/// ```
#[inline(always)]
pub fn pack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(states: &[[T; N]; W]) -> [L; N] {
    let mut entries = [L::zero(); N];
    for (index, entry) in entries.iter_mut().enumerate() {
        let mut lanes = [T::default(); W];
        for (lane, state) in lanes.iter_mut().zip(states) {
            *lane = state[index];
        }
        *entry = L::from(lanes);
    }
    entries
}

/// The state in each lane: the inverse of [`pack`].
#[inline(always)]
pub fn unpack<L: Lanes<T, W>, T: Real, const W: usize, const N: usize>(entries: [L; N]) -> [[T; N]; W] {
    let mut states = [[T::default(); N]; W];
    for (index, entry) in entries.into_iter().enumerate() {
        let lanes: [T; W] = entry.into();
        for (state, lane) in states.iter_mut().zip(lanes) {
            state[index] = lane;
        }
    }
    states
}
