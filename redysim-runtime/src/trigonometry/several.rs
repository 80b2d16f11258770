//! A list of angles spread over lanes.

use crate::lanes::Lanes;
use crate::scalar::Scalar;

/// Sine and cosine of each of `W` angles.
type Pairs<T, const W: usize> = ([T; W], [T; W]);

/// Sines and cosines of all `angles`, several at a time: in `Wide` lanes while more than `NARROW` are left, in `Narrow`
/// ones for two and more, and the last alone.
///
/// Where the groups begin depends on `N` only, so that none of this is left in the program: short lists become straight
/// code, in which the angles go from registers to lanes and back.
#[inline(always)]
pub fn several<T, Narrow, Wide, const NARROW: usize, const WIDE: usize, const N: usize>(angles: [T; N]) -> Pairs<T, N>
where
    T: Scalar + Default,
    Narrow: Lanes<T, NARROW>,
    Wide: Lanes<T, WIDE>,
{
    let mut found = ([T::default(); N], [T::default(); N]);
    // One by one, since an array that is written in a loop goes through memory, where what was written in parts cannot
    // be read as a whole before it has left the processor's queue of writes.
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 0);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 2 * WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 3 * WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 4 * WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 5 * WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 6 * WIDE);
    group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, 7 * WIDE);
    for start in (8 * WIDE..N).step_by(WIDE) {
        group::<T, Narrow, Wide, NARROW, WIDE, N>(&angles, &mut found, start);
    }
    found
}

/// Those of up to `WIDE` angles from `start` on.
#[inline(always)]
fn group<T, Narrow, Wide, const NARROW: usize, const WIDE: usize, const N: usize>(
    angles: &[T; N],
    found: &mut Pairs<T, N>,
    start: usize,
) where
    T: Scalar + Default,
    Narrow: Lanes<T, NARROW>,
    Wide: Lanes<T, WIDE>,
{
    if start + NARROW < N {
        put(in_lanes::<T, Wide, WIDE, N>(angles, start), found, start);
    } else if start + 1 < N {
        put(in_lanes::<T, Narrow, NARROW, N>(angles, start), found, start);
    } else if start < N {
        (found.0[start], found.1[start]) = angles[start].sin_cos();
    }
}

/// Those of as many angles from `start` on as the lanes hold.
#[inline(always)]
fn in_lanes<T: Scalar + Default, L: Lanes<T, W>, const W: usize, const N: usize>(
    angles: &[T; N],
    start: usize,
) -> Pairs<T, W> {
    let (sin, cos) = L::from(taken(angles, start)).sin_cos();
    // A list belongs to one state: sines, cosines and the next group stay in vectors of their own.
    let [sin, cos] = L::apart([sin, cos]);
    (sin.into(), cos.into())
}

/// The angles from `start` on, and zeros past the last.
#[inline(always)]
fn taken<T: Scalar + Default, const W: usize, const N: usize>(angles: &[T; N], start: usize) -> [T; W] {
    if let Some(whole) = angles.get(start..).and_then(|angles| angles.first_chunk()) {
        return *whole;
    }
    let mut taken = [T::default(); W];
    for (lane, angle) in taken.iter_mut().enumerate() {
        if start + lane < N {
            *angle = angles[start + lane];
        }
    }
    taken
}

/// The same numbers; where only `count` of them are wanted, the last of these apart from the others.
///
/// Of a group that is not full LLVM would make stores with a mask, which hold up whatever reads them next.
#[inline(always)]
fn last_apart<T: Scalar, const W: usize>(mut numbers: [T; W], count: usize) -> [T; W] {
    if count >= W {
        return numbers;
    }
    [numbers[count - 1]] = T::apart([numbers[count - 1]]);
    numbers
}

/// Writes what fits of a group from `start` on, sine and cosine in turn: LLVM joins the stores of neighbouring vectors.
#[inline(always)]
fn put<T: Scalar, const W: usize, const N: usize>(
    (sines, cosines): Pairs<T, W>,
    found: &mut Pairs<T, N>,
    start: usize,
) {
    let (sines, cosines) = (last_apart(sines, N - start), last_apart(cosines, N - start));
    for lane in 0..W {
        if start + lane < N {
            found.0[start + lane] = sines[lane];
            found.1[start + lane] = cosines[lane];
        }
    }
}
