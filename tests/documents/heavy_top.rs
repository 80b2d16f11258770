//! The table of `docs/floating_and_walking.md` about the heavy top, with a quaternion and with Euler angles past their gimbal.
#![cfg(all(feature = "generic", feature = "deterministic"))]

use std::fmt::Write;

use crate::scenes::heavy_top::{Run, SPIN, run};
use nalgebra::Vector3;
use redysim::{Dop853, Gauss6, IntegrationError, Integrator, Ode4};
use redysim_model::joint::EulerSequence;

const ZXY: Option<EulerSequence> = Some(EulerSequence::Zxy);

/// When a run ends that does not arrive, and why.
fn cut_short(error: &IntegrationError<f64>) -> String {
    match error {
        IntegrationError::NonFiniteDerivative { t, .. } => format!("not a number at {t:.4} s"),
        IntegrationError::NotConverged { t, .. } => format!("does not converge at {t:.4} s"),
        IntegrationError::StepTooSmall { t, .. } => format!("no step is small enough at {t:.4} s"),
        other => panic!("{other}"),
    }
}

/// The row of a method, from the given angular velocity on.
fn row(name: &str, coordinates: Option<EulerSequence>, spin: Vector3<f64>, method: &impl Integrator<f64>) -> String {
    let Run { end, drift, gimbal } = run(coordinates, spin, method);
    let mut text = format!("| {name} | ");
    match coordinates {
        None => write!(text, "quaternion | "),
        Some(_) => write!(text, "angles | {gimbal:.0e} "),
    }
    .expect("a String takes everything");
    let drift = if drift > 1.0 { "> 1".to_owned() } else { format!("{drift:.0e}") };
    let end = match end {
        Ok(end) => format!("{} | {} | {drift} | arrives |", end.statistics.steps, end.statistics.rejected),
        Err(error) => format!("| | {drift} | {} |", cut_short(&error)),
    };
    text + "| " + &end
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_table_of_the_heavy_top_is_what_the_methods_take() {
    let (adaptive, fixed, implicit) = (Dop853::new().rtol(1e-10).atol(1e-10), Ode4::new(1e-4), Gauss6::new(1e-4));
    let mut rows = Vec::new();
    for coordinates in [None, ZXY] {
        rows.push(row("`Ode4`, steps of 0.1 ms", coordinates, SPIN, &fixed));
        rows.push(row("`Gauss6`, steps of 0.1 ms", coordinates, SPIN, &implicit));
        rows.push(row("`Dop853` at 10⁻¹⁰", coordinates, SPIN, &adaptive));
        let exact = Vector3::new(0.0, 150.0, -60.0 / 13.0);
        rows.push(row("`Dop853` at 10⁻¹⁰, from −60/13 rad/s", coordinates, exact, &adaptive));
    }
    let table = rows.join("\n") + "\n";
    let document = include_str!("../../docs/floating_and_walking.md");
    assert!(document.contains(&table), "docs/floating_and_walking.md should have the rows\n{table}");
}
