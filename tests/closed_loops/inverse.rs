//! Inverse dynamics of closed loops against ReDySim's own.
//!
//! Where the files come from: `tests/reference/README.md`.
#![cfg(feature = "generic")]

use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::linkages::{Fourbar, SliderCrank, ThreeRrr};
use crate::redundant::FourbarSpatial;
use redysim::{
    ClosedLoop, ClosedLoopComputedTorque, ClosedLoopInverse, ClosedLoopSimulation, IntegrationError, Integrator,
    LengthMismatch, LoopError, LoopRows, Motion, Ode45,
};

const GUESS: [f64; 3] = [0.0, 0.9844, 4.3144];
/// 45 turns a minute.
const SPEED: f64 = 4.712_388_980_384_69;

fn turning(t: f64) -> Motion<[f64; 1], [f64; 1]> {
    Motion { q: [SPEED * t], v: [SPEED], a: [0.0] }
}

fn rows(text: &str) -> impl Iterator<Item = Vec<f64>> + '_ {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| line.split(',').map(|number| number.parse().expect("a number")).collect())
}

#[test]
fn the_four_bar_needs_the_torque_of_redysim_along_the_whole_turn() {
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS);
    let mut forces = Comparison::new("crank torque and multipliers");
    let mut motion = Comparison::new("motion");
    for row in rows(include_str!("../reference/golden_octave_ID_Hoken_Fourbar.csv")) {
        let found = inverse.at(row[0], &turning).expect("the crank turns freely");
        let Motion { q, v, a } = found.motion;
        motion.add(&[q, v, a].concat(), &row[1..10]);
        forces.add(&[found.forces[0], found.multipliers[0], found.multipliers[1]], &row[10..13]);
        assert_eq!((found.rank, found.redundancy), (2, 0));
        assert_eq!(found.forces[1..], [0.0, 0.0]);
    }
    motion.assert_within(1e-10);
    forces.assert_within(1e-10);
}

#[test]
fn no_assembly_mode_is_left_over_many_turns_and_far_instants() {
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS);
    let turn = std::f64::consts::TAU / SPEED;
    let start = inverse.at(0.0, &turning).expect("it closes").motion.q;
    let later = inverse.at(3.0 * turn, &turning).expect("it closes").motion.q;
    for (i, way) in [6.0 * std::f64::consts::PI, 0.0, 0.0].into_iter().enumerate() {
        assert!((later[i] - start[i] - way).abs() < 1e-12, "{later:?}");
    }
}

#[test]
fn the_three_legs_need_the_torques_of_redysim() {
    let text = include_str!("../reference/golden_octave_ID_3-RRR_Parallel_robot.csv");
    let first: Vec<f64> = rows(text).next().expect("a row");
    let guess: [f64; 7] = core::array::from_fn(|i| first[1 + i] + 1e-3);
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&ThreeRrr), &[0, 3, 5], guess);
    let mut motion = Comparison::new("motion");
    let mut forces = Comparison::new("torques and multipliers");
    for row in rows(text) {
        let pick = |from: usize| [row[from], row[from + 3], row[from + 5]];
        let prescribed = |_: f64| Motion { q: pick(1), v: pick(8), a: pick(15) };
        let found = inverse.at(row[0], &prescribed).expect("it closes");
        let Motion { q, v, a } = found.motion;
        motion.add(&[q, v, a].concat(), &row[1..22]);
        let torques = [0, 3, 5].map(|i| found.forces[i]);
        forces.add(&[&torques[..], &found.multipliers[..]].concat(), &row[22..29]);
        assert_eq!((found.rank, found.redundancy), (4, 0));
    }
    println!("{:?} {:?}", motion.worst(), forces.worst());
    motion.assert_within(1e-10);
    forces.assert_within(1e-10);
}

#[test]
fn redundant_actuators_share_the_load_by_the_least_norm_and_are_counted() {
    let one = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS).at(0.2, &turning).expect("it closes");
    let mut both = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS).actuated(&[0, 1]);
    let found = both.at(0.2, &turning).expect("it closes");
    assert_eq!((found.rank, found.redundancy), (2, 1));
    let norm = |forces: &[f64], lambda: &[f64]| forces.iter().chain(lambda).map(|x| x * x).sum::<f64>();
    assert!(norm(&found.forces, &found.multipliers) < 0.99 * norm(&one.forces, &one.multipliers));
    // Both balance the tree; the least norm is orthogonal to their difference.
    let jacobian = Fourbar::loop_jacobian(&found.motion.q);
    let Motion { q, v, a } = found.motion;
    let needed = Fourbar::inverse_dynamics(&q, &v, &a);
    for i in 0..3 {
        let by_loop: f64 = (0..2).map(|row| jacobian[row][i] * found.multipliers[row]).sum();
        assert!((found.forces[i] + by_loop - needed[i]).abs() < 1e-12);
    }
    let pairs = found.forces.iter().chain(&found.multipliers).zip(one.forces.iter().chain(&one.multipliers));
    let along: f64 = pairs.map(|(x, y)| x * (x - y)).sum();
    assert!(along.abs() < 1e-10, "{along:e}");
}

