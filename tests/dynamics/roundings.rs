//! In `f64` and in `f32`, the functions are right to a few roundings.
//!
//! A sum of terms t is right to about u Σ|t|, where u is half the distance from 1 to the next number, and cancellation
//! can make the sum far smaller than its terms. So a value is held against the largest that its terms become over the
//! run: a joint force against the largest of its joint, an element of the mass matrix against √(M_ii M_jj) with their
//! largest values, an energy against the largest energy. Along a chain of six joints some sixty operations follow one
//! another; their errors add up like a random walk, √60 u, and 16 u is allowed.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::double_double::DoubleDouble;
use crate::common::models::generic;
use crate::common::random::Random;
use crate::robots::{Gantry, Gripper, Kr5};
use redysim::Real;
use redysim::{Scalar, TreeDynamics};

const STATES: usize = 1000;
const ALLOWED: f64 = 16.0;

/// A scalar, and how it rounds.
trait Rounding: Scalar {
    const UNIT: f64;
    fn rounded(self) -> f64;
}

impl Rounding for f32 {
    const UNIT: f64 = 0.5 * f32::EPSILON as f64;
    fn rounded(self) -> f64 {
        self.into()
    }
}

impl Rounding for f64 {
    const UNIT: f64 = 0.5 * f64::EPSILON;
    fn rounded(self) -> f64 {
        self
    }
}

impl Rounding for DoubleDouble {
    const UNIT: f64 = 0.0;
    fn rounded(self) -> f64 {
        self.to_f64()
    }
}

fn rounded<S: Rounding>(values: Vec<S>) -> Vec<f64> {
    values.into_iter().map(S::rounded).collect()
}

/// What is computed at one state: joint forces, bias, gravity, mass matrix, energies, and accelerations for the forces.
struct Values {
    forces: [Vec<f64>; 3],
    matrix: Vec<f64>,
    energies: Vec<f64>,
    accelerations: Vec<f64>,
}

fn values<S: Rounding>(m: &impl TreeDynamics<S>, q: &[f64], v: &[f64], a: &[f64], tau: &[f64]) -> Values {
    let [q, v, a, tau] = [q, v, a, tau].map(constants);
    let energy = energy(m, &q, &v);
    Values {
        forces: [inverse_dynamics(m, &q, &v, &a), bias_forces(m, &q, &v), gravity_forces(m, &q)].map(rounded),
        matrix: rounded(mass_matrix(m, &q).concat()),
        energies: rounded(vec![energy.kinetic, energy.potential]),
        accelerations: rounded(forward_dynamics(m, &q, &v, &tau)),
    }
}

/// The largest difference over a run, in units of u.
fn worst(what: &str, unit: f64, differences: impl Iterator<Item = (f64, f64, f64)>) {
    let mut worst = 0.0_f64;
    for (low, high, scale) in differences {
        let error = if low == high { 0.0 } else { (low - high).abs() / scale / unit };
        assert!(error <= ALLOWED, "{what}: {low:e}, not {high:e}: {error:.1} u for terms like {scale:e}");
        worst = Real::maximum(worst, error);
    }
    println!("{what}: {worst:.1} u, allowed {ALLOWED} u");
}

