//! A list of angles spread over lanes.

use super::angle::Angle;
use crate::lanes::{F64x2, F64x4, F64x8, Lanes};

/// A sine and cosine of `T`, the same for any number of lanes.
pub trait Kernel<T> {
    /// Sines and cosines of `angles`, in lanes.
    fn group<L: Angle<Number = f64> + Lanes<f64, W>, const W: usize>(angles: [T; W]) -> ([T; W], [T; W]);

    /// Sine and cosine of one angle.
    fn one(angle: T) -> (T, T);
}

/// Sines and cosines of all `angles`, several at a time: what is fastest with the target's vectors, as measured.
///
/// Where the groups begin depends on `N` only, so that none of this is left in the program: lists of up to eight become
/// straight code, in which the angles go from registers to lanes and back.
#[inline(always)]
pub fn several<K: Kernel<T>, T: Copy + Default, const N: usize>(angles: [T; N]) -> ([T; N], [T; N]) {
    let mut found = ([T::default(); N], [T::default(); N]);
    let whole = N - N % 8;
    for start in (0..whole).step_by(8) {
        eight::<K, T, N>(&angles, &mut found, start);
    }
    eight::<K, T, N>(&angles, &mut found, whole);
    found
}

/// Those of up to eight angles from `start` on.
#[inline(always)]
fn eight<K: Kernel<T>, T: Copy + Default, const N: usize>(angles: &[T; N], found: &mut ([T; N], [T; N]), start: usize) {
    let left = N - start;
    if cfg!(target_feature = "avx512f") && left > 4 {
        // One by one, since an array that is written in a loop goes through memory, where what was written in parts
        // cannot be read as a whole before it has left the processor's queue of writes.
        let at = |lane| entry(angles, start + lane);
        put(K::group::<F64x8, 8>([at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)]), found, start);
    } else {
        four::<K, T, N>(angles, found, start);
        four::<K, T, N>(angles, found, start + 4);
    }
}

/// Those of up to four angles from `start` on.
#[inline(always)]
fn four<K: Kernel<T>, T: Copy + Default, const N: usize>(angles: &[T; N], found: &mut ([T; N], [T; N]), start: usize) {
    if start + 2 < N {
        let at = |lane| entry(angles, start + lane);
        put(K::group::<F64x4, 4>([at(0), at(1), at(2), at(3)]), found, start);
    } else {
        two::<K, T, N>(angles, found, start);
        two::<K, T, N>(angles, found, start + 2);
    }
}

/// Those of up to two angles from `start` on.
#[inline(always)]
fn two<K: Kernel<T>, T: Copy + Default, const N: usize>(angles: &[T; N], found: &mut ([T; N], [T; N]), start: usize) {
    if start + 1 < N {
        put(K::group::<F64x2, 2>([entry(angles, start), entry(angles, start + 1)]), found, start);
    } else if start < N {
        let (sin, cos) = K::one(entry(angles, start));
        put(([sin], [cos]), found, start);
    }
}

/// Entry `index`, zero past the last.
#[inline(always)]
pub fn entry<T: Copy + Default, const N: usize>(angles: &[T; N], index: usize) -> T {
    if index < N { angles[index] } else { T::default() }
}

/// Writes what fits of a group from `start` on.
#[inline(always)]
pub fn put<T: Copy, const W: usize, const N: usize>(
    (sines, cosines): ([T; W], [T; W]),
    found: &mut ([T; N], [T; N]),
    start: usize,
) {
    for lane in 0..W {
        if start + lane < N {
            found.0[start + lane] = sines[lane];
            found.1[start + lane] = cosines[lane];
        }
    }
}
