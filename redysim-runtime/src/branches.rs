//! Branches of a mechanism that are alike, computed one after the other or side by side in the lanes of a vector.

use crate::scalar::Scalar;
use core::marker::PhantomData;
use core::ops::Deref;

/// What generated code computes for each of `N` branches that are alike: `K` results from `M` numbers.
///
/// [`SideBySide`] runs it: with the scalar itself for one branch after the other, or with lanes, each of which
/// has the numbers of a branch.
#[doc(hidden)]
pub trait Branches<S, const M: usize, const N: usize, const K: usize> {
    /// Computes the results with the scalar `P`. `each` makes one `P` of a number for each branch, and `write` takes the
    /// result with the given index.
    fn compute<P: Scalar>(read: &[S; M], each: impl Fn([S; N]) -> P, write: impl FnMut(usize, P));
}

/// The most branches that are computed by one [`SideBySide`].
const MOST: usize = 8;

/// The results of the branches `B`, a row for each.
#[doc(hidden)]
pub struct SideBySide<S, B, const M: usize, const N: usize, const K: usize> {
    results: [[S; K]; N],
    branches: PhantomData<B>,
}

impl<S: Scalar, B: Branches<S, M, N, K>, const M: usize, const N: usize, const K: usize> SideBySide<S, B, M, N, K> {
    /// No results yet.
    #[inline(always)]
    pub fn begun() -> Self {
        const { assert!(N <= MOST) };
        SideBySide { results: [[S::zero(); K]; N], branches: PhantomData }
    }

    /// Computes the results of this branch; numbers that are computed in lanes have those of all branches with the first one.
    #[inline(always)]
    pub fn compute(&mut self, branch: usize, read: &[S; M]) {
        Self::compute_into(&mut self.results, branch, read);
    }

    /// The results of all branches.
    #[inline(always)]
    pub fn all(read: &[S; M]) -> [[S; K]; N] {
        const { assert!(N <= MOST) };
        // A local variable, and not those of `begun`: with these, the forward dynamics of TALOS in lanes is an eighth longer.
        let mut results = [[S::zero(); K]; N];
        // Written out, so that the numbers of a branch need not be looked up while the program runs.
        macro_rules! compute {
            ($($branch:literal)*) => {$(
                if N > $branch {
                    Self::compute_into(&mut results, $branch, read);
                }
            )*};
        }
        compute!(0 1 2 3 4 5 6 7);
        results
    }

    #[inline(always)]
    fn compute_into(results: &mut [[S; K]; N], branch: usize, read: &[S; M]) {
        S::compute_branch::<B, M, N, K>(
            branch,
            read,
            #[inline(always)]
            |branch, column, value| results[branch][column] = value,
        );
    }
}

impl<S, B, const M: usize, const N: usize, const K: usize> Deref for SideBySide<S, B, M, N, K> {
    type Target = [[S; K]; N];

    #[inline(always)]
    fn deref(&self) -> &[[S; K]; N] {
        &self.results
    }
}

/// Computes branches from number `$first` on in the lanes of a vector.
#[cfg(feature = "lanes")]
macro_rules! in_lanes {
    ($lanes:ty: $width:literal from $first:literal, $behaviour:ident, $branches:ident, $read:ident, $write:ident) => {
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
                <$lanes>::from(numbers)
            },
            #[inline(always)]
            |column, value: $lanes| {
                let numbers: [Self; $width] = value.into();
                let mut lane = 0;
                while lane < $width && $first + lane < $branches {
                    $write($first + lane, column, numbers[lane]);
                    lane += 1;
                }
            },
        )
    };
}

/// [`Scalar::compute_branch`] of a number: all branches with the first one, in the lanes of `$pair` or `$four`.
#[cfg(feature = "lanes")]
macro_rules! compute_branches_in_lanes {
    ($pair:ty: $two:literal, $four:ty: $width:literal) => {
        #[inline(always)]
        fn compute_branch<
            B: $crate::branches::Branches<Self, M, N, K>,
            const M: usize,
            const N: usize,
            const K: usize,
        >(
            branch: usize,
            read: &[Self; M],
            mut write: impl FnMut(usize, usize, Self),
        ) {
            // The first call reads what all branches read.
            const { assert!(N >= 2 && Self::AT_ONCE) };
            if branch > 0 {
                return;
            }
            if N == 2 {
                $crate::branches::in_lanes!($pair: $two from 0, B, N, read, write);
            } else {
                $crate::branches::in_lanes!($four: $width from 0, B, N, read, write);
            }
            if N == 5 || N == 6 {
                $crate::branches::in_lanes!($pair: $two from 4, B, N, read, write);
            } else if N > 6 {
                $crate::branches::in_lanes!($four: $width from 4, B, N, read, write);
            }
        }
    };
}
#[cfg(feature = "lanes")]
pub(crate) use {compute_branches_in_lanes, in_lanes};
