//! The tables of `docs/accuracy.md` that can be exact are: what each method takes, and what its error is. The bits, and
//! so the steps, are the same on every machine with the feature `deterministic`.
#![cfg(all(feature = "generic", feature = "deterministic"))]

use redysim::Real;
use std::fmt::Write;

use super::figures::Kr5;
use crate::common::methods::{WithMethod, every_adaptive};
use redysim::{Dop853, ForwardSimulation, Integrator, Ode, Pd, Radau5, ZeroTorque};

const DOF: usize = Kr5::NV;
type State = [f64; 2 * DOF + 1];
type Law = Pd<[f64; DOF], [f64; DOF]>;

/// Rows of one scene: a second of motion from zero, judged by the joint angles at its end.
struct Rows<'s, O> {
    ode: &'s mut O,
    rtol: f64,
    exact: State,
    text: String,
}

impl<O: Ode<f64, State>> WithMethod for Rows<'_, O> {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let rtol = self.rtol;
        let Ok(end) = method.integrate(self.ode, (0.0, 1.0), [0.0; 2 * DOF + 1]) else {
            writeln!(self.text, "| {name}, {rtol:.0e} | stiff | | | | |").expect("a String takes everything");
            return;
        };
        let error = (0..DOF).fold(0.0_f64, |worst, i| Real::maximum(worst, (end.y[i] - self.exact[i]).abs()));
        let s = end.statistics;
        writeln!(
            self.text,
            "| {name}, {rtol:.0e} | {} | {} | {} | {} | {error:.0e} |",
            s.steps, s.rejected, s.evaluations, s.jacobians
        )
        .expect("a String takes everything");
    }
}

fn table(ode: &mut impl Ode<f64, State>, judge: &impl Integrator<f64>) -> String {
    let exact = judge.integrate(ode, (0.0, 1.0), [0.0; 2 * DOF + 1]).expect("a motion").y;
    let mut text = String::new();
    for rtol in [1e-3, 1e-6, 1e-10] {
        let mut rows = Rows { ode, rtol, exact, text };
        every_adaptive(rtol, rtol, &mut rows);
        text = rows.text;
    }
    text
}

#[test]
fn the_tables_of_steps_and_errors_are_what_the_methods_take() {
    let document = include_str!("../../docs/accuracy.md");
    let fall = table(&mut ForwardSimulation::new(&Kr5, ZeroTorque), &Dop853::new().rtol(3e-14).atol(1e-15));
    let law: Law = Pd { target: [0.5; DOF], kp: [1e3; DOF], kd: [1e2; DOF] };
    let stiff = table(&mut ForwardSimulation::new(&Kr5, law), &Radau5::new().rtol(3e-14).atol(1e-16));
    for table in [fall, stiff] {
        assert!(document.contains(&table), "docs/accuracy.md should have the rows\n{table}");
    }
}
