//! Angles without whole turns, for sums of angles.
//!
//! The sum of a joint's angle and an offset, or of the angles of joints with parallel axes, is rounded to the digits of
//! its size: at 1000 rad to 1e-13, an error that its sine then has, too. Without whole turns the terms are small.

use super::angle::{Angle, Number};
use super::reduction::Reduced;

/// Angles up to here, a little more than one turn, stay as they are: of their sums no more than the last digit is lost.
const LARGEST: f64 = 7.0;

/// The same angles, the large ones without whole turns.
#[inline(always)]
pub fn without_turns<A: Angle, const N: usize>(mut angles: [A; N]) -> [A; N] {
    // A branch for every four angles, which nearly always are small: with one for all of them the comparisons of eight
    // angles would be joined into vectors of 512 bits.
    let (fours, others) = angles.as_chunks_mut::<4>();
    for four in fours {
        if !are_small(four) {
            take_turns_off(four);
        }
    }
    if !are_small(others) {
        take_turns_off(others);
    }
    angles
}

/// Whether none of these angles, four at most, has whole turns to take off in any lane.
#[inline(always)]
fn are_small<A: Angle>(angles: &[A]) -> bool {
    let [first, others @ ..] = angles else { return true };
    let mut least = margin(*first);
    // Written out, since in a loop lanes go through memory.
    macro_rules! written_out {
        ($($index:literal)*) => {$(
            if let Some(angle) = others.get($index) {
                // In this order a margin that is NaN does not replace a number.
                least = margin(*angle).lesser(least);
            }
        )*};
    }
    written_out!(0 1 2);
    A::zero().all_at_most(least)
}

#[inline(always)]
fn take_turns_off<A: Angle>(angles: &mut [A]) {
    for angle in angles {
        (*angle, _) = angle.one_by_one(without_turns_of_one);
    }
}

/// The square of [`LARGEST`] less that of the angle: negative in lanes with whole turns to take off.
#[inline(always)]
fn margin<A: Angle>(angle: A) -> A {
    (-angle).mul_add(angle, A::from_f64(LARGEST * LARGEST))
}

/// The angle without whole turns; the second number is not used.
fn without_turns_of_one<A: Number>(angle: A) -> (A, A) {
    if are_small(&[angle]) {
        return (angle, angle);
    }
    let Reduced { rounded, rest, tail } = angle.reduced();
    // Sine and cosine of the quarter turns are 0 or ±1, which tells how many there are: −1, 0, 1 or 2.
    let (sin, cos) = A::turned(rounded, A::zero(), A::one());
    let quarters = sin + (A::one() - cos) * (A::one() - sin * sin);
    let [high, low] = A::HALF_PI;
    (quarters * high + (rest + (tail + quarters * low)), angle)
}
