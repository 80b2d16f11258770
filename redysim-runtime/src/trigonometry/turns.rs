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
    // angles would be joined into vectors of 512 bits. Four that are written out, since in a loop lanes go through memory.
    let (fours, others) = angles.as_chunks_mut::<4>();
    for four in fours {
        let [a, b, c, d] = *four;
        // In this order a margin that is NaN does not replace the others.
        let least = margin(b).lesser(margin(a).lesser(A::zero()));
        if !A::zero().all_at_most(margin(d).lesser(margin(c).lesser(least))) {
            for angle in four {
                (*angle, _) = angle.one_by_one(without_turns_of_one);
            }
        }
    }
    for angle in others {
        if !is_small(*angle) {
            (*angle, _) = angle.one_by_one(without_turns_of_one);
        }
    }
    angles
}

/// What the square of the angle leaves of the largest one without turns to take away: negative in lanes with such turns.
#[inline(always)]
fn margin<A: Angle>(angle: A) -> A {
    (-angle).mul_add(angle, A::from_f64(LARGEST * LARGEST))
}

/// Whether the angle in every lane has no whole turns to take away.
#[inline(always)]
fn is_small<A: Angle>(angle: A) -> bool {
    A::zero().all_at_most(margin(angle))
}

/// One angle, and nothing of interest.
fn without_turns_of_one<A: Number>(angle: A) -> (A, A) {
    if is_small(angle) {
        return (angle, angle);
    }
    let Reduced { rounded, rest, tail } = angle.reduced();
    // Sine and cosine of the quarter turns are 0 or ±1, which tells how many there are: −1, 0, 1 or 2.
    let (sin, cos) = A::turned(rounded, A::zero(), A::one());
    let quarters = sin + (A::one() - cos) * (A::one() - sin * sin);
    let [high, low] = A::HALF_PI;
    (quarters * high + (rest + (tail + quarters * low)), angle)
}
