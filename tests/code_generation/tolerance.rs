//! A pruned mechanism is wrong by less than its tolerance, measured in states that the generator has not seen, and it
//! is cheaper.

use super::operation_counts::Kr5;
use crate::common::random::Random;
use redysim::Real;
use redysim::generic::Model;
use redysim::{Operations, redysim};
use redysim_model::JointRange;

/// What is compared at each tolerance.
trait Robot {
    const TOLERANCE: f64;
    fn results(q: &[f64; 6], v: &[f64; 6], a: &[f64; 6], tau: &[f64; 6]) -> [Vec<f64>; 5];
}

macro_rules! robots {
    ($($robot:ident, $tolerance:literal;)*) => {$(
        redysim! {
            #[doc = concat!("KR5 to a tolerance of ", $tolerance)]
            struct $robot(
                "models/test/kr5_ranges.toml",
                tolerance = $tolerance,
                functions = [inverse_dynamics, forward_dynamics, mass_matrix, bias_forces, gravity_forces],
            );
        }
        impl Robot for $robot {
            const TOLERANCE: f64 = $tolerance;
            fn results(q: &[f64; 6], v: &[f64; 6], a: &[f64; 6], tau: &[f64; 6]) -> [Vec<f64>; 5] {
                [
                    $robot::inverse_dynamics(q, v, a).to_vec(),
                    $robot::forward_dynamics(q, v, tau).to_vec(),
                    $robot::mass_matrix(q).concat(),
                    $robot::bias_forces(q, v).to_vec(),
                    $robot::gravity_forces(q).to_vec(),
                ]
            }
        }
    )*};
}

robots! {
    To1, 1e-1;
    To2, 1e-2;
}

// To prune one takes seconds in the compiler.
#[cfg(not(debug_assertions))]
robots! {
    To3, 1e-3;
    To4, 1e-4;
    To5, 1e-5;
    To6, 1e-6;
}

const NAMES: [&str; 5] = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces", "gravity_forces"];

fn flops(operations: &Operations) -> [u32; 5] {
    let Operations { inverse_dynamics, forward_dynamics, mass_matrix, bias_forces, gravity_forces, .. } = operations;
    [inverse_dynamics, forward_dynamics, mass_matrix, bias_forces, gravity_forces].map(|count| count.flops())
}

fn ranges() -> [JointRange; 6] {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/test/kr5_ranges.toml");
    let model = Model::load(path).expect("a good model").model;
    std::array::from_fn(|joint| model.links[joint].range[0])
}

/// A state somewhere in the ranges: each number evenly spread, and one in three at an end.
fn state(random: &mut Random, ranges: &[JointRange; 6]) -> [[f64; 6]; 3] {
    let mut share = || {
        let share = random.within(1.0);
        if random.below(3) == 0 { share.signum() } else { share }
    };
    let position = ranges.map(|JointRange { position: [a, b], .. }| 0.5 * (a + b) + 0.5 * (b - a) * share());
    let velocity = ranges.map(|range| range.velocity * share());
    let acceleration = ranges.map(|range| range.acceleration.expect("a range with an acceleration") * share());
    [position, velocity, acceleration]
}

/// The worst error of each function, as a share of the largest value of that component, or of √(M_ii M_jj).
fn errors<R: Robot>(states: usize) -> [f64; 5] {
    let (mut random, ranges) = (Random::new(99), ranges());
    let mut sizes: [Vec<f64>; 5] = std::array::from_fn(|_| vec![0.0; 36]);
    let mut worst: [Vec<f64>; 5] = sizes.clone();
    for _ in 0..states {
        let [q, v, a] = state(&mut random, &ranges);
        let tau = Kr5::inverse_dynamics(&q, &v, &a);
        let expected = [
            tau.to_vec(),
            a.to_vec(),
            Kr5::mass_matrix(&q).concat(),
            Kr5::bias_forces(&q, &v).to_vec(),
            Kr5::gravity_forces(&q).to_vec(),
        ];
        for (function, (found, expected)) in R::results(&q, &v, &a, &tau).iter().zip(&expected).enumerate() {
            for (component, (found, expected)) in found.iter().zip(expected).enumerate() {
                assert!(found.is_finite(), "function {function}, component {component}: {found}");
                sizes[function][component] = sizes[function][component].max(expected.abs());
                worst[function][component] = worst[function][component].max((found - expected).abs());
            }
        }
    }
    std::array::from_fn(|function| {
        let scale = |k: usize| match function {
            2 => (sizes[2][k / 6 * 7] * sizes[2][k % 6 * 7]).sqrt(),
            _ => sizes[function][k],
        };
        let shares = worst[function].iter().enumerate().filter(|(_, error)| **error > 0.0);
        shares.map(|(component, error)| error / scale(component)).fold(0.0, Real::maximum)
    })
}

