//! The figures of the README are those of the runs that they tell of.
//!
//! Errors of rounding size depend on the last bits of the arithmetic, which is another where multiply-add is fused. The
//! README states bounds of them with one digit; a bound ten times what is measured is called stale.
#![cfg(feature = "generic")]

use redysim::Real;
use std::f64::consts::{FRAC_PI_3, TAU};

use crate::common::andrews;
use crate::documented::{assert_bounds, cells, read, rows, stated};
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    Assembly, ClosedLoop, ClosedLoopInverse, ClosedLoopSimulation, Cycloid, ForwardSimulation, Integrator, Motion,
    Ode4, Ode45, OperationCount, Trajectory, ZeroTorque, redysim,
};
use redysim_codegen::functions::trace_model;
use redysim_codegen::passes::Passes;
use redysim_model::{CodegenOptions, Functions, Inertia};

redysim! { pub struct Kr5("models/kr5.toml"); }
redysim! { struct Fourbar("models/fourbar.toml"); }
redysim! { struct ThreeRrr("models/three_rrr.toml"); }
redysim! { struct Andrews("models/andrews.toml"); }

/// Fails unless each bound in a row of the README holds and is not stale.
fn assert_row(head: &str, measured: &[f64]) {
    assert_bounds(head, &stated(head), measured);
}

/// The largest difference; NaN counts as infinite.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |most, size| if size <= most { most } else { size })
}

/// Largest errors of each component, as a share of its largest value.
fn shares(pairs: &[(Vec<f64>, Vec<f64>)]) -> f64 {
    let of = |component: usize| {
        let error = pairs.iter().map(|(a, b)| (a[component] - b[component]).abs()).fold(0.0, Real::maximum);
        error / pairs.iter().map(|(_, b)| b[component].abs()).fold(0.0, Real::maximum)
    };
    (0..pairs[0].0.len()).map(of).fold(0.0, Real::maximum)
}

#[test]
fn the_joint_forces_of_the_kr5_deviate_as_the_readme_states() {
    let turn = Cycloid::new([0.0; 6], [FRAC_PI_3; 6], 1.0).expect("a motion");
    let reference = rows(include_str!("../reference/golden_octave_ID_KUKA_Robot.csv"));
    let forces = |row: &Vec<f64>| {
        let Motion { q, v, a } = turn.at(row[0]);
        (Kr5::inverse_dynamics(&q, &v, &a).to_vec(), row[19..25].to_vec())
    };
    let pairs: Vec<_> = reference.iter().map(forces).collect();
    assert_row(&format!("joint forces, {} instants of ReDySim's own run", pairs.len()), &[shares(&pairs)]);
}

#[test]
fn the_free_fall_of_the_kr5_deviates_as_the_readme_states() {
    let reference = rows(include_str!("../reference/golden_ref_kuka.csv"));
    let reference: Vec<_> = reference.into_iter().filter(|row| row[0] <= 1.0).collect();
    let mut fall = ForwardSimulation::new(&Kr5, ZeroTorque);
    let copy = ForwardSimulation::new(&Kr5, ZeroTorque);
    let start = fall.state(&[0.0; 6], &[0.0; 6]);
    let at_rest = Kr5::energy(&[0.0; 6], &[0.0; 6]).total();
    let (mut angle, mut drift, mut row) = (0.0_f64, 0.0_f64, 0);
    let method = Ode45::new().rtol(3e-14).atol(1e-15);
    // Energies at every instant that the example looks at.
    let times = (0..=1000).map(|k| f64::from(k) / 1000.0);
    let solved = method.solve(&mut fall, (0.0, 1.0), start, times, |t, state| {
        let now = copy.split(state);
        drift = drift.max((Kr5::energy(&now.q, &now.v).total() - at_rest).abs());
        if reference.get(row).is_some_and(|row| (row[0] - t).abs() < 1e-9) {
            angle = angle.max(difference(&now.q, &reference[row][1..7]));
            row += 1;
        }
    });
    solved.expect("it falls");
    assert_row(&format!("free fall for 1 s, {row} instants in quad precision"), &[angle]);
    assert_row("energy in that fall", &[drift]);
}

#[test]
fn the_operations_of_the_kr5_are_those_that_the_readme_states() {
    for (name, count) in [
        ("inverse dynamics", Kr5::OPS.inverse_dynamics),
        ("forward dynamics", Kr5::OPS.forward_dynamics),
        ("mass matrix", Kr5::OPS.mass_matrix),
    ] {
        let OperationCount { trig, .. } = count;
        assert_eq!(cells("README.md", name)[..2], [count.flops().to_string(), trig.to_string()], "{name}");
    }
}

