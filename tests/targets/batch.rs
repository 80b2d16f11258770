//! Many states at once give, for each, what the state gives alone on the processor that the program runs on.

use crate::robots::{Gripper, Kr5};
use crate::robots_in_space::Parcel;
use redysim::batch::{self, Batched};
use redysim::{
    BiasForces, ConfigurationSpace, Dispatch, Dispatched, ForwardDynamics, GravityForces, InverseDynamics,
    LengthMismatch, MassMatrix, Real, Scalar, TreeDynamics, redysim,
};

/// No state, one, about as many as lanes, enough that a last task and a last group are not full.
const COUNTS: [usize; 8] = [0, 1, 7, 8, 9, 17, 1000, 1283];

/// `count` states of `N` numbers in −3 to 3, others for each `seed`.
fn numbers<T: Real, const N: usize>(seed: usize, count: usize) -> Vec<[T; N]> {
    let number = |index: usize| T::from_f64(3.0 * (1.7 * (index + 1000 * seed) as f64).sin());
    (0..count).map(|state| core::array::from_fn(|entry| number(state * N + entry))).collect()
}

fn bits<T: Real, const N: usize>(states: &[[T; N]]) -> Vec<u64> {
    states.iter().flatten().map(|number| number.to_f64().to_bits()).collect()
}

fn each_state_is_as_if_alone<T: Batched>(count: usize)
where
    Dispatched<Kr5>: ConfigurationSpace<T, Coordinates = [T; 6], Velocities = [T; 6], Matrix = [[T; 6]; 6]>
        + InverseDynamics<T>
        + ForwardDynamics<T>
        + BiasForces<T>
        + GravityForces<T>
        + MassMatrix<T>,
{
    let kr5 = Kr5.dispatched();
    let [q, v, u]: [Vec<[T; 6]>; 3] = [1, 2, 3].map(|seed| numbers(seed, count));
    let mut found = vec![[T::default(); 6]; count];
    let alone = |function: &dyn Fn(usize) -> [T; 6]| (0..count).map(function).collect::<Vec<_>>();

    batch::inverse_dynamics(&Kr5, &q, &v, &u, &mut found).unwrap();
    assert_eq!(bits(&found), bits(&alone(&|i| kr5.inverse_dynamics(&q[i], &v[i], &u[i]))), "inverse dynamics");
    batch::forward_dynamics(&Kr5, &q, &v, &u, &mut found).unwrap();
    assert_eq!(bits(&found), bits(&alone(&|i| kr5.forward_dynamics(&q[i], &v[i], &u[i]))), "forward dynamics");
    batch::bias_forces(&Kr5, &q, &v, &mut found).unwrap();
    assert_eq!(bits(&found), bits(&alone(&|i| kr5.bias_forces(&q[i], &v[i]))), "bias forces");
    batch::gravity_forces(&Kr5, &q, &mut found).unwrap();
    assert_eq!(bits(&found), bits(&alone(&|i| kr5.gravity_forces(&q[i]))), "gravity forces");

    let mut matrices = vec![[[T::default(); 6]; 6]; count];
    batch::mass_matrix(&Kr5, &q, &mut matrices).unwrap();
    for (matrix, q) in matrices.iter().zip(&q) {
        assert_eq!(bits(matrix), bits(&kr5.mass_matrix(q)), "mass matrix");
    }

    batch::evaluate(&Held, &q, &mut found).unwrap();
    assert_eq!(bits(&found), bits(&alone(&|i| kr5.gravity_forces(&q[i]))), "a function that calls the mechanism");

    let mut sums = vec![[T::default(); 1]; count];
    batch::map(&q, &mut sums, |[a, b, c, d, e, f]| [a * b + c * d + e * f]).unwrap();
    for (sum, [a, b, c, d, e, f]) in sums.iter().zip(q) {
        assert_eq!(*sum, [a * b + c * d + e * f], "map");
    }
}

/// The forces that hold the robot where it is, as a function of a program.
struct Held;

impl batch::Function<6, 6> for Held {
    #[inline(always)]
    fn evaluate<S: Scalar>(&self, q: [S; 6]) -> [S; 6] {
        Kr5::gravity_forces(&q)
    }
}

#[test]
fn any_number_of_states_gives_the_bits_of_each_alone() {
    for count in COUNTS {
        each_state_is_as_if_alone::<f64>(count);
        each_state_is_as_if_alone::<f32>(count);
    }
}

