//! A lane holds the bits that the same operations on plain numbers give.

use redysim_runtime::FUSED;
use redysim_runtime::lanes::{F32x4, F32x8, F32x16, F64x2, F64x4, F64x8, Lanes, pack, unpack};
use redysim_runtime::{Real, Scalar};

/// Numbers of all sizes, angles that every path of the reduction takes, two between quarter turns, of which either may
/// be taken for the nearest, and what is not finite.
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
    std::f64::consts::FRAC_PI_2,
    0.0,
    f64::NAN,
    -6.0,
    1e-40,
    22.0,
    -1.8108925453454965e4,
    -2.0849965043712058e4,
];

/// Checks an operation on lanes against the same on numbers, with each of `NUMBERS` in each lane.
fn same<T: Real, L: Lanes<T, W>, const W: usize>(
    name: &str,
    lanes: impl Fn(L, L, L) -> L,
    number: impl Fn(T, T, T) -> T,
) {
    let [a, b, c] = [0, 5, 11].map(|shift| {
        move |start: usize, lane: usize| T::from_f64(NUMBERS[(start + lane + shift * start) % NUMBERS.len()])
    });
    for start in 0..NUMBERS.len() {
        let side_by_side = |entry: &dyn Fn(usize, usize) -> T| L::from(core::array::from_fn(|lane| entry(start, lane)));
        let found: [T; W] = lanes(side_by_side(&a), side_by_side(&b), side_by_side(&c)).into();
        for (lane, found) in found.into_iter().enumerate() {
            let arguments = (a(start, lane), b(start, lane), c(start, lane));
            let expected = number(arguments.0, arguments.1, arguments.2);
            // All bits but those of NaN; widening an `f32` loses none.
            let bits =
                |value: T| if value.is_finite() { value.to_f64().to_bits() } else { value.abs().to_f64() as u64 };
            assert_eq!(bits(found), bits(expected), "{name} of {arguments:?}: {found:?}, not {expected:?}");
        }
    }
}

fn all_operations_are_the_same<T: Real, L: Lanes<T, W>, const W: usize>() {
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
    let assigned = |mut a: L, b: L| {
        a += b;
        a -= b * b;
        a
    };
    same::<T, L, W>("assignment", |a, b, _| assigned(a, b), |a, b, _| a + b - b * b);
    same::<T, L, W>("several sines", |a, b, c| L::sin_cos_all([a, b, c]).0[1], |_, b, _| b.sin_cos().0);
}

#[test]
fn every_operation_is_that_of_the_numbers() {
    all_operations_are_the_same::<f64, F64x2, 2>();
    all_operations_are_the_same::<f64, F64x4, 4>();
    all_operations_are_the_same::<f64, F64x8, 8>();
    all_operations_are_the_same::<f32, F32x4, 4>();
    all_operations_are_the_same::<f32, F32x8, 8>();
    all_operations_are_the_same::<f32, F32x16, 16>();
}

#[test]
fn lanes_keep_their_order() {
    let numbers = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0];
    assert_eq!(F64x8::from(numbers).to_array(), numbers);
    assert_eq!(format!("{:?}", F64x2::from([1.0, 2.0])), "F64x2([1.0, 2.0])");
    assert_eq!(F32x16::default().to_array(), [0.0; 16]);
}

#[test]
fn packing_turns_states_into_lanes_and_back() {
    fn there_and_back<T: Real, L: Lanes<T, W>, const W: usize, const N: usize>() {
        let number = |state: usize, entry: usize| T::from_f64((100 * state + entry) as f64);
        let states: [[T; N]; W] = core::array::from_fn(|state| core::array::from_fn(|entry| number(state, entry)));
        let entries: [L; N] = pack(&states);
        for (entry, lanes) in entries.into_iter().enumerate() {
            let expected: [T; W] = core::array::from_fn(|state| number(state, entry));
            assert_eq!(<L as Into<[T; W]>>::into(lanes), expected, "entry {entry} of {N}");
        }
        assert_eq!(unpack(entries), states);
    }
    there_and_back::<f64, F64x2, 2, 3>();
    there_and_back::<f64, F64x4, 4, 6>();
    there_and_back::<f64, F64x8, 8, 1>();
    there_and_back::<f64, F64x8, 8, 7>();
    there_and_back::<f64, F64x8, 8, 19>();
    there_and_back::<f32, F32x8, 8, 6>();
    there_and_back::<f32, F32x16, 16, 30>();
}

/// (1 + 2⁻ⁿ)² − (1 + 2¹⁻ⁿ) is 2⁻²ⁿ, which is lost if the square is rounded first.
#[test]
fn multiplying_and_adding_rounds_once_where_it_is_fused() {
    fn rest<S: Scalar>(power: f64) -> S {
        let near_one = S::from_f64(1.0 + power);
        near_one.mul_add(near_one, -S::from_f64(1.0 + 2.0 * power))
    }
    let double = if FUSED { 2.0_f64.powi(-60) } else { 0.0 };
    let single = if FUSED { 2.0_f32.powi(-28) } else { 0.0 };
    assert_eq!(rest::<f64>(2.0_f64.powi(-30)), double);
    assert_eq!(rest::<F64x8>(2.0_f64.powi(-30)).to_array(), [double; 8]);
    assert_eq!(rest::<f32>(2.0_f64.powi(-14)), single);
    assert_eq!(rest::<F32x16>(2.0_f64.powi(-14)).to_array(), [single; 16]);
}

#[test]
fn nothing_is_fused_if_the_bits_are_to_be_the_same_everywhere() {
    let has_instruction = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
    assert_eq!(FUSED, has_instruction && !cfg!(feature = "deterministic"));
}