fn holds<R: Robot>() {
    let errors = errors::<R>(if cfg!(debug_assertions) { 2_000 } else { 20_000 });
    for (name, error) in NAMES.iter().zip(errors) {
        println!("{name} to {:e}: {error:.2e}", R::TOLERANCE);
        assert!(error <= R::TOLERANCE, "{name} to {:e}: {error:e}", R::TOLERANCE);
    }
}

#[test]
fn errors_stay_within_the_tolerance() {
    holds::<To1>();
    holds::<To2>();
    #[cfg(not(debug_assertions))]
    {
        holds::<To3>();
        holds::<To4>();
        holds::<To5>();
        holds::<To6>();
    }
}

#[test]
fn a_larger_tolerance_never_costs_more() {
    let mut operations = vec![Kr5::OPS];
    #[cfg(not(debug_assertions))]
    operations.extend([To6::OPS, To5::OPS, To4::OPS, To3::OPS]);
    operations.extend([To2::OPS, To1::OPS]);
    let table: Vec<_> = operations.iter().map(flops).collect();
    for (finer, coarser) in table.iter().zip(&table[1..]) {
        for (name, (finer, coarser)) in NAMES.iter().zip(finer.iter().zip(coarser)) {
            assert!(coarser <= finer, "{name}: {coarser} after {finer}");
        }
    }
    // Inverse dynamics, forward dynamics, mass matrix at 1 %, of 330, 581 and 156.
    let [inverse, forward, mass, ..] = flops(&To2::OPS);
    assert!(inverse <= 250 && forward <= 500 && mass <= 85, "{inverse} {forward} {mass}");
}

/// The row of the README's table of the KR5 whose first cell is `name`.
fn stated_row(name: &str) -> Vec<u32> {
    let readme = include_str!("../../README.md");
    let table = readme.split_once("| operations of the [KR5]").expect("its table").1;
    let row = table.lines().find_map(|line| line.strip_prefix(&format!("| {name} | "))).expect("a row");
    row.trim_end_matches(" |").split(" | ").map(|count| count.parse().expect("a count")).collect()
}

#[test]
fn the_readme_states_the_operations_at_each_tolerance() {
    let columns = [
        (0, Kr5::OPS),
        #[cfg(not(debug_assertions))]
        (1, To4::OPS),
        #[cfg(not(debug_assertions))]
        (2, To3::OPS),
        (3, To2::OPS),
        (4, To1::OPS),
    ];
    for (row, name) in NAMES[..3].iter().enumerate() {
        let stated = stated_row(&name.replace('_', " "));
        assert_eq!(stated.len(), 5);
        for (column, operations) in &columns {
            assert_eq!(stated[*column], flops(operations)[row], "{name}");
        }
    }
}

/// The scale of the mass matrix has the largest diagonal elements; at a position where they are smaller, the same error
/// is a larger share.
#[test]
fn the_readme_states_what_share_of_the_mass_matrix_at_the_position_itself_is_lost() {
    let (mut random, ranges) = (Random::new(99), ranges());
    let mut worst = 0.0_f64;
    for _ in 0..20_000 {
        let [q, ..] = state(&mut random, &ranges);
        let (exact, pruned) = (Kr5::mass_matrix(&q), To1::mass_matrix(&q));
        for (i, row) in exact.iter().enumerate() {
            for (j, element) in row.iter().enumerate() {
                worst = Real::maximum(worst, (pruned[i][j] - element).abs() / (exact[i][i] * exact[j][j]).sqrt());
            }
        }
    }
    let readme = include_str!("../../README.md");
    let stated = readme.split_once("of the KR5 at 1e-1, ").expect("a sentence").1.split_once(" %").expect("a share").0;
    assert_eq!(stated.parse(), Ok((100.0 * worst).round()), "{worst}");
}
