//! With the feature `deterministic`, the same program gives the same bits on every target: the sums below were pinned
//! on x86-64, and hold with any `-C target-cpu`.

use crate::robots::{Gripper, Kr5};
use crate::robots_in_space::Parcel;
use redysim::ConfigurationSpace;
use redysim::Real;
use redysim::lanes::{F32x16, F64x8, pack, unpack};

/// FNV-1a over the bits of numbers.
#[derive(Debug, PartialEq)]
struct Hash(u64);

impl Hash {
    fn add<T: Real>(&mut self, numbers: impl IntoIterator<Item = T>) {
        for number in numbers {
            for byte in number.to_f64().to_bits().to_le_bytes() {
                self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
    }
}

/// Numbers that do not stand on any library's functions: −1 to 1, from a linear congruential generator.
struct Numbers(u64);

impl Numbers {
    fn next<T: Real>(&mut self) -> T {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        T::from_f64((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }

    fn vector<T: Real, const N: usize>(&mut self, scale: f64) -> [T; N] {
        core::array::from_fn(|_| self.next::<T>() * T::from_f64(scale))
    }
}

/// The hash of sines of angles of all sizes, products, sums and roots.
fn maths<T: Real>() -> Hash {
    let (mut hash, mut numbers) = (Hash(0xcbf2_9ce4_8422_2325), Numbers(1));
    for scale in [1.0, 10.0, 1e3, 1e5, 1e8, 1e30] {
        for _ in 0..200 {
            let (sin, cos) = T::sin_cos_all(numbers.vector::<T, 7>(scale));
            hash.add(sin.into_iter().chain(cos));
            let number = numbers.next::<T>();
            hash.add([(number * number).sqrt(), number.mul_add(number, numbers.next())]);
        }
    }
    hash
}

/// The hash of what two mechanisms can do.
fn dynamics<T: Real>() -> Hash {
    let (mut hash, mut numbers) = (Hash(0xcbf2_9ce4_8422_2325), Numbers(2));
    for _ in 0..200 {
        let [q, v, u] = [4.0, 2.0, 10.0].map(|scale| numbers.vector::<T, 6>(scale));
        hash.add(Kr5::inverse_dynamics(&q, &v, &u));
        hash.add(Kr5::forward_dynamics(&q, &v, &u));
        hash.add(Kr5::mass_matrix(&q).into_iter().flatten());
        hash.add([Kr5::energy(&q, &v).total()]);
        let [q, v, u] = [4.0, 2.0, 10.0].map(|scale| numbers.vector::<T, 4>(scale));
        hash.add(Gripper::inverse_dynamics(&q, &v, &u));
        hash.add(Gripper::forward_dynamics(&q, &v, &u));
    }
    hash
}

#[test]
#[cfg_attr(not(feature = "deterministic"), ignore = "needs the feature `deterministic`")]
fn sines_products_and_roots_have_the_bits_that_were_pinned() {
    assert_eq!([maths::<f64>(), maths::<f32>()], [Hash(1162935246682754313), Hash(3804970369740811424)]);
}

/// To be pinned anew when the generated code changes, after the same new numbers were seen with other `-C target-cpu`.
#[test]
#[cfg_attr(not(feature = "deterministic"), ignore = "needs the feature `deterministic`")]
fn dynamics_has_the_bits_that_were_pinned() {
    assert_eq!([dynamics::<f64>(), dynamics::<f32>()], [Hash(999759090588707293), Hash(10826886457047394599)]);
}

/// With and without the feature: a lane is a plain number.
#[test]
fn a_state_in_a_lane_gives_the_bits_it_gives_alone() {
    let mut numbers = Numbers(2);
    for _ in 0..50 {
        let states: [[[f64; 6]; 8]; 3] = core::array::from_fn(|_| core::array::from_fn(|_| numbers.vector(3.0)));
        let [q, v, u] = states.each_ref().map(pack::<F64x8, _, 8, 6>);
        let (inverse, forward) = (Kr5::inverse_dynamics(&q, &v, &u), Kr5::forward_dynamics(&q, &v, &u));
        let (inverse, forward): ([[f64; 6]; 8], [[f64; 6]; 8]) = (unpack(inverse), unpack(forward));
        let [q, v, u] = states;
        for lane in 0..8 {
            assert_eq!(inverse[lane], Kr5::inverse_dynamics(&q[lane], &v[lane], &u[lane]));
            assert_eq!(forward[lane], Kr5::forward_dynamics(&q[lane], &v[lane], &u[lane]));
        }
        let single: [[f32; 6]; 16] = core::array::from_fn(|_| numbers.vector(3.0));
        let gravity: [[f32; 6]; 16] = unpack(Kr5::gravity_forces(&pack::<F32x16, _, 16, 6>(&single)));
        assert_eq!(gravity, single.map(|q| Kr5::gravity_forces(&q)));
    }
}

/// Inverse and forward dynamics and the mass matrix of `LANES` states in lanes, against each alone.
macro_rules! a_state_in_a_lane_is_as_if_alone {
    ($robot:ident, $lanes:ty, $scalar:ty, $count:literal, $numbers:ident) => {
        const _: () = assert!($robot::NQ >= $robot::NV);
        for _ in 0..20 {
            let q: [[$scalar; $robot::NQ]; $count] = core::array::from_fn(|_| $numbers.vector(3.0));
            let [v, u]: [[[$scalar; $robot::NV]; $count]; 2] =
                core::array::from_fn(|_| core::array::from_fn(|_| $numbers.vector(3.0)));
            let in_lanes = pack::<$lanes, _, $count, { $robot::NQ }>(&q);
            let [v_in_lanes, u_in_lanes] = [&v, &u].map(pack::<$lanes, _, $count, { $robot::NV }>);
            let inverse: [[$scalar; $robot::NV]; $count] =
                unpack($robot::inverse_dynamics(&in_lanes, &v_in_lanes, &u_in_lanes));
            let forward: [[$scalar; $robot::NV]; $count] =
                unpack($robot::forward_dynamics(&in_lanes, &v_in_lanes, &u_in_lanes));
            let moved: [[$scalar; $robot::NQ]; $count] = unpack($robot.integrate(&in_lanes, &v_in_lanes));
            let matrix: [[[$scalar; $robot::NV]; $count]; $robot::NV] = $robot::mass_matrix(&in_lanes).map(unpack);
            for lane in 0..$count {
                let (q, v, u) = (&q[lane], &v[lane], &u[lane]);
                assert_eq!(inverse[lane], $robot::inverse_dynamics(q, v, u), "{} inverse", $robot::NAME);
                assert_eq!(forward[lane], $robot::forward_dynamics(q, v, u), "{} forward", $robot::NAME);
                assert_eq!(moved[lane], $robot.integrate(q, v), "{} integrate", $robot::NAME);
                assert_eq!(matrix.map(|row| row[lane]), $robot::mass_matrix(q), "{} matrix", $robot::NAME);
            }
        }
    };
}

#[test]
fn a_state_with_quaternions_in_a_lane_gives_the_bits_it_gives_alone() {
    let mut numbers = Numbers(3);
    a_state_in_a_lane_is_as_if_alone!(Parcel, F64x8, f64, 8, numbers);
    a_state_in_a_lane_is_as_if_alone!(Parcel, F32x16, f32, 16, numbers);
}

/// Their code takes long to compile: `.ci/run` alone has them, for any processor with the feature `deterministic`.
#[test]
#[cfg(any(feature = "deterministic", target_feature = "fma", not(target_arch = "x86_64")))]
fn a_state_of_another_robot_in_space_in_a_lane_gives_the_bits_it_gives_alone() {
    use crate::robots_in_space::{Floating, Pendulum, Series};
    let mut numbers = Numbers(4);
    a_state_in_a_lane_is_as_if_alone!(Pendulum, F64x8, f64, 8, numbers);
    a_state_in_a_lane_is_as_if_alone!(Pendulum, F32x16, f32, 16, numbers);
    a_state_in_a_lane_is_as_if_alone!(Floating, F64x8, f64, 8, numbers);
    a_state_in_a_lane_is_as_if_alone!(Floating, F32x16, f32, 16, numbers);
    a_state_in_a_lane_is_as_if_alone!(Series, F64x8, f64, 8, numbers);
    a_state_in_a_lane_is_as_if_alone!(Series, F32x16, f32, 16, numbers);
}
