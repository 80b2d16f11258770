//! Branches of a mechanism that are alike, computed one after the other or side by side in the lanes of a vector.

use crate::scalar::Scalar;

/// What generated code computes for each of `N` branches that are alike: `K` results from `M` numbers.
///
/// [`Scalar::side_by_side`] runs it: with the scalar itself for one branch after the other, or with lanes, each of which
/// has the numbers of a branch.
#[doc(hidden)]
pub trait Branches<S, const M: usize, const N: usize, const K: usize> {
    /// Computes the results with the scalar `P`. `each` makes one `P` of a number for each branch, and `write` takes the
    /// result with the given index.
    fn compute<P: Scalar>(read: &[S; M], each: impl Fn([S; N]) -> P, write: impl FnMut(usize, P));
}

/// The most branches that are computed by one call of [`Scalar::side_by_side`].
pub(crate) const MOST: usize = 8;

/// Computes one branch after the other.
#[inline(always)]
pub(crate) fn in_turn<S: Scalar, B: Branches<S, M, N, K>, const M: usize, const N: usize, const K: usize>(
    read: &[S; M],
) -> [[S; K]; N] {
    const { assert!(N <= MOST) };
    let mut results = [[S::zero(); K]; N];
    // Written out, so that the numbers of a branch need not be looked up while the program runs.
    macro_rules! branches {
        ($($branch:literal)*) => {$(
            if N > $branch {
                B::compute(read, #[inline(always)] |x| x[$branch], #[inline(always)] |column, value| results[$branch][column] = value);
            }
        )*};
    }
    branches!(0 1 2 3 4 5 6 7);
    results
}

/// Computes branches from number `$first` on in the lanes of a vector.
#[cfg(feature = "lanes")]
macro_rules! in_lanes {
    ($lanes:ident: $width:literal from $first:literal, $behaviour:ident, $branches:ident, $read:ident, $results:ident) => {
        $behaviour::compute(
            $read,
            #[inline(always)]
            |x| {
                let mut numbers = [x[$first]; $width];
                let mut lane = 1;
                while lane < $width {
                    // Lanes without a branch repeat the last one.
                    let branch = $first + lane;
                    numbers[lane] = x[if branch < $branches { branch } else { $branches - 1 }];
                    lane += 1;
                }
                $crate::lanes::$lanes::from(numbers)
            },
            #[inline(always)]
            |column, value: $crate::lanes::$lanes| {
                let numbers = value.to_array();
                let mut lane = 0;
                while lane < $width && $first + lane < $branches {
                    $results[$first + lane][column] = numbers[lane];
                    lane += 1;
                }
            },
        )
    };
}
#[cfg(feature = "lanes")]
pub(crate) use in_lanes;
