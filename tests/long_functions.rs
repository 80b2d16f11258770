//! A chain of thirty joints, whose functions are thousands of operations long, compiles in the dev profile and computes
//! what the generic path computes.
#![cfg(feature = "generic")]

mod common;

use common::call::*;
use common::comparison::Comparison;
use common::models::generic;
use common::random::Random;
use redysim::{Mechanism, redysim};

redysim! {
    /// Thirty links in a row.
    struct Chain30("models/test/chain30.toml");
}

#[test]
fn thirty_joints_compile_in_the_dev_profile_and_are_right() {
    let generic = generic("test/chain30");
    let mut random = Random::new(30);
    let names = ["inverse", "forward", "mass matrix", "bias", "gravity", "kinematics"];
    let [mut inverse, mut forward, mut matrix, mut bias, mut gravity, mut kinematics] = names.map(Comparison::new);
    for _ in 0..20 {
        let state = random.state(Chain30::NV);
        let (q, v, a) = (&state.q[..], &state.v[..], &state.a[..]);
        let tau: Vec<f64> = inverse_dynamics(&generic, q, v, a);
        inverse.add(&inverse_dynamics(&Chain30, q, v, a), &tau);
        forward.add(&forward_dynamics(&Chain30, q, v, &tau), &forward_dynamics(&generic, q, v, &tau));
        matrix.add(&mass_matrix(&Chain30, q).concat(), &mass_matrix(&generic, q).concat());
        bias.add(&bias_forces(&Chain30, q, v), &bias_forces(&generic, q, v));
        gravity.add(&gravity_forces(&Chain30, q), &gravity_forces(&generic, q));
        let places = |links: Vec<redysim::LinkState<f64>>| -> Vec<f64> {
            links.iter().flat_map(|link| [link.com, link.velocity, link.angular_velocity]).flatten().collect()
        };
        kinematics.add(&places(link_kinematics(&Chain30, q, v)), &places(link_kinematics(&generic, q, v)));
    }
    // In `f64` the smallest components are differences of large ones and lose digits on both sides.
    for comparison in [inverse, matrix, bias, gravity, kinematics] {
        comparison.assert_within(1e-10);
    }
    forward.assert_within(1e-9);
    assert_eq!(Mechanism::<f64>::nv(&Chain30), 30);
}

#[test]
fn a_chain_of_thirty_goes_by_the_recursion() {
    // The explicit matrix alone would take more operations than the whole recursion.
    assert!(
        Chain30::OPS.forward_dynamics.flops() < Chain30::OPS.mass_matrix.flops() + Chain30::OPS.bias_forces.flops()
    );
}
