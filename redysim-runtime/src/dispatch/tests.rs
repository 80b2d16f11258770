//! The numbers for instructions that the processor may have do what plain numbers do.
//!
//! The tests pass without a check on processors that lack the instructions.

use super::Instructions;
use super::x86::{Avx2F32, Avx2F32x4, Avx2F32x8, Avx2F64, Avx2F64x2, Avx2F64x4, Avx512F32x16, Avx512F64x8};
use crate::lanes::Lanes;
use crate::{Branches, Scalar, SideBySide};

/// Numbers of all sizes, angles for every path of the reduction, infinity and NaN.
const NUMBERS: [f64; 20] = [
    0.3,
    -1.7,
    2.5,
    1e4,
    -7.3e5,
    1e-30,
    3.0,
    9.9e4,
    -0.0,
    3.4e20,
    1.0,
    f64::INFINITY,
    core::f64::consts::FRAC_PI_2,
    0.0,
    f64::NAN,
    -6.0,
    1e-40,
    22.0,
    -1.8108925453454965e4,
    -2.0849965043712058e4,
];

/// A number with the bits that tell it from others.
trait Bits: Scalar {
    /// All bits; those of any NaN are the same.
    fn bits(self) -> u64;
}

macro_rules! bits {
    ($($number:ident of $float:ident),*) => {$(
        impl Bits for $number {
            fn bits(self) -> u64 {
                if self.0.is_nan() { $float::NAN.to_bits().into() } else { self.0.to_bits().into() }
            }
        }
    )*};
}

bits!(Avx2F64 of f64, Avx2F32 of f32);

/// Checks an operation in each lane against the same on one number.
fn same<T: Bits, L: Lanes<T, W>, const W: usize>(
    name: &str,
    lanes: impl Fn(L, L, L) -> L,
    number: impl Fn(T, T, T) -> T,
) {
    for start in 0..NUMBERS.len() {
        let argument = |shift: usize, lane: usize| T::from_f64(NUMBERS[(start + lane + shift * (start + 1)) % 20]);
        let side_by_side = |shift: usize| L::from(core::array::from_fn(|lane| argument(shift, lane)));
        let found: [T; W] = lanes(side_by_side(0), side_by_side(5), side_by_side(11)).into();
        for (lane, found) in found.into_iter().enumerate() {
            let arguments = [0, 5, 11].map(|shift| argument(shift, lane));
            let expected = number(arguments[0], arguments[1], arguments[2]);
            assert_eq!(found.bits(), expected.bits(), "{name} of {arguments:?}: {found:?}, not {expected:?}");
        }
    }
}

fn all_operations_are_the_same<T: Bits, L: Lanes<T, W>, const W: usize>() {
    same::<T, L, W>("sum", |a, b, _| a + b, |a, b, _| a + b);
    same::<T, L, W>("difference", |a, b, _| a - b, |a, b, _| a - b);
    same::<T, L, W>("product", |a, b, _| a * b, |a, b, _| a * b);
    same::<T, L, W>("quotient", |a, b, _| a / b, |a, b, _| a / b);
    same::<T, L, W>("negative", |a, _, _| -a, |a, _, _| -a);
    same::<T, L, W>("product and sum", |a, b, c| a.mul_add(b, c), |a, b, c| a.mul_add(b, c));
    same::<T, L, W>("square root", |a, _, _| (a * a).sqrt(), |a, _, _| (a * a).sqrt());
    same::<T, L, W>("sine", |a, _, _| a.sin_cos().0, |a, _, _| a.sin_cos().0);
    same::<T, L, W>("cosine", |a, _, _| a.sin_cos().1, |a, _, _| a.sin_cos().1);
    same::<T, L, W>("constant", |_, _, _| L::from_f64(0.1), |_, _, _| T::from_f64(0.1));
    same::<T, L, W>("zero", |_, _, _| L::opaque_zero(), |_, _, _| T::from_f64(0.0));
    let assigned = |mut a: L, b: L| {
        a += b;
        a -= b * b;
        a
    };
    same::<T, L, W>("assignment", |a, b, _| assigned(a, b), |a, b, _| a + b - b * b);
    same::<T, L, W>("several sines", |a, b, c| L::sin_cos_all([a, b, c]).0[1], |_, b, _| b.sin_cos().0);
    same::<T, L, W>(
        "code with other target features",
        |a, b, c| L::with_target_features(|| a.mul_add(b, c)),
        |a, b, c| a.mul_add(b, c),
    );
}