/// The bits of a batch and of a dispatched mechanism are those of each state in code for the same processor, whose lanes
/// hold other numbers of coordinates than of velocities.
macro_rules! each_state_in_space_is_as_if_alone {
    ($robot:ident, $scalar:ty) => {{
        const NQ: usize = $robot::NQ;
        const NV: usize = $robot::NV;
        for count in [0, 1, 7, 9, 17, 100] {
            let robot = $robot.dispatched();
            let q: Vec<[$scalar; NQ]> = numbers(1, count);
            let [v, u]: [Vec<[$scalar; NV]>; 2] = [2, 3].map(|seed| numbers(seed, count));
            let mut found = vec![[0.0; NV]; count];
            let alone = |function: &dyn Fn(usize) -> [$scalar; NV]| (0..count).map(function).collect::<Vec<_>>();
            let name = format!("{} in {}, {count} states", $robot::NAME, stringify!($scalar));
            batch::inverse_dynamics(&$robot, &q, &v, &u, &mut found).unwrap();
            let expected = alone(&|i| robot.inverse_dynamics(&q[i], &v[i], &u[i]));
            assert_eq!(bits(&found), bits(&expected), "{name}: inverse dynamics");
            batch::forward_dynamics(&$robot, &q, &v, &u, &mut found).unwrap();
            let expected = alone(&|i| robot.forward_dynamics(&q[i], &v[i], &u[i]));
            assert_eq!(bits(&found), bits(&expected), "{name}: forward dynamics");
            batch::bias_forces(&$robot, &q, &v, &mut found).unwrap();
            assert_eq!(bits(&found), bits(&alone(&|i| robot.bias_forces(&q[i], &v[i]))), "{name}: bias forces");
            batch::gravity_forces(&$robot, &q, &mut found).unwrap();
            assert_eq!(bits(&found), bits(&alone(&|i| robot.gravity_forces(&q[i]))), "{name}: gravity forces");
            let mut matrices = vec![[[0.0; NV]; NV]; count];
            batch::mass_matrix(&$robot, &q, &mut matrices).unwrap();
            for (matrix, q) in matrices.iter().zip(&q) {
                assert_eq!(bits(matrix), bits(&robot.mass_matrix(q)), "{name}: mass matrix");
            }
            // The coordinates that are beside those of others are their own: no two states have the same forces.
            assert!(count < 2 || found[0] != found[1], "{name}");
        }
    }};
}

#[test]
fn states_with_more_coordinates_than_velocities_give_the_bits_of_each_alone() {
    each_state_in_space_is_as_if_alone!(Parcel, f64);
    each_state_in_space_is_as_if_alone!(Parcel, f32);
}

/// Lanes compute the sines of a leg before the leg and write its elements after it; numbers do all at once. The matrix is that of a
/// call for one state: the bits of a dispatched one, and those of a plain one but for what fused products change.
macro_rules! mass_matrices_are_those_of_each_state {
    ($robot:ident, $scalar:ty) => {{
        const NV: usize = $robot::NV;
        const OF_LEG: usize = (NV - 6) / 4;
        let q: Vec<[$scalar; $robot::NQ]> = numbers(1, 19);
        let mut matrices = vec![[[0.0; NV]; NV]; q.len()];
        batch::mass_matrix(&$robot, &q, &mut matrices).unwrap();
        for (matrix, q) in matrices.iter().zip(&q) {
            assert_eq!(bits(matrix), bits(&$robot.dispatched().mass_matrix(q)));
            let plain = $robot::mass_matrix(q);
            let largest = plain.iter().flatten().fold(0.0, |largest: $scalar, element| largest.max(element.abs()));
            for (row, column) in (0..NV * NV).map(|place| (place / NV, place % NV)) {
                let element = matrix[row][column];
                assert_eq!(element.to_bits(), matrix[column][row].to_bits(), "symmetric");
                let difference = (element - plain[row][column]).abs();
                assert!(difference <= 16.0 * <$scalar>::EPSILON * largest, "row {row}, column {column}: {difference}");
                let of_two_legs = row > 5 && column > 5 && (row - 6) / OF_LEG != (column - 6) / OF_LEG;
                assert!(!of_two_legs || element == 0.0, "two legs move each other's bodies");
            }
        }
    }};
}

