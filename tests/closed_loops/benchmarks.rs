//! Benchmark problems of the IFToMM library with closed loops: Andrews' squeezing mechanism (A03), and forty windows in
//! a row (A02), which fold flat and open again.
#![cfg(feature = "generic")]

use crate::common::andrews;
use crate::common::models::generic;
use crate::linkages::Andrews;
use redysim::Real;
use redysim::{ClosedLoop, ClosedLoopSimulation, Integrator, LoopClosure, MechanicalEnergy, Ode4, Ode45, ZeroTorque};

/// Digits of `computed` that are right, of a published number other than zero.
fn digits(computed: f64, published: f64) -> f64 {
    -((computed - published).abs() / published.abs()).max(1e-16).log10()
}

#[test]
fn andrews_mechanism_is_where_it_was_published_to_be() {
    let loops = ClosedLoop::new(&Andrews);
    let law = |_t: f64, _q: &[f64; 7], _v: &[f64; 7]| andrews::TORQUES;
    let mut squeezing = ClosedLoopSimulation::new(loops, law);
    let start = squeezing.start(&andrews::START, &[0.0; 7]).expect("the published start closes");
    let mut gap = 0.0_f64;
    let end = Ode45::new()
        .rtol(1e-12)
        .atol(1e-12)
        .each_step(&mut squeezing, (0.0, 0.03), start, |step| {
            let q: [f64; 7] = core::array::from_fn(|i| step.end().1[i]);
            gap = Andrews::loop_residual(&q).iter().fold(gap, |gap, residual| gap.max(residual.abs()));
        })
        .expect("it reaches the end");
    assert!(gap <= 1e-13, "{gap:e} m");
    for i in 0..7 {
        let (q, v) = (digits(end.y[i], andrews::END[i]), digits(end.y[7 + i], andrews::END_VELOCITIES[i]));
        println!("{i}: {q:.1} digits of the position, {v:.1} of the velocity");
        assert!(q >= 9.0, "coordinate {i}: {q:.1} digits");
        assert!(v >= 7.0, "velocity {i}: {v:.1} digits");
    }
}

/// Where the tip of the first crank is: exact, by elliptic functions.
const TIP_AT_10: [f64; 2] = [0.180_512_226_686_790_1, 0.983_572_740_582_311_6];

/// The motion of the windows while the cranks stay parallel: α̈ = c sin α for the angle from upright.
fn exact_angle(windows: f64, duration: f64) -> f64 {
    let c = 9.81 * ((windows + 1.0) / 2.0 + windows) / ((windows + 1.0) / 3.0 + windows);
    let mut pendulum = |_t: f64, y: &[f64; 2], rate: &mut [f64; 2]| *rate = [y[1], c * y[0].sin()];
    Ode45::new().rtol(1e-13).atol(1e-13).integrate(&mut pendulum, (0.0, duration), [0.0, 1.0]).expect("it turns").y[0]
}

/// 81 links and 80 constraints. A debug build has time for the first fold only: release builds take all of 10 s.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn forty_windows_fold_and_open_again() {
    let duration = if cfg!(debug_assertions) { 0.7 } else { 10.0 };
    let windows = generic("n_fourbar_40");
    let dof = windows.tree().nv();
    let alternating: Vec<f64> =
        (0..dof).map(|i| if windows.model().links[i].name.starts_with("crank") { -1.0 } else { 1.0 }).collect();
    let mut turn = ClosedLoopSimulation::new(ClosedLoop::new(&windows), ZeroTorque);
    let start = turn.start(&vec![0.0; dof], &alternating).expect("the start is closed");
    let mut gap = 0.0_f64;
    let end = Ode4::new(1e-2)
        .each_step(&mut turn, (0.0, duration), start, |step| {
            let q = step.end().1[..dof].to_vec();
            gap = windows.loop_residual(&q).iter().fold(gap, |gap: f64, residual: &f64| gap.max(residual.abs()));
        })
        .expect("it passes the folded positions");
    let angle = exact_angle(40.0, duration);
    let error = (-end.y[0].sin() - angle.sin()).hypot(end.y[0].cos() - angle.cos());
    println!("error of the tip {error:.1e} m, gap {gap:.1e} m");
    assert!(error <= 1e-3, "{error:e} m");
    // Forty metres from the base, ten units in the last place are 7e-14 m.
    assert!(gap <= 1e-12, "{gap:e} m");
}

#[test]
fn the_exact_motion_of_the_windows_is_the_published_one() {
    let angle = exact_angle(40.0, 10.0);
    assert!((angle.sin() - TIP_AT_10[0]).hypot(angle.cos() - TIP_AT_10[1]) < 1e-9);
}

#[test]
fn errors_name_the_loop_and_the_joint() {
    let loops = ClosedLoop::new(&Andrews);
    let mut open = andrews::START;
    open[2] += 0.01;
    let error = ClosedLoopSimulation::new(loops, ZeroTorque).start(&open, &[0.0; 7]).expect_err("an open start");
    let told = loops.with_names(error).to_string();
    assert!(told.contains(" m; close it with `assemble`"), "{told}");
    assert!(told.contains(&format!("belongs to the loop `{}`", Andrews::LOOP_NAMES[0])), "{told}");
    let error = loops.assemble(&andrews::START, &[0.0; 7], &[9]).expect_err("there are seven");
    assert!(loops.with_names(error).to_string().ends_with("are counted from 0"));
    let lost = redysim::LoopError::Unactuated { velocity: 1, force: 2.0 };
    assert!(loops.with_names(lost).to_string().ends_with(&format!("that of the joint `{}`", Andrews::JOINT_NAMES[1])));
}

#[test]
fn the_other_linkages_keep_their_energy_and_stay_closed() {
    let starts: [(&str, Vec<f64>); 3] = [
        ("slider_crank", vec![-core::f64::consts::FRAC_PI_2, core::f64::consts::TAU, 2.0]),
        ("three_rrr", vec![1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869]),
        ("leg", vec![0.0, 4.511, -2.7389, -0.8764, -1.4604, -1.4604, -1.6812]),
    ];
    for (name, guess) in starts {
        let mechanism = generic(name);
        let loops = ClosedLoop::new(&mechanism);
        let dof = guess.len();
        let assembly = loops.assemble(&guess, &vec![0.0; dof], &[]).expect("it closes");
        assert!(assembly.largest_displacement < 0.05, "{name} moved by {} rad", assembly.largest_displacement);
        let before = mechanism.energy(&assembly.q, &assembly.v).total();
        let mut fall = ClosedLoopSimulation::new(loops, ZeroTorque);
        let start = fall.assembled(&assembly);
        let end = Ode45::new().rtol(1e-9).atol(1e-9).integrate(&mut fall, (0.0, 0.2), start).expect("it falls");
        let state = fall.split(&end.y);
        let drift = (mechanism.energy(&state.q, &state.v).total() - before).abs();
        let gap =
            mechanism.loop_residual(&state.q).iter().fold(0.0, |gap: f64, residual: &f64| gap.max(residual.abs()));
        let moved =
            state.q.iter().zip(&assembly.q).fold(0.0, |most: f64, (to, from)| Real::maximum(most, (to - from).abs()));
        println!("{name}: energy off by {drift:.1e} J, open by {gap:.1e} m, moved by {moved:.1} rad");
        assert!(drift < 1e-7 && gap < 1e-13 && moved > 0.01, "{name}: {drift:e} J, {gap:e} m, {moved} rad");
    }
}
