//! Angles one after the other, each of which is lanes.

use crate::scalar::Scalar;

/// Sines and cosines of all `angles`, as straight code for up to 28 of them.
///
/// In a loop, sines and cosines go through memory. Copies of lanes there may be made in pieces (LLVM moves 512 bits by two
/// times 256 on processors of Intel), and to read as a whole what was written in pieces stalls the processor. Straight code
/// for more angles would take more than half of an instruction cache of 32 KiB.
#[inline(always)]
pub fn in_turn<S: Scalar, const N: usize>(angles: [S; N]) -> ([S; N], [S; N]) {
    let zeros = [S::from_f64(0.0); N];
    let (mut sines, mut cosines) = (zeros, zeros);
    if N > 28 {
        for ((sin, cos), angle) in sines.iter_mut().zip(&mut cosines).zip(&angles) {
            (*sin, *cos) = angle.sin_cos();
        }
        return (sines, cosines);
    }
    macro_rules! straight {
        ($($index:literal)*) => {$(
            if $index < N {
                (sines[$index], cosines[$index]) = angles[$index].sin_cos();
            }
        )*};
    }
    straight!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27);
    (sines, cosines)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::F64x4;

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
    fn lists_of_every_length_have_the_bits_of_each_angle_alone() {
        are_those_of_each_angle::<0>();
        are_those_of_each_angle::<1>();
        are_those_of_each_angle::<5>();
        are_those_of_each_angle::<28>();
        are_those_of_each_angle::<29>();
        are_those_of_each_angle::<40>();
    }
}
