//! States in groups of as many as lanes hold, on all cores.

use super::SERIAL;
use super::packed::{Batched, Packed};
use crate::Real;
use crate::dispatch::Instructions;
use rayon::prelude::*;

/// The number of states in one task of a thread: so many that the overhead is small, so few that all cores finish at
/// about the same time.
const TASK: usize = 256;

/// Calls the function for the best instructions of the processor, `compiled`, `avx2` or `avx512`, for each group of up
/// to as many results as its lanes hold, with the index of the first.
pub fn in_groups<T: Batched, R: Send>(
    results: &mut [R],
    compiled: impl Fn(usize, &mut [R]) + Sync,
    avx2: impl Fn(usize, &mut [R]) + Sync,
    avx512: impl Fn(usize, &mut [R]) + Sync,
) {
    match Instructions::of_processor() {
        Instructions::Compiled => in_lanes::<T, T::Lanes, R>(results, compiled),
        Instructions::Avx2 => in_lanes::<T, T::Avx2, R>(results, avx2),
        Instructions::Avx512 => in_lanes::<T, T::Avx512, R>(results, avx512),
    }
}

/// Calls `group` for each group of up to as many results as the lanes hold, with the index of its first.
pub fn in_lanes<T: Real, L: Packed<T>, R: Send>(results: &mut [R], group: impl Fn(usize, &mut [R]) + Sync) {
    let one_by_one = |start: usize, results: &mut [R]| {
        L::with_target_features(
            #[inline(always)]
            || {
                for (index, results) in results.chunks_mut(L::WIDTH).enumerate() {
                    group(start + index * L::WIDTH, results);
                }
            },
        );
    };
    if results.len() <= SERIAL {
        one_by_one(0, results);
    } else {
        let tasks = results.par_chunks_mut(TASK).enumerate();
        tasks.for_each(|(task, results)| one_by_one(task * TASK, results));
    }
}

/// The part of `entries` that belongs to a group of `count` from `start` on.
#[inline(always)]
pub fn part<T>(entries: &[T], start: usize, count: usize) -> &[T] {
    entries.get(start..start + count).unwrap_or_default()
}
