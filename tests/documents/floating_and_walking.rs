//! The tables of `docs/accuracy.md` about a robot on a free base and one that walks, and the judges behind them.
#![cfg(all(feature = "generic", feature = "deterministic"))]

use std::fmt::Write;

use crate::common::methods::{WithMethod, every_adaptive, every_fixed};
use crate::scenes::extrapolation::extrapolated;
use crate::scenes::floating::{DURATION, PastGimbal, START, State, after, apart, arm, drifts, in_angles};
use crate::scenes::trot::{self, HARD, SOFT, stride};
use redysim::{
    AnyContactLaw, Dop853, ForwardSimulation, IntegrationError, Integrator, MechanicalEnergy, Radau5, Solution, Vector,
    ZeroTorque,
};
use redysim_codegen::accuracy::double_double::{DoubleDouble, exact, rounded};

/// What a run took, a Jacobian as one evaluation for each component of the state, and its errors; or that it failed.
fn cells<Y: Vector<f64>>(
    found: Result<Solution<f64, Y>, IntegrationError<f64>>,
    errors: impl Fn(&Y) -> Vec<f64>,
    count: usize,
) -> String {
    match found {
        Ok(Solution { y, statistics, .. }) => {
            let evaluations = statistics.evaluations + y.as_ref().len() as u64 * statistics.jacobians;
            let shown = |&error: &f64| if error < 1e-15 { "roundings".to_owned() } else { format!("{error:.0e}") };
            errors(&y).iter().map(shown).fold(format!("{evaluations}"), |text, error| text + " | " + &error)
        }
        Err(_) => format!("fails{}", " |".repeat(count)),
    }
}

fn assert_documented(table: &str) {
    let document = include_str!("../../docs/accuracy.md");
    assert!(document.contains(table), "docs/accuracy.md should have the rows\n{table}");
}

/// Rows of the floating arm: with a quaternion, and with Euler angles past the gimbal.
struct Floating {
    end: State,
    past: PastGimbal,
    text: String,
}

impl WithMethod for Floating {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let arm = arm();
        let mut simulation = ForwardSimulation::new(&arm, ZeroTorque);
        let (copy, start) = (simulation, simulation.state(&START.0, &START.1));
        let by_quaternion = cells(
            method.integrate(&mut simulation, (0.0, DURATION), start),
            |end| {
                let end = copy.split(end);
                [vec![apart(&end.q, &self.end.0)], drifts(&(end.q, end.v)).to_vec()].concat()
            },
            3,
        );
        let mut simulation = ForwardSimulation::new(&self.past.mechanism, ZeroTorque);
        let (q, v) = &self.past.start;
        let start: Vec<f64> = simulation.state(q, v);
        let found = method.integrate(&mut simulation, (0.0, DURATION), start);
        let by_angles = cells(found, |end| vec![self.past.error(&end[..q.len()])], 1);
        writeln!(self.text, "| {name} | {by_quaternion} | {by_angles} |").expect("a String takes everything");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_table_of_the_floating_arm_is_what_the_methods_take() {
    let (halfway, end) = (after(0.5 * DURATION, &START), after(DURATION, &START));
    let mut rows = Floating { past: PastGimbal::at(1e-3, &halfway, &end), end, text: String::new() };
    every_fixed(DURATION / 1024.0, &mut rows);
    every_adaptive(1e-8, 1e-10, &mut rows);
    assert_documented(&rows.text);
}

/// Rows of the quadruped on one kind of ground.
struct Walking<'t> {
    law: AnyContactLaw<f64>,
    end: trot::State,
    text: &'t mut String,
}

impl WithMethod for Walking<'_> {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let [without, with] = [false, true]
            .map(|events| cells(stride(self.law, method, events, |_| ()), |end| vec![trot::apart(end, &self.end)], 1));
        writeln!(self.text, "| {name} | {without} | {with} |").expect("a String takes everything");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_tables_of_the_walking_quadruped_are_what_the_methods_take() {
    let tables = [SOFT, HARD].map(|law| {
        let end = stride(law, &Dop853::new().rtol(1e-13).atol(1e-15), true, |_| ()).expect("a stride").y;
        // Another method of another order.
        let other = stride(law, &Radau5::new().rtol(1e-10).atol(1e-12), true, |_| ()).expect("a stride").y;
        assert!(trot::apart(&end, &other) < 1e-9);
        let mut text = String::new();
        let mut rows = Walking { law, end, text: &mut text };
        every_fixed(trot::DURATION / 2048.0, &mut rows);
        every_adaptive(1e-6, 1e-8, &mut rows);
        text
    });
    println!("{}\n{}", tables[0], tables[1]);
    tables.iter().for_each(|table| assert_documented(table));
}

/// Four seconds of a harmonic oscillator. Each of forty extrapolations multiplies roundings of 1e-32 by some tens.
#[test]
fn extrapolation_in_double_double_is_right_to_nearly_all_its_digits() {
    let oscillator = |y: &[DoubleDouble]| vec![y[1], -y[0]];
    let end = extrapolated(oscillator, exact(&[0.0, 1.0]), exact(&[4.0])[0], (40, 10));
    let (sin, cos) = redysim::Scalar::sin_cos(exact(&[4.0])[0]);
    let errors = rounded([end[0] - sin, end[1] - cos]);
    assert!(errors.iter().all(|error| error.abs() < 1e-28), "{errors:?}");
}

/// The energy does not depend on coordinates or on the axes of the base.
#[test]
fn the_start_in_angles_is_the_start_with_a_quaternion() {
    let expected = arm().energy(&START.0, &START.1).kinetic;
    for distance in [1.0, 1e-3] {
        let PastGimbal { mechanism, start: (q, v), .. } = PastGimbal::at(distance, &START, &START);
        let found = mechanism.energy(&q, &v).kinetic;
        // Close to the gimbal, rates of 1e3 rad/s nearly cancel.
        assert!((found / expected - 1.0).abs() < 1e-12 / distance, "{found} instead of {expected}");
    }
    let (q, v) = in_angles(&START);
    assert_eq!((q.len(), v.len()), (12, 12));
}
