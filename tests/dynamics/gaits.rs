//! The tables of joint motion that the walking scenarios follow: feet go where the heads of the scenarios state, and the rates
//! in the tables are those of their angles.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use redysim::Real;
use redysim::generic::GenericMechanism;
use redysim::{Frames, LinkKinematics};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// The time between rows, s.
const STEP: f64 = 0.02;

/// A row of a table: joint angles, their rates and their accelerations.
struct Row {
    t: f64,
    motion: [Vec<f64>; 3],
}

fn table(scenario: &str) -> Vec<Row> {
    let path = format!("{}/scenarios/{scenario}.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a table");
    let rows = text.lines().skip(1).map(|line| {
        let numbers: Vec<f64> = line.split(',').map(|number| number.parse().expect("a number")).collect();
        let joints = numbers.len() / 3;
        Row { t: numbers[0], motion: [0, 1, 2].map(|order| numbers[1 + order * joints..][..joints].to_vec()) }
    });
    rows.collect()
}

/// Origins of the frames, with the trunk at `base` and the joints at the angles of a row.
fn frames(mechanism: &GenericMechanism, base: [f64; 7], row: &Row) -> Vec<[f64; 3]> {
    let q = [&base[..], &row.motion[0]].concat();
    let states = mechanism.frame_kinematics(&q, &vec![0.0; 6 + row.motion[0].len()]);
    states.iter().map(|state| state.origin).collect()
}

#[track_caller]
fn assert_at(found: [f64; 3], expected: [f64; 3], what: impl std::fmt::Display) {
    // The tables have nine digits of angles, of legs of up to a metre.
    let close = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 5e-9);
    assert!(close, "{what}: {found:?}, not {expected:?}");
}

/// Periods that have passed at the time `t`: one each second between a second in which the speed grows as
/// 10 s³ − 15 s⁴ + 6 s⁵ and one in which it falls in the same way.
fn periods(t: f64) -> f64 {
    let grown = |s: f64| s.powi(4) * (2.5 - 3.0 * s + s * s);
    match t {
        ..1.0 => grown(t),
        5.0.. => 5.0 - grown(6.0 - t),
        _ => t - 0.5,
    }
}

/// With the trunk moved by a stride of 0.3 m in each period and the hips 0.5 m above the ground, feet stand still for half a
/// period, and go forward by the stride on a cycloid, lifted by 0.09 m, for the other half.
#[test]
fn the_quadrupeds_feet_make_strides_of_30_cm_in_a_second_lifted_by_9_cm_under_hips_at_50_cm() {
    const STRIDE: f64 = 0.3;
    let quadruped = generic("quadruped");
    let rows = table("quadruped");
    assert_eq!(rows.len(), 301);
    for row in &rows {
        let base = [0.0, 0.5, STRIDE * periods(row.t), 0.0, 0.0, 0.0, 1.0];
        let feet = frames(&quadruped, base, row);
        // Rear right, rear left, front right, front left: two that stand diagonally step together.
        let legs = [(-0.25, -0.5, 0.5), (0.25, -0.5, 0.0), (-0.25, 0.5, 0.0), (0.25, 0.5, 0.5)];
        for (foot, (side, hip, delay)) in feet.into_iter().zip(legs) {
            let since = periods(row.t) - delay;
            let part = (2.0 * (since - since.floor())).min(1.0);
            let strides = since.floor() + part - (TAU * part).sin() / TAU;
            let lift = 0.09 * 64.0 * (part * (1.0 - part)).powi(3);
            // A step begins a quarter of the stride behind the hip.
            let forward = hip + STRIDE * (delay - 0.25 + strides);
            assert_at(foot, [side, lift, forward], format_args!("{} s", row.t));
        }
    }
    let start = [&[0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 1.0], &rows[0].motion[0][..]].concat();
    let links = quadruped.link_kinematics(&start, &vec![0.0; 18]);
    let hips = quadruped.model().links.iter().zip(&links).filter(|(link, _)| link.name.ends_with("hip"));
    assert_eq!(hips.map(|(_, hip)| hip.origin[1]).collect::<Vec<_>>(), [0.5; 4]);
}

