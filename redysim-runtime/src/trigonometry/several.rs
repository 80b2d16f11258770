//! A list of angles spread over lanes.

use crate::Scalar;
use crate::lanes::Lanes;

/// Sine and cosine of each of `W` angles.
type Pairs<T, const W: usize> = ([T; W], [T; W]);

/// Sines and cosines of all `angles`, several at a time: by `wide` while more than `NARROW` are left, by `narrow` for
/// two and more, by `one` for the last.
///
/// Where the groups begin depends on `N` only, so that none of this is left in the program: short lists become straight
/// code, in which the angles go from registers to lanes and back.
#[inline(always)]
pub fn several<T: Scalar + Default, const NARROW: usize, const WIDE: usize, const N: usize>(
    angles: [T; N],
    one: impl Fn(T) -> (T, T) + Copy,
    narrow: impl Fn([T; NARROW]) -> Pairs<T, NARROW> + Copy,
    wide: impl Fn([T; WIDE]) -> Pairs<T, WIDE> + Copy,
) -> Pairs<T, N> {
    let mut found = ([T::default(); N], [T::default(); N]);
    // One by one, since an array that is written in a loop goes through memory, where what was written in parts cannot
    // be read as a whole before it has left the processor's queue of writes.
    group(&angles, &mut found, 0, one, narrow, wide);
    group(&angles, &mut found, WIDE, one, narrow, wide);
    group(&angles, &mut found, 2 * WIDE, one, narrow, wide);
    group(&angles, &mut found, 3 * WIDE, one, narrow, wide);
    group(&angles, &mut found, 4 * WIDE, one, narrow, wide);
    group(&angles, &mut found, 5 * WIDE, one, narrow, wide);
    group(&angles, &mut found, 6 * WIDE, one, narrow, wide);
    group(&angles, &mut found, 7 * WIDE, one, narrow, wide);
    for start in (8 * WIDE..N).step_by(WIDE) {
        group(&angles, &mut found, start, one, narrow, wide);
    }
    found
}

/// Those of up to `WIDE` angles from `start` on.
#[inline(always)]
fn group<T: Scalar + Default, const NARROW: usize, const WIDE: usize, const N: usize>(
    angles: &[T; N],
    found: &mut Pairs<T, N>,
    start: usize,
    one: impl Fn(T) -> (T, T),
    narrow: impl Fn([T; NARROW]) -> Pairs<T, NARROW>,
    wide: impl Fn([T; WIDE]) -> Pairs<T, WIDE>,
) {
    if start + NARROW < N {
        put(wide(taken(angles, start)), found, start);
    } else if start + 1 < N {
        put(narrow(taken(angles, start)), found, start);
    } else if start < N {
        (found.0[start], found.1[start]) = one(angles[start]);
    }
}

/// Sines and cosines of `angles` by those of lanes.
#[inline(always)]
pub fn in_lanes<L: Lanes<T, W>, T: Scalar, const W: usize>(
    angles: [T; W],
    sin_cos: impl Fn(L) -> (L, L),
) -> Pairs<T, W> {
    let (sin, cos) = sin_cos(L::from(angles));
    // A list belongs to one state: sines, cosines and the next group stay in vectors of their own.
    (sin.apart().into(), cos.apart().into())
}

/// The angles from `start` on, and zeros past the last.
#[inline(always)]
fn taken<T: Scalar + Default, const W: usize, const N: usize>(angles: &[T; N], start: usize) -> [T; W] {
    let mut taken = [T::default(); W];
    for (lane, angle) in taken.iter_mut().enumerate() {
        if start + lane < N {
            *angle = angles[start + lane];
        }
    }
    taken
}

/// Writes what fits of a group from `start` on.
#[inline(always)]
fn put<T: Scalar, const W: usize, const N: usize>(
    (sines, cosines): Pairs<T, W>,
    found: &mut Pairs<T, N>,
    start: usize,
) {
    for lane in 0..W {
        if start + lane < N {
            found.0[start + lane] = sines[lane].apart();
            found.1[start + lane] = cosines[lane].apart();
        }
    }
}