#[test]
fn every_lane_does_what_a_number_does() {
    if Instructions::of_processor() >= Instructions::Avx2 {
        all_operations_are_the_same::<Avx2F64, Avx2F64x2, 2>();
        all_operations_are_the_same::<Avx2F64, Avx2F64x4, 4>();
        all_operations_are_the_same::<Avx2F32, Avx2F32x4, 4>();
        all_operations_are_the_same::<Avx2F32, Avx2F32x8, 8>();
        if Instructions::of_processor() >= Instructions::Avx512 {
            all_operations_are_the_same::<Avx2F64, Avx512F64x8, 8>();
            all_operations_are_the_same::<Avx2F32, Avx512F32x16, 16>();
        }
    }
}

/// The square of a number of each branch, and its sum with one that all have.
struct Squares;

impl<T: Scalar, const N: usize> Branches<T, 8, N, 2> for Squares {
    fn compute<S: Scalar>(read: &[T; 8], each: impl Fn([T; N]) -> S, mut write: impl FnMut(usize, S)) {
        let (own, common) = (each(core::array::from_fn(|branch| read[branch])), each([read[7]; N]));
        let square = own * own;
        write(0, square);
        write(1, square + common);
    }
}

#[test]
fn branches_in_lanes_have_the_bits_of_each_alone() {
    fn branches<T: Bits, const N: usize>() {
        let numbers: [T; 8] = core::array::from_fn(|index| T::from_f64(NUMBERS[index]));
        let results = SideBySide::<T, Squares, 8, N, 2>::all(&numbers);
        for (results, number) in results.into_iter().zip(numbers) {
            let square = number * number;
            assert_eq!(results.map(Bits::bits), [square, square + numbers[7]].map(Bits::bits), "{number:?} of {N}");
        }
    }
    if Instructions::of_processor() >= Instructions::Avx2 {
        branches::<Avx2F64, 2>();
        branches::<Avx2F64, 3>();
        branches::<Avx2F64, 5>();
        branches::<Avx2F64, 8>();
        branches::<Avx2F32, 2>();
        branches::<Avx2F32, 4>();
        branches::<Avx2F32, 6>();
        branches::<Avx2F32, 7>();
    }
}

#[test]
fn a_list_of_angles_gives_the_bits_of_each_alone() {
    fn list<T: Bits, const N: usize>() {
        let angles: [T; N] = core::array::from_fn(|index| T::from_f64(NUMBERS[index]));
        let (sin, cos) = T::sin_cos_all(angles);
        for (index, angle) in angles.into_iter().enumerate() {
            let alone = angle.sin_cos();
            assert_eq!([sin[index].bits(), cos[index].bits()], [alone.0.bits(), alone.1.bits()], "{angle:?} of {N}");
        }
    }
    if Instructions::of_processor() >= Instructions::Avx2 {
        list::<Avx2F64, 1>();
        list::<Avx2F64, 3>();
        list::<Avx2F64, 6>();
        list::<Avx2F64, 20>();
        list::<Avx2F32, 1>();
        list::<Avx2F32, 7>();
        list::<Avx2F32, 20>();
    }
}

/// Against the standard library's functions, whose sine and cosine are right to less than one place.
#[test]
fn a_number_is_a_plain_one_whose_products_and_sums_are_fused() {
    for (a, b) in NUMBERS.into_iter().zip(NUMBERS.into_iter().cycle().skip(7)) {
        let (x, y) = (Avx2F64(a), Avx2F64(b));
        let fused = if cfg!(feature = "deterministic") { a * b + a } else { a.mul_add(b, a) };
        let pairs =
            [(x + y, a + b), (x - y, a - b), (x * y, a * b), (x / y, a / b), (-x, -a), (x.mul_add(y, x), fused)];
        for (found, expected) in pairs {
            assert_eq!(found.bits(), Avx2F64(expected).bits(), "{a} and {b}");
        }
        let (sin, cos) = x.sin_cos();
        for (found, expected) in [(sin.0, a.sin()), (cos.0, a.cos())] {
            let close = (found - expected).abs() <= 2.0 * f64::EPSILON * expected.abs();
            assert!(close || (!a.is_finite() && found.is_nan()), "of {a}: {found}, not {expected}");
        }
    }
}

#[test]
fn what_the_program_is_compiled_for_is_not_chosen_again() {
    let detected = Instructions::detected();
    assert_eq!(detected, Instructions::detected());
    if cfg!(target_feature = "avx512f") {
        assert_eq!(detected, Instructions::Compiled);
    } else if cfg!(target_feature = "fma") {
        assert_ne!(detected, Instructions::Avx2);
    }
}