/// Those of the KR5 are in `tests/code_generation/tolerance.rs`, which compiles them.
#[test]
fn the_operations_of_the_puma_within_tolerances_are_those_that_the_readme_states() {
    let model = Model::load(format!("{}/models/test/puma560.toml", env!("CARGO_MANIFEST_DIR"))).expect("a model").model;
    let functions = Functions::named(["inverse_dynamics", "bias_forces"]).expect("functions");
    // To find what may be left out takes seconds in debug builds; the first column behind the exact one takes the
    // least.
    let exponents = if cfg!(debug_assertions) { 4..=4 } else { 1..=4 };
    for exponent in exponents {
        let options =
            CodegenOptions { functions, tolerance: Some(10_f64.powi(-exponent)), ..CodegenOptions::default() };
        let traced = trace_model(&model, &options, &Passes::all()).expect("functions");
        for (name, title) in [("inverse_dynamics", "inverse dynamics"), ("bias_forces", "bias forces")] {
            let function = traced.iter().find(|function| function.function.name() == name).expect("asked for");
            let counts = [function.pruning.expect("pruned").before.flops(), function.expressions.count().flops()];
            let text = read("README.md");
            let table = text.split_once("PUMA 560").expect("its table").1;
            let row = table.lines().find_map(|line| line.strip_prefix(&format!("| {title} | "))).expect("a row");
            let stated: Vec<u32> =
                row.trim_end_matches(" |").split(" | ").map(|n| n.parse().expect("a count")).collect();
            assert_eq!([stated[0], stated[5 - exponent as usize]], counts, "{title} to 1e-{exponent}");
        }
    }
}

#[test]
fn the_forces_of_closed_loops_deviate_as_the_readme_states() {
    const SPEED: f64 = 0.75 * TAU;
    let crank = |t: f64| Motion { q: [SPEED * t], v: [SPEED], a: [0.0] };
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&Fourbar), &[0], [0.0, 0.9844, 4.3144]);
    let reference = rows(include_str!("../reference/golden_octave_ID_Hoken_Fourbar.csv"));
    let mut four = Vec::new();
    // The position of an instant is found from the one before it, 1 ms earlier as in `examples/fourbar.rs`.
    for t in (0..=1333).map(|k| f64::from(k) / 1000.0).chain([1.3333]) {
        let found = inverse.at(t, &crank).expect("the crank turns freely");
        if let Some(row) = reference.iter().find(|row| (row[0] - t).abs() < 1e-9) {
            let forces = vec![found.forces[0], found.multipliers[0], found.multipliers[1]];
            four.push((forces, row[10..13].to_vec()));
        }
    }
    assert_eq!(four.len(), reference.len());
    let legs = rows(include_str!("../reference/golden_octave_ID_3-RRR_Parallel_robot.csv"));
    let guess: [f64; 7] = core::array::from_fn(|i| legs[0][1 + i]);
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&ThreeRrr), &[0, 3, 5], guess);
    let of_legs = |row: &Vec<f64>| {
        let pick = |from: usize| [row[from], row[from + 3], row[from + 5]];
        let prescribed = |_: f64| Motion { q: pick(1), v: pick(8), a: pick(15) };
        let found = inverse.at(row[0], &prescribed).expect("it closes");
        let torques = [0, 3, 5].map(|i| found.forces[i]);
        ([&torques[..], &found.multipliers[..]].concat(), row[22..29].to_vec())
    };
    let legs: Vec<_> = legs.iter().map(of_legs).collect();
    assert_row("four-bar and 3-RRR inverse dynamics, against ReDySim's own", &[shares(&four), shares(&legs)]);
}

/// The angles that ship with ReDySim, closed with the crank held, as in `examples/fourbar.rs`.
fn closed_at_rest() -> Assembly<f64, [f64; 3], [f64; 3]> {
    ClosedLoop::new(&Fourbar).assemble(&[0.0, 0.9844, 4.3144], &[0.0; 3], &[0]).expect("it closes")
}

#[test]
fn the_four_bar_falls_as_closely_as_the_readme_states() {
    let reference = rows(include_str!("../reference/golden_ref_hoken_rest_consistent.csv"));
    let reference: Vec<_> = reference.into_iter().filter(|row| row[0] <= 0.68 + 1e-9).collect();
    let mut fall = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque);
    let mut copy = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque);
    let start = fall.assembled(&closed_at_rest());
    let (mut angle, mut lambda) = (0.0_f64, 0.0_f64);
    let mut expected = reference.iter();
    let times = reference.iter().map(|row| row[0]);
    let solved = Ode45::new().rtol(3e-14).atol(1e-15).solve(&mut fall, (0.0, 0.68), start, times, |t, state| {
        let row = expected.next().expect("a row for every time");
        angle = angle.max(difference(&copy.split(state).q, &row[1..4]));
        let motion = copy.motion(t, state).expect("a regular position");
        lambda = lambda.max(difference(&motion.multipliers, &row[10..12]));
    });
    solved.expect("it falls");
    assert_row("four-bar in free fall for 0.68 s, against quad precision", &[angle, lambda]);
}

