//! Options of code generation: what is not selected is not generated, and what is generated is as without options.

use super::operation_counts::Kr5;
use crate::common::random::{Random, State};
use redysim::{ConfigurationSpace, InverseDynamics, Mechanism, OperationCount, Operations, redysim};

redysim! {
    /// For a controller.
    struct Few("models/kr5.toml", functions = [mass_matrix, inverse_dynamics]);
}

/// The same, declared by the derive.
#[derive(Mechanism)]
#[mechanism("models/kr5.toml", functions = [mass_matrix, inverse_dynamics])]
struct FewByDerive;

redysim! {
    /// Accelerations by the recursion, whatever it costs.
    struct ByRecursion("models/kr5.toml", functions = [forward_dynamics], forward_dynamics = recursion);
}

/// The same, declared by the derive.
#[derive(Mechanism)]
#[mechanism("models/kr5.toml", functions = [forward_dynamics], forward_dynamics = "recursion")]
struct ByRecursionByDerive;

redysim! {
    /// A function that needs fewer sines and cosines than the others together.
    struct Weight("models/kr5.toml", functions = [gravity_forces]);
}

redysim! {
    /// What every mechanism has, and nothing else.
    struct Positions("models/kr5.toml", functions = [integrate]);
}

redysim! {
    /// Options in the model file.
    struct FromFile("models/test/codegen_options.toml");
}

redysim! {
    /// Options in the declaration take precedence over the file's.
    struct FromDeclaration("models/test/codegen_options.toml", functions = [energy]);
}

/// The number of angles of joint trigonometry.
fn angles<const Q: usize, const A: usize>(_: redysim::JointTrig<f64, Q, A>) -> usize {
    A
}

#[test]
fn selected_functions_compute_the_same_bits() {
    let mut random = Random::new(1);
    for _ in 0..100 {
        let State { q, v, a } = random.state(6);
        let [q, v, a] = [q, v, a].map(|x| <[f64; 6]>::try_from(x).unwrap());
        assert_eq!(Few::inverse_dynamics(&q, &v, &a), Kr5::inverse_dynamics(&q, &v, &a));
        assert_eq!(Few::mass_matrix(&q), Kr5::mass_matrix(&q));
        assert_eq!(InverseDynamics::inverse_dynamics(&FewByDerive, &q, &v, &a), Kr5::inverse_dynamics(&q, &v, &a));
        assert_eq!(Few::mass_matrix_with_trig(&Few::joint_trig(&q)), Kr5::mass_matrix(&q));
        assert_eq!(Weight::gravity_forces(&q), Kr5::gravity_forces(&q));
    }
}

#[test]
fn a_declaration_decides_how_accelerations_are_computed() {
    let (recursion, factorisation) = (ByRecursion::OPS.forward_dynamics, Kr5::OPS.forward_dynamics);
    assert!(recursion.flops() > factorisation.flops(), "{recursion:?}, {factorisation:?}");
    assert_eq!(ByRecursionByDerive::OPS.forward_dynamics, recursion);
    let mut random = Random::new(2);
    for _ in 0..100 {
        let State { q, v, a: tau } = random.state(6);
        let [q, v, tau] = [q, v, tau].map(|x| <[f64; 6]>::try_from(x).unwrap());
        let [one, other] = [ByRecursion::forward_dynamics(&q, &v, &tau), Kr5::forward_dynamics(&q, &v, &tau)];
        let size = other.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        assert!(one.iter().zip(other).all(|(x, y)| (x - y).abs() <= 1e-12 * size), "{one:?} {other:?}");
    }
}

#[test]
fn operations_are_counted_for_what_is_there() {
    let Operations { inverse_dynamics, mass_matrix, coordinate_rates, integrate, difference, neutral, .. } = Kr5::OPS;
    let always = Operations { coordinate_rates, integrate, difference, neutral, ..Operations::NONE };
    assert_eq!(Few::OPS, Operations { inverse_dynamics, mass_matrix, ..always });
    assert_eq!(Positions::OPS, always);
    assert_eq!([integrate.additions, integrate.flops()], [6, 6]);
    assert_eq!(FromFile::OPS.energy, OperationCount::NONE);
    assert_ne!(FromFile::OPS.mass_matrix, OperationCount::NONE);
}

#[test]
fn every_mechanism_has_the_functions_of_its_coordinates_whatever_is_selected() {
    fn check(mechanism: &impl ConfigurationSpace<f64, Coordinates = [f64; 6], Velocities = [f64; 6]>) {
        let (q, dv) = ([0.5, -1.0, 0.25, 2.0, -0.75, 1.5], [1.0, 0.5, -0.25, 0.125, 2.0, -1.0]);
        // All of these sums are exact.
        let moved = [1.5, -0.5, 0.0, 2.125, 1.25, 0.5];
        assert_eq!(mechanism.coordinate_rates(&q, &dv), dv);
        assert_eq!(mechanism.integrate(&q, &dv), moved);
        assert_eq!(mechanism.difference(&q, &moved), dv);
        assert_eq!(mechanism.neutral(), [0.0; 6]);
    }
    check(&Kr5);
    check(&Few);
    check(&Positions);
}

#[test]
fn the_declaration_wins_over_the_file() {
    assert_eq!(FromDeclaration::OPS.mass_matrix, OperationCount::NONE);
    assert_ne!(FromDeclaration::OPS.energy, OperationCount::NONE);
}

/// The sixth link turns about its own axis, and the first about the vertical: neither changes how gravity pulls.
#[test]
fn joint_trigonometry_has_the_angles_of_the_selected_functions_only() {
    assert_eq!(angles(Weight::joint_trig(&[0.0; 6])), Weight::OPS.gravity_forces.trig as usize);
    assert!(angles(Weight::joint_trig(&[0.0; 6])) < angles(Kr5::joint_trig(&[0.0; 6])));
}