/// With the trunk upright and the hips 0.9 m above the ground, which are 0.25 m below the trunk's centre.
#[test]
fn the_bipeds_flat_feet_make_six_steps_20_cm_ahead_of_each_other_lifted_by_5_cm_under_hips_at_90_cm() {
    let biped = generic("walking_biped");
    let rows = table("walking_biped");
    assert_eq!(rows.len(), 351);
    let mut hips = Vec::new();
    for row in &rows {
        let base = [0.0, 1.15, 0.0, 0.0, 0.0, -FRAC_1_SQRT_2, FRAC_1_SQRT_2];
        // Of the left foot, then of the right one.
        let [left_heel, left_toe, right_heel, right_toe] = frames(&biped, base, row).try_into().expect("four");
        // The step under way, or done.
        let step = ((row.t - 1.0) / 0.8 + 1e-9).floor();
        let (mut feet, mut lifts) = ([0.0; 2], [0.0; 2]);
        for k in 0..6 {
            let part = if step < f64::from(k) { 0.0 } else { ((row.t - 1.0 - 0.8 * f64::from(k)) / 0.6).min(1.0) };
            let foot = (k % 2) as usize;
            let target = f64::min(0.2 * f64::from(k + 1), 1.0);
            feet[foot] += (target - feet[foot]) * part.powi(3) * (10.0 - 15.0 * part + 6.0 * part * part);
            lifts[foot] += 0.05 * 64.0 * (part * (1.0 - part)).powi(3);
        }
        let hip = feet[0] - 0.5 * (left_heel[0] + left_toe[0]);
        hips.push(hip);
        for (foot, [heel, toe]) in [[left_heel, left_toe], [right_heel, right_toe]].into_iter().enumerate() {
            assert_at(heel, [feet[foot] - hip - 0.075, lifts[foot], 0.0], format_args!("heel {foot}, {} s", row.t));
            assert_at(toe, [feet[foot] - hip + 0.075, lifts[foot], 0.0], format_args!("toe {foot}, {} s", row.t));
        }
    }
    assert!(hips.windows(2).all(|pair| pair[1] >= pair[0] - 1e-9), "the hips go forward alone");
    // The hips come to rest a little short of where they are to be.
    assert!((hips[350] - hips[0] - 1.0).abs() < 1e-4, "{} m", hips[350] - hips[0]);
}

/// By Simpson's rule over two intervals: of three rows of which a step neither begins nor ends at the second, where third
/// derivatives jump.
fn assert_rates_are_those_of_the_angles(scenario: &str, jumps: impl Fn(usize) -> bool) {
    let rows = table(scenario);
    let mut worst = [0.0_f64; 2];
    for (index, rows) in rows.windows(3).enumerate().filter(|(index, _)| !jumps(index + 1)) {
        assert!((rows[2].t - rows[0].t - 2.0 * STEP).abs() < 1e-12, "row {index}");
        for (order, worst) in worst.iter_mut().enumerate() {
            for joint in 0..rows[0].motion[0].len() {
                let [before, at, after] = [0, 1, 2].map(|row| rows[row].motion[order + 1][joint]);
                let change = rows[2].motion[order][joint] - rows[0].motion[order][joint];
                *worst = Real::maximum(*worst, (change - STEP / 3.0 * (before + 4.0 * at + after)).abs());
            }
        }
    }
    println!("{scenario}: angles off by {:.1e} rad, rates by {:.1e} rad/s", worst[0], worst[1]);
    // The rule's error is h⁵/90 of the fifth and sixth derivatives of the angles, some 1e5 rad/s⁵ and 1e7 rad/s⁶; angles
    // change by up to 0.14 rad over two intervals, rates by up to 2 rad/s.
    assert!(worst[0] < 2e-5 && worst[1] < 5e-4, "{scenario}: {worst:?}");
}

#[test]
fn velocities_and_accelerations_in_the_tables_are_derivatives_of_the_angles() {
    // Steps begin each half second.
    assert_rates_are_those_of_the_angles("quadruped", |row| row % 25 == 0);
    // Steps begin after a second, each 0.8 s, and last 0.6 s.
    assert_rates_are_those_of_the_angles("walking_biped", |row| matches!((row + 30) % 40, 0 | 30));
}
