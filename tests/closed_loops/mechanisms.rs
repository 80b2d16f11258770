//! The loop models against what is known of the mechanisms: shipped starts, reference forces at the cuts, published and
//! exact motions.
//!
//! Where the files come from: `tests/reference/README.md`.
#![cfg(feature = "generic")]

use crate::common::andrews;
use crate::common::call::{bias_forces, inverse_dynamics, loop_bias, loop_jacobian, loop_residual, mass_matrix};
use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::common::random::Random;
use nalgebra::{DMatrix, DVector};
use redysim::generic::GenericMechanism;
use std::f64::consts::{FRAC_PI_2, PI};

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| if x.abs() <= largest { largest } else { x.abs() })
}

fn jacobian(mechanism: &GenericMechanism, q: &[f64]) -> DMatrix<f64> {
    let rows = loop_jacobian(mechanism, q);
    DMatrix::from_fn(rows.len(), q.len(), |i, j| rows[i][j])
}

fn vector(values: &[f64]) -> DVector<f64> {
    DVector::from_column_slice(values)
}

/// J v, the rates of the residual.
fn rates(mechanism: &GenericMechanism, q: &[f64], v: &[f64]) -> Vec<f64> {
    (jacobian(mechanism, q) * vector(v)).as_slice().to_vec()
}

/// J a + J̇ v, the second rates of the residual.
fn second_rates(mechanism: &GenericMechanism, q: &[f64], v: &[f64], a: &[f64]) -> Vec<f64> {
    (jacobian(mechanism, q) * vector(a) + vector(&loop_bias(mechanism, q, v))).as_slice().to_vec()
}

/// Accelerations and multipliers from M a + h = τ + Jᵀλ and J a + J̇ v = 0, all in one linear system.
fn motion(mechanism: &GenericMechanism, q: &[f64], v: &[f64], tau: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (jacobian, inertia) = (jacobian(mechanism, q), mass_matrix(mechanism, q));
    let (nv, nc) = (q.len(), jacobian.nrows());
    let system = DMatrix::from_fn(nv + nc, nv + nc, |i, j| match (i < nv, j < nv) {
        (true, true) => inertia[i][j],
        (true, false) => -jacobian[(j - nv, i)],
        (false, true) => jacobian[(i - nv, j)],
        (false, false) => 0.0,
    });
    let (forces, bias) = (vector(tau) - vector(&bias_forces(mechanism, q, v)), loop_bias(mechanism, q, v));
    let right = DVector::from_fn(nv + nc, |i, _| if i < nv { forces[i] } else { -bias[i - nv] });
    let solution = system.lu().solve(&right).expect("a position that is not singular");
    (solution.as_slice()[..nv].to_vec(), solution.as_slice()[nv..].to_vec())
}

/// The rows of a reference, cut into columns of the given widths.
fn reference<const COLUMNS: usize>(text: &str, widths: [usize; COLUMNS]) -> Vec<[Vec<f64>; COLUMNS]> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let rows = lines.map(|line| {
        let mut numbers = line.split(',').map(|number| number.parse::<f64>().expect("a number"));
        let columns = widths.map(|width| numbers.by_ref().take(width).collect());
        assert_eq!(numbers.next(), None, "{line}");
        columns
    });
    rows.collect()
}

#[test]
fn shipped_starts_close_to_their_printed_digits() {
    for (name, q, unit) in [
        ("fourbar", &[0.0, 0.9844, 4.3144][..], 1e-4),
        ("three_rrr", &[1.9814, -2.3099, 0.3284, -1.605, -2.8061, 0.5403, -2.5131][..], 1e-4),
        ("leg", &[0.0, 4.511, -2.7389, -0.8764, -1.4604, -1.4604, -1.6812][..], 1e-4),
        ("slider_crank", &[-FRAC_PI_2, 2.0 * PI, 2.0][..], 2e-15),
        ("andrews", &andrews::START[..], 2e-15),
    ] {
        let mechanism = generic(name);
        let (residual, jacobian) = (loop_residual(&mechanism, q), jacobian(&mechanism, q));
        for (residual, row) in residual.iter().zip(jacobian.row_iter()) {
            // What half a unit of the last digit of each coordinate may add up to.
            let allowed = 0.5 * unit * row.abs().sum();
            assert!(residual.abs() <= allowed, "{name}: {residual:e} m, allowed {allowed:e} m");
        }
        println!("{name}: {:.1e} m", largest(&residual));
    }
}

/// The numbers are from the loops' vectors, summed in the plane with complex numbers by another program.
#[test]
fn the_residual_of_a_shipped_start_is_how_far_it_is_open() {
    let q = [1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869];
    let expected = [8.667854701798317e-3, -1.2887062751045786e-3, 9.48910764392863e-3, 1.5710720137542822e-3];
    let residual = loop_residual(&generic("three_rrr"), &q);
    assert!((vector(&residual) - vector(&expected)).amax() < 1e-15, "{residual:?}");

    let gui = generic("fourbar_gui");
    let residual = loop_residual(&gui, &[0.0, 145.54_f64.to_radians(), 130.54_f64.to_radians()]);
    let expected = [3.4039137372914377e-3, -2.587950012910506e-2];
    assert!((vector(&residual) - vector(&expected)).amax() < 1e-15, "{residual:?}");
    let closed = loop_residual(&gui, &[0.0, 2.278380763520252, 2.278380763520252]);
    assert!(largest(&closed) < 1e-15, "{closed:?}");
}