#[test]
fn mass_matrices_of_robots_with_four_legs_are_those_of_each_state_alone() {
    redysim! { struct Quadruped("models/quadruped.toml", functions = [mass_matrix]); }
    // Some of its elements are sines.
    redysim! { struct Hopper("models/test/hopper.toml", functions = [mass_matrix]); }
    mass_matrices_are_those_of_each_state!(Quadruped, f64);
    mass_matrices_are_those_of_each_state!(Quadruped, f32);
    mass_matrices_are_those_of_each_state!(Hopper, f64);
    mass_matrices_are_those_of_each_state!(Hopper, f32);
}

/// Their code takes long to compile: `.ci/run` alone has them, for any processor with the feature `deterministic`.
#[test]
#[cfg(any(feature = "deterministic", target_feature = "fma", not(target_arch = "x86_64")))]
fn states_of_other_robots_in_space_give_the_bits_of_each_alone() {
    use crate::robots_in_space::{Floating, Pendulum, Series};
    each_state_in_space_is_as_if_alone!(Pendulum, f64);
    each_state_in_space_is_as_if_alone!(Pendulum, f32);
    each_state_in_space_is_as_if_alone!(Floating, f64);
    each_state_in_space_is_as_if_alone!(Floating, f32);
    each_state_in_space_is_as_if_alone!(Series, f64);
    each_state_in_space_is_as_if_alone!(Series, f32);
}

#[test]
fn a_branching_mechanism_has_its_own_number_of_joints() {
    let [q, v, tau]: [Vec<[f64; 4]>; 3] = [1, 2, 3].map(|seed| numbers(seed, 100));
    let mut a = vec![[0.0; 4]; 100];
    batch::forward_dynamics(&Gripper, &q, &v, &tau, &mut a).unwrap();
    for (state, a) in a.iter().enumerate() {
        assert_eq!(*a, Gripper.dispatched().forward_dynamics(&q[state], &v[state], &tau[state]));
    }
}

/// In `f64` within 16 roundings of numbers below 10 (m, m/s), which is what fused products change.
#[test]
fn a_dispatched_mechanism_has_all_functions_of_a_tree() {
    fn values(mechanism: &impl TreeDynamics<f64, Coordinates = [f64; 6], Velocities = [f64; 6]>) -> Vec<[f64; 8]> {
        let [q, v]: [Vec<[f64; 6]>; 2] = [1, 2].map(|seed| numbers(seed, 100));
        let all = q.iter().zip(&v).map(|(q, v)| {
            let (center, energy) = (mechanism.center_of_mass(q, v), mechanism.energy(q, v));
            let ([x, y, z], [vx, vy, vz]) = (center.position, center.velocity);
            [x, y, z, vx, vy, vz, 1e-2 * energy.kinetic, 1e-2 * energy.potential]
        });
        all.collect()
    }
    let (plain, dispatched) = (values(&Kr5), values(&Kr5.dispatched()));
    for (plain, dispatched) in plain.iter().flatten().zip(dispatched.iter().flatten()) {
        assert!(plain.abs() < 10.0 && (plain - dispatched).abs() < 160.0 * f64::EPSILON, "{plain} {dispatched}");
    }
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let [q, v, tau]: [Vec<[f64; 6]>; 3] = [1, 2, 3].map(|seed| numbers(seed, 3001));
    let on = |threads: usize| {
        let mut a = vec![[0.0; 6]; q.len()];
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| batch::forward_dynamics(&Kr5, &q, &v, &tau, &mut a)).unwrap();
        bits(&a)
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one, on(7));
}

/// States beside one whose angles need the exact reduction, or are not numbers, are as if alone.
#[test]
fn one_bad_state_spoils_no_other() {
    let [mut q, v, a]: [Vec<[f64; 6]>; 3] = [1, 2, 3].map(|seed| numbers(seed, 20));
    q[3][1] = 1e300;
    q[7][2] = f64::NAN;
    let mut tau = vec![[0.0; 6]; 20];
    batch::inverse_dynamics(&Kr5, &q, &v, &a, &mut tau).unwrap();
    for (state, tau) in tau.iter().enumerate() {
        assert_eq!(tau.iter().any(|force| force.is_nan()), state == 7, "state {state}: {tau:?}");
        let alone: [f64; 6] = Kr5.dispatched().inverse_dynamics(&q[state], &v[state], &a[state]);
        assert!(state == 7 || *tau == alone, "state {state}: {tau:?} {alone:?}");
    }
}