/// Compares the scalars `Low` and `High` at random states that both can represent.
fn assert_few_roundings<Low: Rounding, High: Rounding>(
    what: &str,
    m: &(impl TreeDynamics<Low> + TreeDynamics<High> + TreeDynamics<f64>),
) {
    let dof = redysim::Mechanism::nv(m);
    let mut random = Random::new(2);
    let mut vector = |bound| -> Vec<f64> { random.vector(dof, bound).iter().map(|&x| f64::from(x as f32)).collect() };
    let runs: Vec<(Values, Values)> = (0..STATES)
        .map(|_| {
            let (q, v, a) = (vector(3.0), vector(3.0), vector(10.0));
            let tau = inverse_dynamics(m, &q, &v, &a).iter().map(|&x| f64::from(x as f32)).collect::<Vec<_>>();
            (values::<Low>(m, &q, &v, &a, &tau), values::<High>(m, &q, &v, &a, &tau))
        })
        .collect();
    for (function, name) in ["inverse", "bias", "gravity"].iter().enumerate() {
        let largest = |joint: usize| {
            let forces = runs.iter().map(|(_, high)| high.forces[0][joint].abs());
            forces.fold(0.0, Real::maximum)
        };
        let samples = (0..dof).map(|joint| (joint, largest(joint))).flat_map(|(joint, scale)| {
            let pair = move |(low, high): &(Values, Values)| {
                (low.forces[function][joint], high.forces[function][joint], scale)
            };
            runs.iter().map(pair)
        });
        worst(&format!("{what} {name}"), Low::UNIT, samples);
    }
    let diagonal = |i: usize| runs.iter().map(|(_, high)| high.matrix[i * dof + i]).fold(0.0, Real::maximum);
    let diagonal: Vec<f64> = (0..dof).map(diagonal).collect();
    let elements = runs.iter().flat_map(|(low, high)| {
        let scale = |k: usize| (diagonal[k / dof] * diagonal[k % dof]).sqrt();
        (0..dof * dof).map(move |k| (low.matrix[k], high.matrix[k], scale(k)))
    });
    worst(&format!("{what} matrix"), Low::UNIT, elements);
    for (energy, name) in ["kinetic", "potential"].iter().enumerate() {
        let scale = runs.iter().fold(0.0_f64, |largest, (_, high)| Real::maximum(largest, high.energies[energy].abs()));
        let samples = runs.iter().map(|(low, high)| (low.energies[energy], high.energies[energy], scale));
        worst(&format!("{what} {name}"), Low::UNIT, samples);
    }
    assert_accelerations_need_the_forces::<Low>(what, &runs);
}

/// Accelerations may be off by the condition of M times a rounding, but so that they need the forces that were given to
/// within roundings of M and of the bias: with joints scaled so that M has a unit diagonal, M (a_low − a_high) is at
/// most k u (‖a‖₁ + ‖h‖₁).
fn assert_accelerations_need_the_forces<Low: Rounding>(what: &str, runs: &[(Values, Values)]) {
    let residuals = runs.iter().map(|(low, high)| {
        let dof = high.accelerations.len();
        let scale = |i: usize| high.matrix[i * dof + i].sqrt();
        let terms = |i: usize| scale(i) * high.accelerations[i].abs() + high.forces[1][i].abs() / scale(i);
        let residual = |i: usize| {
            let off = |j: usize| high.matrix[i * dof + j] * (low.accelerations[j] - high.accelerations[j]);
            (0..dof).map(off).sum::<f64>().abs() / scale(i)
        };
        (0.0, (0..dof).map(residual).sum(), (0..dof).map(terms).sum())
    });
    worst(&format!("{what} forward"), Low::UNIT, residuals);
}

#[test]
fn compiled_code_in_double_precision_is_right_to_a_few_roundings() {
    assert_few_roundings::<f64, DoubleDouble>("kr5 f64", &Kr5);
    assert_few_roundings::<f64, DoubleDouble>("gripper f64", &Gripper);
    assert_few_roundings::<f64, DoubleDouble>("gantry f64", &Gantry);
}

#[test]
fn the_generic_path_in_double_precision_is_right_to_a_few_roundings() {
    assert_few_roundings::<f64, DoubleDouble>("generic kr5 f64", &generic("kr5"));
    assert_few_roundings::<f64, DoubleDouble>("generic gripper f64", &generic("gripper"));
    assert_few_roundings::<f64, DoubleDouble>("generic gantry f64", &generic("test/gantry"));
}

#[test]
fn compiled_code_in_single_precision_is_right_to_a_few_roundings() {
    assert_few_roundings::<f32, f64>("kr5 f32", &Kr5);
    assert_few_roundings::<f32, f64>("gripper f32", &Gripper);
    assert_few_roundings::<f32, f64>("gantry f32", &Gantry);
}
