//! A chain of thirty joints, whose functions are thousands of operations long, compiles in the dev profile and computes
//! what the generic path computes.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::common::random::Random;
use redysim::{Mechanism, TreeDynamics, redysim};

redysim! {
    /// Thirty links in a row.
    struct Chain30("models/test/chain30.toml");
}

redysim! {
    /// A chain of alike links, of which most become loops, with an arm in the middle.
    struct Snake("models/test/snake.toml");
}

/// Compares every function of `compiled` with the one of `generic`.
fn assert_right(compiled: &impl TreeDynamics<f64>, generic: &impl TreeDynamics<f64>) {
    let mut random = Random::new(30);
    let names = ["inverse", "forward", "mass matrix", "bias", "gravity", "kinematics", "energy"];
    let [mut inverse, mut forward, mut matrix, mut bias, mut gravity, mut kinematics, mut energies] =
        names.map(Comparison::new);
    for _ in 0..20 {
        let state = random.state(generic.nv());
        let (q, v, a) = (&state.q[..], &state.v[..], &state.a[..]);
        let tau: Vec<f64> = inverse_dynamics(generic, q, v, a);
        inverse.add(&inverse_dynamics(compiled, q, v, a), &tau);
        forward.add(&forward_dynamics(compiled, q, v, &tau), &forward_dynamics(generic, q, v, &tau));
        matrix.add(&mass_matrix(compiled, q).concat(), &mass_matrix(generic, q).concat());
        bias.add(&bias_forces(compiled, q, v), &bias_forces(generic, q, v));
        gravity.add(&gravity_forces(compiled, q), &gravity_forces(generic, q));
        let places = |links: Vec<redysim::LinkState<f64>>| -> Vec<f64> {
            links.iter().flat_map(|link| [link.com, link.velocity, link.angular_velocity]).flatten().collect()
        };
        kinematics.add(&places(link_kinematics(compiled, q, v)), &places(link_kinematics(generic, q, v)));
        let [ours, theirs] = [energy(compiled, q, v), energy(generic, q, v)];
        energies.add(&[ours.kinetic, ours.potential], &[theirs.kinetic, theirs.potential]);
    }
    // In `f64` the smallest components are differences of large ones and lose digits on both sides.
    for comparison in [inverse, matrix, bias, gravity, kinematics, energies] {
        comparison.assert_within(1e-10);
    }
    forward.assert_within(1e-9);
}

#[test]
fn thirty_joints_compile_in_the_dev_profile_and_are_right() {
    assert_right(&Chain30, &generic("test/chain30"));
    assert_eq!(Chain30.nv(), 30);
}

#[test]
fn loops_over_alike_links_are_right_beside_what_is_not_alike() {
    assert_right(&Snake, &generic("test/snake"));
}

#[test]
fn a_chain_of_thirty_goes_by_the_recursion() {
    // The explicit matrix alone would take more operations than the whole recursion.
    assert!(
        Chain30::OPS.forward_dynamics.flops() < Chain30::OPS.mass_matrix.flops() + Chain30::OPS.bias_forces.flops()
    );
}