#[test]
fn redundant_rows_do_not_count_as_redundant_actuators() {
    let planar = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS).at(0.3, &turning).expect("it closes");
    let mut spatial = ClosedLoopInverse::new(ClosedLoop::new(&FourbarSpatial), &[0], GUESS);
    let found = spatial.at(0.3, &turning).expect("it closes");
    assert!(FourbarSpatial.nc() > 2);
    assert_eq!((found.rank, found.redundancy), (2, 0));
    assert!((found.forces[0] - planar.forces[0]).abs() < 1e-10, "{found:?}");
}

#[test]
fn unreachable_undetermined_and_unactuated_motions_are_refused() {
    // The rocker swings, it does not turn: coordinate 1 cannot go round.
    let swing = |t: f64| Motion { q: [GUESS[1] + t], v: [1.0], a: [0.0] };
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[1], GUESS);
    inverse.at(0.1, &swing).expect("within reach");
    let error = inverse.at(3.0, &swing).unwrap_err();
    assert!(
        matches!(error, LoopError::Unreachable { t: 3.0, velocity: 1, position_residual: gap } if gap > 1e-6),
        "{error}"
    );

    let nothing = |_: f64| Motion { q: [0.0; 0], v: [0.0; 0], a: [0.0; 0] };
    let error = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[], GUESS).at(0.0, &nothing).unwrap_err();
    assert_eq!(error, LoopError::RankDeficient { rank: 2, needed: 3, rows: redysim::RowSet::default() });

    let error = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], GUESS).actuated(&[]).at(0.0, &turning);
    assert!(matches!(error, Err(LoopError::Unactuated { .. })), "{error:?}");
    let error = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[3], GUESS).at(0.0, &turning).unwrap_err();
    assert_eq!(error, LoopError::VelocityOutOfRange { velocity: 3, count: 3 });
}

#[test]
fn accelerations_that_contradict_each_other_are_refused() {
    let loops = ClosedLoop::new(&Fourbar);
    let closed = loops.assemble(&[0.3, 1.1, 4.2], &[1.0, 0.0, 0.0], &[0]).expect("it closes");
    let (q, v) = ([closed.q[0], closed.q[1]], [closed.v[0], closed.v[1]]);
    let trajectory = |_t: f64| redysim::Motion { q, v, a: [0.0, 50.0] };
    let error = ClosedLoopInverse::new(loops, &[0, 1], closed.q).at(0.0, &trajectory).unwrap_err();
    assert!(matches!(error, LoopError::InconsistentVelocity { .. }), "{error}");
}

#[test]
fn each_independent_velocity_has_one_component_of_the_trajectory() {
    let loops = ClosedLoop::new(&Fourbar);
    let rest = |_t: f64| redysim::Motion { q: [0.0; 2], v: [0.0; 2], a: [0.0; 2] };
    let error = ClosedLoopInverse::new(loops, &[0, 0], [0.3, 1.1, 4.2]).at(0.0, &rest).unwrap_err();
    assert_eq!(error, LoopError::RepeatedVelocity { velocity: 0 });
    let error = ClosedLoopInverse::new(loops, &[0], [0.3, 1.1, 4.2]).at(0.0, &rest).unwrap_err();
    assert_eq!(error, LoopError::WrongLength(LengthMismatch { vector: "trajectory.q", length: 2, expected: 1 }));
}

#[test]
fn each_independent_velocity_has_one_component_of_the_gains() {
    let fourbar = generic("fourbar");
    let motion = |_t: f64| redysim::Motion { q: vec![0.3], v: vec![0.0], a: vec![0.0] };
    let law = ClosedLoopComputedTorque::new(ClosedLoop::new(&fourbar), &[0], motion, [vec![1.0; 2], vec![1.0]]);
    let mismatch = LengthMismatch { vector: "kp", length: 2, expected: 1 };
    assert_eq!(law.forces(0.0, &GUESS.to_vec(), &vec![0.0; 3]), Err(LoopError::WrongLength(mismatch)));
    let mut simulation = ClosedLoopSimulation::new(ClosedLoop::new(&fourbar), law);
    let start = simulation.state(&GUESS.to_vec(), &vec![0.0; 3]);
    let error = Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err();
    assert_eq!(error, IntegrationError::WrongLength(mismatch));
}

#[test]
fn a_deficient_rank_is_reported_with_the_dependent_rows() {
    let loops = ClosedLoop::new(&SliderCrank);
    // Crank and coupler point opposite ways: the slider is at the crank's pivot, and the crank turns freely about it.
    let closed = loops.assemble(&[0.0, core::f64::consts::PI, 0.0], &[0.0; 3], &[0, 2]).expect("it closes");
    let rest = |_t: f64| Motion { q: [0.0], v: [0.0], a: [0.0] };
    let error = ClosedLoopInverse::new(loops, &[2], closed.q).at(0.0, &rest).unwrap_err();
    let LoopError::RankDeficient { rank: 1, needed: 2, rows } = error else { panic!("{error}") };
    assert_eq!(rows.iter().count(), 1, "{error}");
    assert!(loops.with_names(error).to_string().contains(SliderCrank::LOOP_NAMES[0]), "{}", loops.with_names(error));
}
