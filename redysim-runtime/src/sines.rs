//! The sines and cosines that a function reads.

use crate::scalar::Scalar;

/// The most angles that are computed by one call of [`Sines::compute`].
#[doc(hidden)]
pub const MOST_SINES: usize = 16;

/// Sines and cosines of `N` angles: given ones, or those that a function computes when it is about to read them.
///
/// Holds references: arrays in the structure would be copied with it, in wider vectors than those that wrote them, and reading them
/// would wait for the writes.
#[doc(hidden)]
pub struct Sines<'s, S, const N: usize> {
    /// The angles, if they are computed.
    pub angles: Option<&'s [S; N]>,
    /// The sines that are known.
    pub sin: &'s mut [S; N],
    /// The cosines that are known.
    pub cos: &'s mut [S; N],
}

/// The sines and cosines that are known from the beginning: all where they are computed [at once](Scalar::AT_ONCE), else none.
#[doc(hidden)]
#[inline(always)]
pub fn sines_at_once<S: Scalar, const N: usize>(angles: &[S; N]) -> ([S; N], [S; N]) {
    if S::AT_ONCE { S::sin_cos_all(*angles) } else { ([S::zero(); N], [S::zero(); N]) }
}

impl<S: Scalar, const N: usize> Sines<'_, S, N> {
    /// Computes those of the angles with these numbers, [`MOST_SINES`] at most, unless they are known.
    #[inline(always)]
    pub fn compute<const K: usize>(&mut self, numbers: [usize; K]) {
        let Some(angles) = self.angles else { return };
        if S::AT_ONCE {
            return;
        }
        const { assert!(K <= MOST_SINES) };
        let mut computed = [S::zero(); K];
        // Written out, since in a loop the numbers of lanes go through memory.
        macro_rules! written_out {
            ($do:ident: $($index:literal)*) => {$(
                if $index < K {
                    $do!($index);
                }
            )*};
        }
        macro_rules! read {
            ($index:literal) => {
                computed[$index] = angles[numbers[$index]]
            };
        }
        written_out!(read: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
        let (sines, cosines) = S::sin_cos_all(computed);
        macro_rules! write {
            ($index:literal) => {
                (self.sin[numbers[$index]], self.cos[numbers[$index]]) = (sines[$index], cosines[$index])
            };
        }
        written_out!(write: 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(feature = "lanes")]
    use crate::lanes::F64x2;

    fn sines<'s, S: Scalar>(angles: Option<&'s [S; 3]>, (sin, cos): &'s mut ([S; 3], [S; 3])) -> Sines<'s, S, 3> {
        Sines { angles, sin, cos }
    }

    #[test]
    #[cfg(feature = "lanes")]
    fn sines_of_lanes_are_known_of_the_angles_that_were_computed() {
        let angles = [0.1, 0.2, 0.3].map(F64x2::from_f64);
        let mut known = sines_at_once(&angles);
        sines(Some(&angles), &mut known).compute([2, 0]);
        let [(sin_1, cos_1), _, (sin_3, cos_3)] = angles.map(Scalar::sin_cos);
        assert_eq!(known, ([sin_1, F64x2::zero(), sin_3], [cos_1, F64x2::zero(), cos_3]));
    }

    #[test]
    fn sines_of_numbers_are_all_known_and_given_ones_stay() {
        let angles = [0.5_f64, 1.0, 1.5];
        let mut known = sines_at_once(&angles);
        sines(Some(&angles), &mut known).compute([1]);
        assert_eq!(known.0, angles.map(|angle| Scalar::sin_cos(angle).0));
        let mut given = ([3.0_f64, 4.0, 5.0], [6.0, 7.0, 8.0]);
        sines(None, &mut given).compute([0]);
        assert_eq!(given, ([3.0, 4.0, 5.0], [6.0, 7.0, 8.0]));
    }
}
