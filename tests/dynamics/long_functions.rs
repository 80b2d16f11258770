//! A chain of thirty joints, whose functions are thousands of operations long, compiles in the dev profile and computes
//! what the generic path computes.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::models::generic;
use crate::common::random::Random;
use redysim::generic::GenericMechanism;
use redysim::{
    BiasForces, ForwardDynamics, GravityForces, InverseDynamics, LinkKinematics, MassMatrix, MechanicalEnergy,
    Mechanism, redysim,
};

/// The functions that are compared.
trait Compared:
    InverseDynamics<f64>
    + ForwardDynamics<f64>
    + MassMatrix<f64>
    + BiasForces<f64>
    + GravityForces<f64>
    + LinkKinematics<f64>
    + MechanicalEnergy<f64>
{
}

macro_rules! compared {
    ($($robot:ident, $model:tt;)*) => {$(
        redysim! {
            #[doc = concat!("What is compared of `", $model, "`: the Coriolis matrix is as long as all else.")]
            struct $robot(
                $model,
                functions = [
                    inverse_dynamics, forward_dynamics, mass_matrix, bias_forces, gravity_forces, link_kinematics, energy,
                ]
            );
        }
        impl Compared for $robot {}
    )*};
}

// Thirty links in a row.
compared! {
    Chain30, "models/test/chain30.toml";
}
// A chain of alike links, of which most become loops, with an arm in the middle. Compiling it takes seconds.
#[cfg(not(debug_assertions))]
compared! {
    Snake, "models/test/snake.toml";
}
impl Compared for GenericMechanism {}

/// Compares the functions of `compiled` with those of `generic`.
fn assert_right(compiled: &impl Compared, generic: &impl Compared) {
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

#[cfg(not(debug_assertions))]
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