/// Along the trajectories of ReDySim's inverse dynamics, the loops are closed in position, velocity and acceleration,
/// and the joint forces of the tree are those of the actuators and of the cuts: τ = Sᵀ τ_actuated + Jᵀ λ. This holds
/// the order and the sign of the rows.
#[test]
fn reference_forces_at_the_cuts_balance_the_joint_forces() {
    fn check<const NV: usize>(name: &str, actuated: &[usize], text: &str) {
        let mechanism = generic(name);
        let mut forces = Comparison::new(format!("{name} joint forces"));
        let mut open = [0.0_f64; 3];
        for [_, q, v, a, actuators, multipliers] in
            reference(text, [1, NV, NV, NV, actuated.len(), NV - actuated.len()])
        {
            let mut sum = jacobian(&mechanism, &q).transpose() * vector(&multipliers);
            actuated.iter().zip(actuators).for_each(|(&joint, force)| sum[joint] += force);
            forces.add(sum.as_slice(), &inverse_dynamics(&mechanism, &q, &v, &a));
            let rows = [loop_residual(&mechanism, &q), rates(&mechanism, &q, &v), second_rates(&mechanism, &q, &v, &a)];
            open.iter_mut().zip(rows).for_each(|(open, rows)| *open = open.max(largest(&rows)));
        }
        let [position, velocity, acceleration] = open;
        println!("{name}: open by {position:.1e} m, {velocity:.1e} m/s, {acceleration:.1e} m/s²");
        assert!(position < 1e-15 && velocity < 1e-14 && acceleration < 1e-12);
        forces.assert_within(1e-10);
    }
    check::<3>("fourbar", &[0], include_str!("../reference/golden_octave_ID_Hoken_Fourbar.csv"));
    check::<7>("three_rrr", &[0, 3, 5], include_str!("../reference/golden_octave_ID_3-RRR_Parallel_robot.csv"));
}

/// Along free motions in quadruple precision without stabilisation: the residual stays what it was at the start, and
/// the multipliers are the reference's.
#[test]
fn multipliers_along_free_motions_are_the_references() {
    fn check<const NV: usize, const NC: usize>(name: &str, expected: f64, text: &str) {
        let mechanism = generic(name);
        let mut multipliers = Comparison::new(format!("{name} multipliers"));
        let rows = reference(text, [1, NV, NV, 3, NC]);
        let at_start = vector(&loop_residual(&mechanism, &rows[0][1]));
        assert!((at_start.amax() - expected).abs() < 1e-6, "{name}: open by {:e} m", at_start.amax());
        let (mut drift, mut rate) = (0.0_f64, 0.0_f64);
        for [_, q, v, _, expected] in &rows {
            drift = drift.max((vector(&loop_residual(&mechanism, q)) - &at_start).amax());
            rate = rate.max(largest(&rates(&mechanism, q, v)));
            multipliers.add(&motion(&mechanism, q, v, &[0.0; NV]).1, expected);
        }
        println!("{name}: residual to {drift:.1e} m, rate {rate:.1e} m/s");
        multipliers.assert_within(1e-9);
    }
    check::<3, 2>("fourbar", 0.0, include_str!("../reference/golden_ref_hoken_spin_consistent.csv"));
    check::<3, 2>("fourbar_gui", 25.879e-3, include_str!("../reference/golden_ref_fourbar_v2.csv"));
    check::<7, 4>("three_rrr", 9.489e-3, include_str!("../reference/golden_ref_rrr3.csv"));
}

#[test]
fn andrews_mechanism_accelerates_as_published() {
    let mechanism = generic("andrews");
    let check = |q: &[f64], v: &[f64], a: &[f64], lambda: &[f64], tolerance: f64| {
        let (accelerations, multipliers) = motion(&mechanism, q, v, &andrews::TORQUES);
        for (computed, published) in [(accelerations, a), (multipliers, lambda)] {
            let error = (vector(&computed) - vector(published)).amax() / largest(published);
            println!("error {error:.1e}");
            assert!(error < tolerance, "{error:e}: {computed:?}, not {published:?}");
        }
    };
    use andrews::{END, END_ACCELERATIONS, END_MULTIPLIERS, END_VELOCITIES, START};
    assert!(largest(&loop_residual(&mechanism, &START)) < 1e-16);
    check(&START, &[0.0; 7], &andrews::START_ACCELERATIONS, &andrews::START_MULTIPLIERS, 1e-12);
    assert!(largest(&loop_residual(&mechanism, &END)) < 1e-11);
    check(&END, &END_VELOCITIES, &END_ACCELERATIONS, &END_MULTIPLIERS, 1e-5);
}

