//! Sine and cosine are right to the last place for every finite angle.

use redysim_runtime::Scalar;

/// Angle, sine and cosine as bits: 1,400-bit arithmetic (mpmath), rounded to `f64`. Angles of all magnitudes, the
/// nearest numbers to multiples of π/4, and the number nearest to a multiple of π/2 of all (6381956970095103 · 2⁷⁹⁷).
const REFERENCE: &str = include_str!("../reference/sin_cos.txt");

fn places_between(a: f64, b: f64) -> u64 {
    if a == b { 0 } else { a.to_bits().abs_diff(b.to_bits()) }
}

#[test]
fn angles_of_all_magnitudes_agree_with_multiprecision_to_one_place() {
    for line in REFERENCE.lines() {
        let bits: Vec<u64> = line.split(' ').map(|word| u64::from_str_radix(word, 16).unwrap()).collect();
        let [angle, sin, cos] = [0, 1, 2].map(|index| f64::from_bits(bits[index]));
        let found = Scalar::sin_cos(angle);
        assert!(places_between(found.0, sin) <= 1, "sin({angle:e}) = {sin:e}, found {:e}", found.0);
        assert!(places_between(found.1, cos) <= 1, "cos({angle:e}) = {cos:e}, found {:e}", found.1);
    }
}

#[test]
fn a_million_angles_agree_with_the_platform_to_one_place() {
    let mut state = 1_u64;
    for index in 0..1_000_000_u32 {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        let unit = (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5;
        let angle = unit * [2.0, 20.0, 2e3, 4e6, 1e10][index as usize % 5];
        let (found, platform) = (Scalar::sin_cos(angle), f64::sin_cos(angle));
        assert!(places_between(found.0, platform.0) <= 1, "sin({angle:e}): {:e} {:e}", found.0, platform.0);
        assert!(places_between(found.1, platform.1) <= 1, "cos({angle:e}): {:e} {:e}", found.1, platform.1);
    }
}

/// What is promised: one place up to 10⁵ rad, two beyond. The study `sin_cos` tries every `f32`; here is one in 9973,
/// and those that are hard: the nearest to multiples of π/4, and the ends of the quick reduction. `f64` is exact beside
/// it.
#[test]
fn single_precision_is_right_to_one_place_up_to_a_hundred_thousand_and_to_two_beyond() {
    let sample = (0..f32::INFINITY.to_bits()).step_by(9973);
    let beside = |angle: f32| angle.to_bits() - 2..angle.to_bits() + 3;
    let multiples = (1..200_000).flat_map(|n| beside((f64::from(n) * std::f64::consts::FRAC_PI_4) as f32));
    let ends = [402.0, 205_887.0, 1e5, f32::MAX].map(|end| end.to_bits() - 50..=(end.to_bits() + 50).min(0x7f7f_ffff));
    for bits in sample.chain(multiples).chain(ends.into_iter().flatten()).chain(HARD_SINGLES.map(f32::to_bits)) {
        let angle = f32::from_bits(bits);
        let exact = f64::sin_cos(f64::from(angle));
        let found = Scalar::sin_cos(angle);
        let allowed = if angle <= 1e5 { 1.0 } else { 2.0 };
        for (found, exact) in [(found.0, exact.0), (found.1, exact.1)] {
            // Of the binade of the exact value.
            let below = f32::from_bits((exact.abs() as f32).to_bits() & 0x7f80_0000).max(f32::MIN_POSITIVE);
            let place = f64::from(below) * f64::from(f32::EPSILON);
            let errors = (f64::from(found) - exact).abs() / place;
            assert!(errors <= allowed, "{angle:e}: {found:e}, not {exact:e}, is wrong by {errors} places");
        }
        assert_eq!(Scalar::sin_cos(-angle), (-found.0, found.1), "{angle:e}");
    }
}

/// The nearest `f32` to multiples of π/2: within the ranges of the quick reductions and between, and of all.
const HARD_SINGLES: [f32; 8] =
    [1.5707964, 4.712389, 2.5289821e2, 5.0579642e2, 5.2516434e4, 1.0503287e5, 4.2781604e7, 7.729179e28];

#[test]
fn angles_that_are_not_finite_give_nan() {
    for angle in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let (sin, cos) = Scalar::sin_cos(angle);
        assert!(sin.is_nan() && cos.is_nan());
        let (sin, cos) = Scalar::sin_cos(angle as f32);
        assert!(sin.is_nan() && cos.is_nan());
    }
}

#[test]
fn several_at_once_give_the_same_bits_as_one_by_one() {
    let angles = [0.0, -0.0, 0.3, -std::f64::consts::FRAC_PI_2, 3.0, 1e4, -7.3e5, 3.4e200, 1e-310, f64::INFINITY, 2.5];
    fn same<const N: usize>(angles: [f64; N]) {
        let (sines, cosines) = Scalar::sin_cos_all(angles);
        for (index, angle) in angles.into_iter().enumerate() {
            let (sin, cos) = Scalar::sin_cos(angle);
            assert_eq!(sines[index].to_bits(), sin.to_bits(), "sin({angle:e}), one of {N}");
            assert_eq!(cosines[index].to_bits(), cos.to_bits(), "cos({angle:e}), one of {N}");
        }
    }
    same(angles);
    same::<0>([]);
    for window in angles.windows(5) {
        let [a, b, c, d, e] = [0, 1, 2, 3, 4].map(|index| window[index]);
        same([a]);
        same([a, b]);
        same([a, b, c]);
        same([a, b, c, d]);
        same([a, b, c, d, e]);
    }
}

#[test]
fn several_at_once_give_the_same_bits_as_one_by_one_in_single_precision() {
    fn same<const N: usize>(angles: &[f32]) {
        for window in angles.windows(N) {
            let window: [f32; N] = window.try_into().unwrap();
            let (sines, cosines) = Scalar::sin_cos_all(window);
            for (index, angle) in window.into_iter().enumerate() {
                let (sin, cos) = Scalar::sin_cos(angle);
                assert_eq!(sines[index].to_bits(), sin.to_bits(), "sin({angle:e}), one of {N}");
                assert_eq!(cosines[index].to_bits(), cos.to_bits(), "cos({angle:e}), one of {N}");
            }
        }
    }
    let angles = [
        0.3,
        0.7,
        -0.0,
        2.5,
        -std::f32::consts::FRAC_PI_2,
        3.0,
        1.0,
        300.0,
        -401.0,
        22.0,
        1e-40,
        500.0,
        1.5,
        -7.3e5,
        0.0,
        3.4e38,
        1e4,
        5.0,
        f32::INFINITY,
        -2.0,
    ];
    same::<1>(&angles);
    same::<2>(&angles);
    same::<3>(&angles);
    same::<4>(&angles);
    same::<5>(&angles);
    same::<6>(&angles);
    same::<7>(&angles);
    same::<8>(&angles);
    same::<11>(&angles);
    same::<20>(&angles);
}