#[test]
fn the_four_bar_drifts_as_little_as_the_readme_states() {
    // 10 s in optimised builds; 1 s in debug builds, which are slower: the energy changes less in it.
    let end = if cfg!(debug_assertions) { 1.0 } else { 10.0 };
    let mut fall = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque);
    let copy = ClosedLoopSimulation::<f64, _, _>::new(ClosedLoop::new(&Fourbar), ZeroTorque);
    let closed = closed_at_rest();
    let start = fall.assembled(&closed);
    let energy = Fourbar::energy(&closed.q, &closed.v).total();
    let (mut gap, mut change) = (0.0_f64, 0.0_f64);
    let fallen = Ode4::new(1e-4).each_step(&mut fall, (0.0, end), start, |step| {
        let now = copy.split(step.end().1);
        gap = gap.max(difference(&Fourbar::loop_residual(&now.q), &[0.0; 2]));
        change = change.max((Fourbar::energy(&now.q, &now.v).total() - energy).abs());
    });
    fallen.expect("it falls");
    const HEAD: &str = "four-bar for 10 s in steps of 0.1 ms";
    let change = if cfg!(debug_assertions) { change.max(0.1 * stated(HEAD)[1]) } else { change };
    assert_row(HEAD, &[gap, change]);
}

#[test]
fn andrews_mechanism_has_the_digits_that_the_readme_states() {
    let law = |_t: f64, _q: &[f64; 7], _v: &[f64; 7]| andrews::TORQUES;
    let mut squeezing = ClosedLoopSimulation::new(ClosedLoop::new(&Andrews), law);
    let start = squeezing.start(&andrews::START, &[0.0; 7]).expect("the published start closes");
    let end = Ode45::new().rtol(1e-12).atol(1e-12).integrate(&mut squeezing, (0.0, 0.03), start).expect("it ends").y;
    let digits = |i: usize| -((end[i] - andrews::END[i]) / andrews::END[i]).abs().max(1e-16).log10();
    let fewest = (0..7).map(digits).fold(f64::INFINITY, f64::min);
    // The published positions are rounded, so that what is missing is theirs.
    assert_eq!(stated("Andrews' squeezing mechanism at 0.03 s"), [(10.0 * fewest).round() / 10.0]);
}

/// Two four-bars that share nothing, the masses of one 10^`-exponent` of the other's.
#[test]
fn the_loops_beside_one_of_far_lighter_links_are_lost_where_the_readme_states() {
    let rank = |exponent: i32| {
        let mut model =
            Model::load(format!("{}/models/fourbar.toml", env!("CARGO_MANIFEST_DIR"))).expect("a model").model;
        let (share, count) = (10_f64.powi(-exponent), model.links.len());
        for mut link in model.links.clone() {
            let Inertia { xx, yy, zz, .. } = link.inertia;
            link.inertia = Inertia { xx: share * xx, yy: share * yy, zz: share * zz, ..Inertia::default() };
            link.mass *= share;
            link.parent = link.parent.map(|parent| parent + count);
            model.links.push(link);
        }
        let mut cut = model.loops[0].clone();
        for side in [&mut cut.a, &mut cut.b] {
            side.link = side.link.map(|link| link + count);
        }
        model.loops.push(cut);
        let pair = GenericMechanism::new(model);
        let loops = ClosedLoop::new(&pair);
        let closed = loops.assemble(&[0.0, 0.9844, 4.3144].repeat(2), &vec![0.0; 6], &[0, 3]).expect("it closes");
        loops.dynamics(&closed.q, &closed.v, &vec![0.0; 6]).expect("a solution").rank
    };
    let readme = read("README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(readme.contains("beside a loop of links some ten orders of magnitude lighter, the loops of the others"));
    // Of ranks 2 and 2, only the light one's remains.
    assert_eq!((rank(9), rank(11)), (4, 2));
}

/// `peers/urdf/run` has written the table.
#[test]
fn the_readme_counts_the_published_robots_as_their_table_has_them() {
    let table = read("peers/urdf/robots.md");
    let is_row = |line: &&str| line.starts_with('|');
    let rows = table.lines().skip_while(|line| !is_row(line)).take_while(is_row).skip(2);
    let robots: Vec<Vec<&str>> = rows.map(|line| line.split('|').map(str::trim).collect()).collect();
    // Inverse dynamics of the model as it is imported, and all functions compiled.
    let [imported, compiled] = [3, 9].map(|column| robots.iter().filter(|row| !row[column].is_empty()).count());
    assert_eq!(imported, compiled);
    let readme = read("README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    for sentence in [
        format!("Of {} published robots, {compiled} are imported, compile and agree with Pinocchio", robots.len()),
        format!("The other {} are refused, and the reason is reported", robots.len() - compiled),
    ] {
        assert!(readme.contains(&sentence), "README.md lacks: {sentence}");
    }
}