/// While its cranks stay parallel, the N-four-bar is a pendulum: α̈ = c sin α, c = g ((N+1)/2 + N) / ((N+1)/3 + N).
#[test]
fn the_n_fourbar_moves_as_its_exact_solution() {
    for windows in [2, 40] {
        let mechanism = generic(&format!("n_fourbar_{windows}"));
        let n = windows as f64;
        let c = 9.81 * ((n + 1.0) / 2.0 + n) / ((n + 1.0) / 3.0 + n);
        // A crank, then pairs of coupler and crank.
        let all = |alpha: f64| -> Vec<f64> {
            (0..=2 * windows).map(|joint| if joint % 2 == 0 { -alpha } else { alpha }).collect()
        };
        let mut random = Random::new(5);
        for _ in 0..10 {
            let (alpha, rate) = (random.within(1.4), random.within(7.0));
            let (q, v, a) = (all(alpha), all(rate), all(c * alpha.sin()));
            // The last crank stands N metres from the origin, and so many times the roundoff of a metre is in its rows.
            let rows = [loop_residual(&mechanism, &q), rates(&mechanism, &q, &v), second_rates(&mechanism, &q, &v, &a)];
            let [position, velocity, acceleration] = rows.map(|rows| largest(&rows) / n);
            assert!(position < 1e-15 && velocity < 1e-14 && acceleration < 1e-13);
            let (accelerations, _) = motion(&mechanism, &q, &v, &vec![0.0; q.len()]);
            let error = (vector(&accelerations) - vector(&a)).amax();
            assert!(error < 1e-10, "N = {windows}, alpha = {alpha}: {error:e} rad/s²");
        }
        let rank = |alpha: f64| jacobian(&mechanism, &all(alpha)).rank(1e-9);
        assert_eq!((rank(1.0), rank(FRAC_PI_2)), (2 * windows, windows), "flat, each window loses a row");
    }
}

/// The four-bar in space has one row more than the planar one, but the same loop: what does not depend on the axes of
/// the base frame is the same.
#[test]
fn the_spatial_fourbar_has_the_rank_and_the_forces_of_the_planar_one() {
    let (planar, spatial) = (generic("fourbar"), generic("test/fourbar_spatial"));
    let mut random = Random::new(6);
    for _ in 0..100 {
        let state = random.state(3);
        let (q, v) = (&state.q, &state.v);
        let (in_plane, in_space) = (jacobian(&planar, q), jacobian(&spatial, q));
        assert_eq!((in_plane.shape(), in_space.shape()), ((2, 3), (3, 3)));
        assert_eq!((in_plane.rank(1e-9), in_space.rank(1e-9)), (2, 2));
        let columns = |rows: [Vec<f64>; 2], jacobian: &DMatrix<f64>| {
            let [residual, bias] = rows.map(|rows| jacobian.transpose() * vector(&rows));
            DMatrix::from_columns(&[residual, bias])
        };
        let wanted = columns([loop_residual(&planar, q), loop_bias(&planar, q, v)], &in_plane);
        let found = columns([loop_residual(&spatial, q), loop_bias(&spatial, q, v)], &in_space);
        assert!((found - &wanted).amax() <= 1e-14 * wanted.amax().max(1.0));
        assert!((in_space.transpose() * in_space - in_plane.transpose() * in_plane).amax() < 1e-16);
        let forces = vector(&bias_forces(&planar, q, v));
        assert!((vector(&bias_forces(&spatial, q, v)) - &forces).amax() < 1e-13 * forces.amax());
    }
}

/// Bricard's mechanism has as many rows as joints, and yet goes round: at every step along the direction that the rows
/// leave free, Newton's method closes it again, and one row is redundant.
#[test]
fn bricards_mechanism_moves_although_its_rows_are_as_many_as_its_joints() {
    let mechanism = generic("test/bricard");
    let mut q = DVector::from_element(5, 0.0);
    let mut along = DVector::from_element(5, 0.0);
    let mut travelled = 0.0;
    for step in 0..200 {
        let here = jacobian(&mechanism, q.as_slice());
        assert_eq!((here.shape(), here.rank(1e-6)), ((5, 5), 4), "step {step}");
        let free = (here.transpose() * &here).symmetric_eigen();
        let direction = free.eigenvectors.column(free.eigenvalues.imin()).into_owned();
        along = if direction.dot(&along) < 0.0 { -direction } else { direction };
        q += &along * 0.02;
        travelled += 0.02;
        for _ in 0..8 {
            let inverse = jacobian(&mechanism, q.as_slice()).pseudo_inverse(1e-4).expect("a positive tolerance");
            q -= inverse * vector(&loop_residual(&mechanism, q.as_slice()));
        }
        let open = largest(&loop_residual(&mechanism, q.as_slice()));
        assert!(open < 1e-14, "step {step}: open by {open:e}");
    }
    println!("after {travelled:.1} rad at {:.2?}", q.as_slice());
    assert!(q.amax() > 1.0, "it has moved: {q}");
}
