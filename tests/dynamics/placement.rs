//! It does not matter how a joint is placed: KR5 by Denavit-Hartenberg parameters and KR5 by origins and axes, with
//! every link's frame turned, are one robot.
#![cfg(feature = "generic")]

use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::models::generic;
use crate::common::random::{Random, State};
use crate::robots::Kr5;
use redysim::{LinkState, TreeDynamics, redysim};

redysim! {
    /// The same robot, described by origins and axes.
    struct Kr5OriginAxis("models/test/kr5_origin_axis.toml");
}

/// Compares what does not depend on how the links' frames are turned.
fn assert_same_robot(by_dh: &impl TreeDynamics<DoubleDouble>, by_axes: &impl TreeDynamics<DoubleDouble>) {
    let names = ["inverse", "mass matrix", "bias", "gravity", "kinetic", "potential"];
    let [mut inverse, mut matrix, mut bias, mut gravity, mut kinetic, mut potential] = names.map(Comparison::new);
    let mut forward = Comparison::new("forward");
    let mut random = Random::new(5);
    for _ in 0..1000 {
        let State { q, v, a } = random.state(6);
        let (q, v, a) = (exact(&q), exact(&v), exact(&a));
        let tau = inverse_dynamics(by_dh, &q, &v, &a);
        inverse.add(&rounded(inverse_dynamics(by_axes, &q, &v, &a)), &rounded(&tau));
        matrix.add(&rounded(mass_matrix(by_axes, &q).concat()), &rounded(mass_matrix(by_dh, &q).concat()));
        bias.add(&rounded(bias_forces(by_axes, &q, &v)), &rounded(bias_forces(by_dh, &q, &v)));
        gravity.add(&rounded(gravity_forces(by_axes, &q)), &rounded(gravity_forces(by_dh, &q)));
        let (ours, theirs) = (energy(by_axes, &q, &v), energy(by_dh, &q, &v));
        kinetic.add(&rounded([ours.kinetic]), &rounded([theirs.kinetic]));
        potential.add(&rounded([ours.potential]), &rounded([theirs.potential]));
        let ours = forward_dynamics(by_axes, &q, &v, &tau);
        forward.add(&rounded(ours), &rounded(forward_dynamics(by_dh, &q, &v, &tau)));
    }
    for comparison in [inverse, matrix, bias, kinetic, potential] {
        comparison.assert_within(1e-12);
    }
    // Gravity does not turn the vertical first joint. Of its zero, oblique constants that are right to 1e-16 leave
    // 6e-16 N m, 4e-18 of the largest force.
    gravity.assert_within(1e-11);
    // The condition of the mass matrix, 1e7, multiplies the roundoff of the turned constants.
    forward.assert_within(1e-10);
}

#[test]
fn compiled_dynamics_are_those_of_the_robot_not_of_its_frames() {
    assert_same_robot(&Kr5, &Kr5OriginAxis);
}

#[test]
fn generic_dynamics_are_those_of_the_robot_not_of_its_frames() {
    assert_same_robot(&generic("kr5"), &generic("test/kr5_origin_axis"));
}

#[test]
fn links_are_in_the_same_places_and_move_alike() {
    type Part = fn(&LinkState<DoubleDouble>) -> [DoubleDouble; 3];
    let parts: [(&str, Part); 4] = [
        ("origin", |link| link.origin),
        ("com", |link| link.com),
        ("velocity", |link| link.velocity),
        ("angular velocity", |link| link.angular_velocity),
    ];
    for (part, values) in parts {
        let mut comparison = Comparison::new(part);
        let mut random = Random::new(6);
        for _ in 0..1000 {
            let State { q, v, .. } = random.state(6);
            let (q, v) = (exact(&q), exact(&v));
            for (ours, theirs) in link_kinematics(&Kr5OriginAxis, &q, &v).iter().zip(link_kinematics(&Kr5, &q, &v)) {
                comparison.add(&rounded(values(ours)), &rounded(values(&theirs)));
            }
        }
        comparison.assert_within(1e-12);
    }
}
