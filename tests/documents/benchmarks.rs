//! The errors that `docs/accuracy.md` and the README state of the problems A01 and A02 of the IFToMM benchmark library
//! are those of the runs.
//!
//! Most are errors of truncation: they are the same in all digits that the tables have.
#![cfg(feature = "generic")]

use std::f64::consts::FRAC_PI_2;

use crate::documented::{assert_bounds, rows, stated, table};
use rayon::prelude::*;
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    ClosedLoop, ClosedLoopSimulation, Dop853, ForwardSimulation, Gauss6, Integrator, LoopClosure, Ode4, Ode45,
    TreeDynamics, Vector, ZeroTorque, redysim,
};

redysim! { struct SimplePendulum("models/simple_pendulum.toml"); }
redysim! { struct Windows("models/n_fourbar_2.toml"); }

/// How far the tip of the pendulum, let go from the horizontal, is from the exact one after `duration`, m.
fn error_of_pendulum(duration: f64, method: &impl Integrator<f64>) -> f64 {
    // After 2,000 s, by Jacobi's elliptic functions.
    const END: [f64; 2] = [-0.814_603_068_589_032_2, -0.580_018_827_836_935_5];
    let mut simulation = ForwardSimulation::new(&SimplePendulum, ZeroTorque);
    let start = simulation.state(&[FRAC_PI_2], &[0.0]);
    let end = method.integrate(&mut simulation, (0.0, duration), start).expect("it swings").y;
    (end[0].sin() - END[0]).hypot(-end[0].cos() - END[1])
}

/// How far the first tip of the windows, which start upright with their tips at 1 m/s, is from the exact one after
/// `duration`, m.
fn error_of_windows<M>(mechanism: &M, duration: f64, method: &impl Integrator<f64>) -> f64
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
{
    let windows = (mechanism.nv() / 2) as f64;
    let reference = rows(include_str!("../reference/exact_n_fourbar.csv"));
    let exact = reference.iter().find(|row| row[..2] == [windows, duration]).expect("an exact tip");
    let mut turn = ClosedLoopSimulation::new(ClosedLoop::new(mechanism), ZeroTorque);
    let q = M::Coordinates::from_fn(mechanism.nq(), |_| 0.0);
    let v = M::Velocities::from_fn(mechanism.nv(), |joint| if joint.is_multiple_of(2) { -1.0 } else { 1.0 });
    let start = turn.start(&q, &v).expect("a closed start");
    let end = method.integrate(&mut turn, (0.0, duration), start).expect("it passes").y;
    let angle = end.as_ref()[0];
    (-angle.sin() - exact[2]).hypot(angle.cos() - exact[3])
}

/// The quantity in a cell such as `0.24 mm`, in units of which these are the sizes.
fn quantity(cell: &str, units: &[(&str, f64)]) -> f64 {
    let (number, unit) = cell.split_once(' ').expect("a number and its unit");
    let (_, unit) = units.iter().find(|(name, _)| *name == unit).expect("a unit of the table");
    number.parse::<f64>().expect("a number") * unit
}

/// A length such as `0.24 mm`, m.
fn length(cell: &str) -> f64 {
    quantity(cell, &[("mm", 1e-3), ("µm", 1e-6), ("nm", 1e-9), ("pm", 1e-12)])
}

/// A time such as `3.8 ms`, ms.
fn milliseconds(cell: &str) -> f64 {
    quantity(cell, &[("ms", 1.0), ("s", 1e3)])
}