#[test]
fn a_wrong_length_is_named_and_nothing_is_written() {
    let states = [[0.5; 6]; 8];
    let short = [[0.5; 6]; 7];
    let mut found = [[9.0; 6]; 8];
    let expected = |vector| Err(LengthMismatch { vector, length: 7, expected: 8 });
    assert_eq!(batch::inverse_dynamics(&Kr5, &states, &short, &states, &mut found), expected("v"));
    assert_eq!(batch::inverse_dynamics(&Kr5, &states, &states, &short, &mut found), expected("a"));
    assert_eq!(batch::inverse_dynamics(&Kr5, &states, &states, &states, &mut found[..7]), expected("tau"));
    assert_eq!(batch::forward_dynamics(&Kr5, &states, &short, &states, &mut found), expected("v"));
    assert_eq!(batch::forward_dynamics(&Kr5, &states, &states, &short, &mut found), expected("tau"));
    assert_eq!(batch::forward_dynamics(&Kr5, &states, &states, &states, &mut found[..7]), expected("a"));
    assert_eq!(batch::bias_forces(&Kr5, &states, &short, &mut found), expected("v"));
    assert_eq!(batch::bias_forces(&Kr5, &states, &states, &mut found[..7]), expected("tau"));
    assert_eq!(batch::gravity_forces(&Kr5, &states, &mut found[..7]), expected("tau"));
    assert_eq!(batch::map(&states, &mut found[..7], |q| q), expected("results"));
    assert_eq!(batch::evaluate(&Held, &states, &mut found[..7]), expected("results"));
    assert_eq!(batch::mass_matrix(&Kr5, &states, &mut [[[0.0; 6]; 6]; 7]), expected("matrices"));
    assert_eq!(found, [[9.0; 6]; 8]);
    let mismatch = LengthMismatch { vector: "v", length: 7, expected: 8 };
    assert_eq!(mismatch.to_string(), "`v` must have 8 elements, but it has 7");
}

#[test]
fn what_stays_on_one_thread_allocates_nothing() {
    let [q, v, tau]: [Vec<[f64; 6]>; 3] = [1, 2, 3].map(|seed| numbers(seed, batch::SERIAL));
    let mut a = vec![[0.0; 6]; q.len()];
    let allocations = allocation_counter::measure(|| batch::forward_dynamics(&Kr5, &q, &v, &tau, &mut a).unwrap());
    assert_eq!(allocations.count_total, 0);
}

/// FNV-1a over the bits of numbers.
fn hash(bits: impl IntoIterator<Item = u64>) -> u64 {
    let bytes = bits.into_iter().flat_map(u64::to_le_bytes);
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

fn hashes<T: Batched>() -> [u64; 3] {
    // Numbers that do not stand on any library's functions.
    let number = |index: usize| T::from_f64((index as u64).wrapping_mul(6364136223846793005) as i64 as f64 / 3e18);
    let states: Vec<[T; 6]> = (0..600).map(|i| core::array::from_fn(|j| number(6 * i + j))).collect();
    let (mut tau, mut a, mut matrices) = (states.clone(), states.clone(), vec![[[T::default(); 6]; 6]; 600]);
    batch::inverse_dynamics(&Kr5, &states, &states, &states, &mut tau).unwrap();
    batch::forward_dynamics(&Kr5, &states, &states, &states, &mut a).unwrap();
    batch::mass_matrix(&Kr5, &states, &mut matrices).unwrap();
    [hash(bits(&tau)), hash(bits(&a)), hash(matrices.iter().flat_map(|matrix| bits(matrix)))]
}

/// Pinned with the program compiled for any x86-64 and natively, on processors with AVX-512: the same numbers. To be
/// pinned anew when the generated code changes, after the same new numbers were seen with other `-C target-cpu`.
#[test]
fn the_bits_do_not_depend_on_what_the_program_is_compiled_for() {
    let fused = [
        [4770548337061733221, 3910272778982865747, 16089689541764406970],
        [701672381947879220, 5291734134659613147, 1690568381515113399],
    ];
    let unfused = [
        [12373911788890246604, 1216704644462582190, 11875352451816909544],
        [316879662898407888, 18237901398957410797, 16883610195308516580],
    ];
    let found = [hashes::<f64>(), hashes::<f32>()];
    // A call that chooses its instructions shows whether multiply-adds round once. The features of this crate do not: tests of
    // the whole workspace share a runtime with the macro, which asks it for `deterministic`.
    let state = [0.3, -1.1, 0.7, 2.0, -0.4, 1.9];
    let chosen = Kr5.dispatched().forward_dynamics(&state, &state, &state);
    let is_fused = redysim::FUSED || chosen != Kr5::forward_dynamics(&state, &state, &state);
    assert_eq!(found, if is_fused { fused } else { unfused });
}
