//! What holds for every mechanism, whatever its numbers: the identities of dynamics, on both paths.
//!
//! Everything is computed in double-double, so that what is left of an identity is not the roundoff of small
//! differences of large terms (see `roundings.rs` for that) but only that of the constants in the code. Derivatives are
//! taken with dual numbers, without error of their own.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::dual::{Dual, moving};
use crate::common::models::generic;
use crate::common::random::Random;
use crate::robots::{Gantry, Gripper, Kr5};
use nalgebra::DMatrix;
use redysim::{Scalar, TreeDynamics};
use redysim_model::denoc::{self, Method, Untraced};

const STATES: usize = 300;

/// For paths whose functions all compute with the same constants, and whose fixed rotations are quarter turns, hence
/// exact.
const EXACT: f64 = 1e-12;
/// A fixed oblique rotation is orthonormal to u = 1e-16 only, and compiled functions differ in how their constants are
/// lumped, each rounded once more. With such constants the identities hold to u of the largest component, which is up
/// to 1e-10 of the smallest that count (see [`Comparison`]).
const ROUNDED: f64 = 1e-11;

type Number = DoubleDouble;

/// A mechanism that can be differentiated.
trait Smooth: TreeDynamics<Number> + TreeDynamics<Dual<Number>> {}
impl<M: TreeDynamics<Number> + TreeDynamics<Dual<Number>>> Smooth for M {}

struct State {
    q: Vec<Number>,
    v: Vec<Number>,
    a: Vec<Number>,
}

/// Runs a check on every model, compiled and generic.
macro_rules! on_every_mechanism {
    ($check:ident) => {
        $check("compiled kr5", &Kr5, ROUNDED);
        $check("compiled gripper", &Gripper, EXACT);
        $check("compiled gantry", &Gantry, ROUNDED);
        $check("generic kr5", &generic("kr5"), EXACT);
        $check("generic gripper", &generic("gripper"), EXACT);
        $check("generic gantry", &generic("test/gantry"), ROUNDED);
    };
}

fn dof(m: &impl Smooth) -> usize {
    redysim::Mechanism::nv(m)
}

fn states(m: &impl Smooth) -> impl Iterator<Item = State> {
    let dof = dof(m);
    let mut random = Random::new(3);
    (0..STATES).map(move |_| {
        let state = random.state(dof);
        State { q: exact(&state.q), v: exact(&state.v), a: exact(&state.a) }
    })
}

fn rest(m: &impl Smooth) -> Vec<Number> {
    vec![Number::zero(); dof(m)]
}

fn unit(m: &impl Smooth, index: usize) -> Vec<Number> {
    let mut unit = rest(m);
    unit[index] = Number::one();
    unit
}

fn dot(a: &[Number], b: &[Number]) -> Number {
    a.iter().zip(b).fold(Number::zero(), |sum, (&a, &b)| sum + a * b)
}

#[test]
fn accelerations_from_forces_need_those_forces() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut forces = Comparison::new(format!("{name}: ID(FD(τ)) = τ"));
        for State { q, v, a } in states(m) {
            let tau = inverse_dynamics(m, &q, &v, &a);
            let again = inverse_dynamics(m, &q, &v, &forward_dynamics(m, &q, &v, &tau));
            forces.add(&rounded(again), &rounded(tau));
        }
        forces.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn mass_matrix_is_symmetric_and_positive_definite() {
    fn check(name: &str, m: &impl Smooth, _: f64) {
        for State { q, .. } in states(m) {
            let rows = mass_matrix::<Number>(m, &q);
            let matrix = DMatrix::from_fn(rows.len(), rows.len(), |i, j| rows[i][j].to_f64());
            assert_eq!(matrix, matrix.transpose(), "{name} at {q:?}");
            assert!(matrix.cholesky().is_some(), "{name} at {q:?}");
        }
    }
    on_every_mechanism!(check);
}

#[test]
fn columns_of_the_mass_matrix_are_forces_for_unit_accelerations() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut matrices = Comparison::new(format!("{name}: M e = ID(q, 0, e) − ID(q, 0, 0)"));
        for State { q, .. } in states(m) {
            let weight = inverse_dynamics(m, &q, &rest(m), &rest(m));
            let column = |j| {
                let forces = inverse_dynamics(m, &q, &rest(m), &unit(m, j));
                forces.iter().zip(&weight).map(|(&force, &weight)| force - weight).collect::<Vec<Number>>()
            };
            let columns: Vec<Vec<Number>> = (0..dof(m)).map(column).collect();
            matrices.add(&rounded(mass_matrix(m, &q).concat()), &rounded(columns.concat()));
        }
        matrices.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn bias_is_the_force_at_zero_acceleration() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut bias = Comparison::new(format!("{name}: bias = ID(q, v, 0)"));
        for State { q, v, .. } in states(m) {
            bias.add(&rounded(bias_forces(m, &q, &v)), &rounded(inverse_dynamics(m, &q, &v, &rest(m))));
        }
        bias.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn gravity_is_the_bias_at_rest_and_the_gradient_of_potential_energy() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut bias = Comparison::new(format!("{name}: gravity = bias at rest"));
        let mut gradient = Comparison::new(format!("{name}: gravity = dV/dq"));
        for State { q, .. } in states(m) {
            let gravity = rounded(gravity_forces(m, &q));
            bias.add(&gravity, &rounded(bias_forces(m, &q, &rest(m))));
            let slope = |i| energy(m, &moving(&q, &unit(m, i)), &moving(&rest(m), &rest(m))).potential.rate;
            gradient.add(&gravity, &rounded((0..dof(m)).map(slope).collect::<Vec<_>>()));
        }
        bias.assert_within(tolerance);
        gradient.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn kinetic_energy_is_half_the_velocities_times_momenta() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut kinetic = Comparison::new(format!("{name}: T = ½ vᵀ M v"));
        for State { q, v, .. } in states(m) {
            let momenta: Vec<Number> = mass_matrix(m, &q).iter().map(|row| dot(row, &v)).collect();
            let half = Number::from_f64(0.5) * dot(&v, &momenta);
            kinetic.add(&rounded([energy::<Number>(m, &q, &v).kinetic]), &rounded([half]));
        }
        kinetic.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn power_of_joint_forces_is_the_rate_of_energy() {
    fn check(name: &str, m: &impl Smooth, tolerance: f64) {
        let mut power = Comparison::new(format!("{name}: τ·v = d(T + V)/dt"));
        for State { q, v, a } in states(m) {
            let tau = inverse_dynamics(m, &q, &v, &a);
            let rate = energy(m, &moving(&q, &v), &moving(&v, &a)).total().rate;
            power.add(&rounded([dot(&tau, &v)]), &rounded([rate]));
        }
        power.assert_within(tolerance);
    }
    on_every_mechanism!(check);
}

#[test]
fn both_ways_to_accelerations_agree() {
    for name in ["kr5", "gripper", "test/gantry"] {
        let m = generic(name);
        let mut ways = Comparison::new(format!("{name}: M⁻¹ (τ − h) by factorisation and by recursion"));
        for State { q, v, a } in states(&m) {
            let tau = inverse_dynamics(&m, &q, &v, &a);
            let [explicit, recursion] = [Method::Factorisation, Method::Recursion]
                .map(|method| rounded(denoc::forward_dynamics(method, m.tree(), &Untraced, &q, &v, &tau)));
            ways.add(&explicit, &recursion);
        }
        ways.assert_within(1e-12);
    }
}