#[test]
fn the_errors_of_the_benchmarks_are_those_that_the_table_states() {
    let mut problem = String::new();
    let mut runs = Vec::new();
    for row in table("docs/accuracy.md", "| problem | method | span | error | time |") {
        let [title, method, span, stated, time] = row.as_slice() else { panic!("{row:?}") };
        if !title.is_empty() {
            problem.clone_from(title);
        }
        // Unoptimised, a run takes some fifty times as long.
        if cfg!(debug_assertions) && milliseconds(time) > 25.0 {
            continue;
        }
        runs.push([&problem, method, span, stated].map(String::clone));
    }
    runs.par_iter().for_each(|[problem, method, span, stated]| {
        let span = span.trim_end_matches(" s").replace(',', "").parse().expect("seconds");
        let measured = match (problem.as_str(), method.as_str()) {
            ("A01, simple pendulum", "`Ode4`, 10 ms") => error_of_pendulum(span, &Ode4::new(1e-2)),
            ("A01, simple pendulum", "`Ode45`, rtol 1e-8, atol 1e-10") => {
                error_of_pendulum(span, &Ode45::new().rtol(1e-8).atol(1e-10))
            }
            ("A01, simple pendulum", "`Dop853`, rtol 1e-8, atol 1e-10") => {
                error_of_pendulum(span, &Dop853::new().rtol(1e-8).atol(1e-10))
            }
            ("A01, simple pendulum", "`Dop853`, rtol 1e-12, atol 1e-14") => {
                error_of_pendulum(span, &Dop853::new().rtol(1e-12).atol(1e-14))
            }
            ("A01, simple pendulum", "`Gauss6`, 20 ms") => error_of_pendulum(span, &Gauss6::new(2e-2)),
            ("A02, two windows", "`Ode4`, 10 ms") => error_of_windows(&Windows, span, &Ode4::new(1e-2)),
            ("A02, two windows", "`Ode4`, 1 ms") => error_of_windows(&Windows, span, &Ode4::new(1e-3)),
            ("A02, two windows", "`Ode45`, rtol 1e-6, atol 1e-8") => {
                error_of_windows(&Windows, span, &Ode45::new().rtol(1e-6).atol(1e-8))
            }
            ("A02, forty windows (generic path)", "`Ode4`, 10 ms") => {
                let path = format!("{}/models/n_fourbar_40.toml", env!("CARGO_MANIFEST_DIR"));
                let forty = GenericMechanism::new(Model::load(path).expect("a good model").model);
                error_of_windows(&forty, span, &Ode4::new(1e-2))
            }
            other => panic!("no run for the row {other:?}"),
        };
        println!("{problem}, {method}: {measured:.3e} m");
        let stated = length(stated);
        assert!((measured - stated).abs() <= 0.05 * stated, "{problem}, {method}: {measured:e} m, not {stated:e} m");
    });
}

#[test]
fn the_windows_fold_as_exactly_as_the_readme_states() {
    const HEAD: &str = "two windows folding flat for 10 s, steps of 10 ms to 0.1 ms";
    let error = |step: f64| error_of_windows(&Windows, 10.0, &Ode4::new(step));
    // 100,000 steps take half a minute in debug builds.
    let fine = if cfg!(debug_assertions) { stated(HEAD)[1] } else { error(1e-4) };
    assert_bounds(HEAD, &stated(HEAD), &[error(1e-2), fine]);
}

/// Three million steps, so only in optimised builds.
#[cfg(not(debug_assertions))]
#[test]
fn small_steps_pass_singular_positions_as_the_readme_states() {
    let sizes = (0..200).map(|k| 10.0 / f64::from(10_000 + 50 * k));
    let mut errors: Vec<f64> = sizes.map(|step| error_of_windows(&Windows, 10.0, &Ode4::new(step))).collect();
    errors.sort_by(f64::total_cmp);
    let readme = crate::documented::read("README.md").split_whitespace().collect::<Vec<_>>().join(" ");
    let sentence = readme.split_once("of 200 sizes of step from 0.5 to 1 ms, ").expect("a sentence of the README").1;
    let stated = crate::documented::numbers(sentence.split_once(". ").map_or(sentence, |(sentence, _)| sentence));
    assert_bounds("steps of 0.5 to 1 ms, the worst and the median", &stated, &[errors[199], errors[100]]);
}
