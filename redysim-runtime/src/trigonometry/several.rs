//! A list of angles spread over lanes.

use crate::lanes::Lanes;

/// Sine and cosine of each of `W` angles.
type Pairs<T, const W: usize> = ([T; W], [T; W]);

/// Sines and cosines of all `angles`, several at a time: by `wide` while more than `NARROW` are left, by `narrow` for
/// two and more, by `one` for the last.
///
/// Where the groups begin depends on `N` only, so that none of this is left in the program: short lists become straight
/// code, in which the angles go from registers to lanes and back.
#[inline(always)]
pub fn several<T: Copy + Default, const NARROW: usize, const WIDE: usize, const N: usize>(
    angles: [T; N],
    one: impl Fn(T) -> (T, T) + Copy,
    narrow: impl Fn([T; NARROW]) -> Pairs<T, NARROW> + Copy,
    wide: impl Fn([T; WIDE]) -> Pairs<T, WIDE> + Copy,
) -> Pairs<T, N> {
    let mut found = ([T::default(); N], [T::default(); N]);
    let mut group = |start: usize| {
        if start + NARROW < N {
            put(wide(taken(&angles, start)), &mut found, start);
        } else if start + 1 < N {
            put(narrow(taken(&angles, start)), &mut found, start);
        } else if start < N {
            (found.0[start], found.1[start]) = one(angles[start]);
        }
    };
    // One by one, since an array that is written in a loop goes through memory, where what was written in parts cannot
    // be read as a whole before it has left the processor's queue of writes.
    group(0);
    group(WIDE);
    group(2 * WIDE);
    group(3 * WIDE);
    group(4 * WIDE);
    group(5 * WIDE);
    group(6 * WIDE);
    group(7 * WIDE);
    (8 * WIDE..N).step_by(WIDE).for_each(group);
    found
}

/// Sines and cosines of `angles` by those of lanes.
#[inline(always)]
pub fn in_lanes<L: Lanes<T, W>, T, const W: usize>(angles: [T; W], sin_cos: impl Fn(L) -> (L, L)) -> Pairs<T, W> {
    let (sin, cos) = sin_cos(L::from(angles));
    // A list belongs to one state.
    (sin.apart().into(), cos.apart().into())
}

/// The angles from `start` on, and zeros past the last.
#[inline(always)]
fn taken<T: Copy + Default, const W: usize, const N: usize>(angles: &[T; N], start: usize) -> [T; W] {
    core::array::from_fn(|lane| if start + lane < N { angles[start + lane] } else { T::default() })
}

/// Writes what fits of a group from `start` on.
#[inline(always)]
fn put<T: Copy, const W: usize, const N: usize>((sines, cosines): Pairs<T, W>, found: &mut Pairs<T, N>, start: usize) {
    for lane in 0..W {
        if start + lane < N {
            found.0[start + lane] = sines[lane];
            found.1[start + lane] = cosines[lane];
        }
    }
}
