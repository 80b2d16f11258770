//! Angles one after the other, each of which is lanes.

use super::angle::Angle;
use super::fast_path::{is_accurate, slow_path};

/// Sines and cosines of all `angles`: straight code for up to 28 of them, with one branch, by which all are computed again if
/// one of them needs the slow path.
///
/// In a loop, sines and cosines go through memory. Copies of lanes there may be made in pieces (LLVM moves 512 bits by two
/// times 256 on processors of Intel), and to read as a whole what was written in pieces stalls the processor. Straight code
/// for more angles would take more than half of an instruction cache of 32 KiB.
#[inline(always)]
pub fn in_turn<A: Angle, const N: usize>(angles: [A; N]) -> ([A; N], [A; N]) {
    let zero = A::from_f64(0.0);
    let (mut sines, mut cosines) = ([zero; N], [zero; N]);
    if N > 28 {
        for ((sin, cos), angle) in sines.iter_mut().zip(&mut cosines).zip(&angles) {
            (*sin, *cos) = angle.sin_cos();
        }
        return (sines, cosines);
    }
    let mut least = zero;
    macro_rules! straight {
        ($($index:literal)*) => {$(
            if $index < N {
                let (angle, margin) = angles[$index].fast_reduction();
                (sines[$index], cosines[$index]) = A::evaluated(angle);
                // In this order a margin that is NaN, as that of an infinite angle, does not replace the others.
                least = margin.lesser(least);
            }
        )*};
    }
    straight!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27);
    if is_accurate(least) {
        return (sines, cosines);
    }
    let mut negatives = angles;
    for angle in &mut negatives {
        *angle = -*angle;
    }
    of_negatives(negatives)
}

/// Sines and cosines of the negatives of `angles`, of which some need the slow path.
///
/// The caller passes negatives so that only these are written to memory for the call, and its angles stay in registers.
#[cold]
#[inline(never)]
fn of_negatives<A: Angle, const N: usize>(angles: [A; N]) -> ([A; N], [A; N]) {
    A::with_target_features(
        #[inline(always)]
        || {
            let zero = A::from_f64(0.0);
            let (mut sines, mut cosines) = ([zero; N], [zero; N]);
            for ((sin, cos), angle) in sines.iter_mut().zip(&mut cosines).zip(&angles) {
                (*sin, *cos) = (-*angle).one_by_one(slow_path);
            }
            (sines, cosines)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::F64x4;
    use crate::scalar::Scalar;

    fn are_those_of_each_angle<const N: usize>() {
        let angles: [F64x4; N] =
            core::array::from_fn(|i| F64x4::from([0.1, -2.0, 300.0, 4e10].map(|x| x * (1.0 + i as f64))));
        let (sines, cosines) = in_turn(angles);
        for (index, angle) in angles.into_iter().enumerate() {
            let (sin, cos) = angle.sin_cos();
            let bits = |lanes: F64x4| <[f64; 4]>::from(lanes).map(f64::to_bits);
            assert_eq!([sines[index], cosines[index]].map(bits), [sin, cos].map(bits), "angle {index} of {N}");
        }
    }

    #[test]
    fn an_angle_of_many_turns_is_accurate_beside_angles_that_are_not_finite() {
        for order in [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 0, 1], [1, 2, 0], [2, 1, 0]] {
            for beside in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                let angles = order.map(|index| F64x4::from([[1e300, beside, 0.5][index]; 4]));
                let (sines, cosines) = in_turn(angles);
                for (place, angle) in angles.into_iter().enumerate() {
                    let [angle, ..]: [f64; 4] = angle.into();
                    let [[sin, ..], [cos, ..]] = [sines, cosines].map(|found| <[f64; 4]>::from(found[place]));
                    let (expected_sin, expected_cos) = (libm::sin(angle), libm::cos(angle));
                    assert!((sin - expected_sin).abs() < 1e-15 || !angle.is_finite(), "sin({angle:e}) is {sin}");
                    assert!((cos - expected_cos).abs() < 1e-15 || !angle.is_finite(), "cos({angle:e}) is {cos}");
                    assert_eq!([sin, cos].map(f64::is_nan), [!angle.is_finite(); 2], "at {angle:e}");
                }
            }
        }
    }

    #[test]
    fn lists_of_every_length_have_the_bits_of_each_angle_alone() {
        are_those_of_each_angle::<0>();
        are_those_of_each_angle::<1>();
        are_those_of_each_angle::<5>();
        are_those_of_each_angle::<28>();
        are_those_of_each_angle::<29>();
        are_those_of_each_angle::<40>();
    }
}
