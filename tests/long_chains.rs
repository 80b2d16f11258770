//! Accelerations of long chains: the O(n) recursion keeps its digits where the explicit mass matrix loses them.
//!
//! The judge is the same recursion in double-double; in the errors of both, what is measured is the largest error of an
//! acceleration against the largest acceleration.

mod common;

use common::double_double::{DoubleDouble, exact, rounded};
use common::random::Random;
use redysim_model::denoc::{Method, forward_dynamics};
use redysim_model::regroup::{Vanishing, base_parameters};
use redysim_model::spatial::{Mat3, Pose, Vec3};
use redysim_model::{Inertia, JointKind, Link, Model, Tree};

/// A chain of `count` rods along x, 1 m long each and of mass `mass(i)`, whose joints turn about `axis(i)`.
fn chain(count: usize, axis: impl Fn(usize) -> [f64; 3], mass: impl Fn(usize) -> f64) -> Tree {
    let link = |index: usize| Link {
        name: format!("link{index}"),
        joint_name: format!("joint{index}"),
        parent: index.checked_sub(1),
        joint: JointKind::Revolute,
        placement: Pose { rotation: Mat3::identity(), position: Vec3([if index == 0 { 0.0 } else { 1.0 }, 0.0, 0.0]) },
        axis: Vec3(axis(index)),
        offset: 0.0,
        mass: mass(index),
        com: Vec3([0.5, 0.0, 0.0]),
        inertia: Inertia {
            xx: 0.01 * mass(index),
            yy: 0.09 * mass(index),
            zz: 0.09 * mass(index),
            ..Inertia::default()
        },
        actuated: false,
        range: None,
    };
    let links = (0..count).map(link).collect();
    Tree::new(&Model { name: "chain".into(), gravity: Vec3([0.0, -9.81, 0.0]), links, loops: Vec::new() })
}

fn planar(count: usize) -> Tree {
    chain(count, |_| [0.0, 0.0, 1.0], |_| 1.0)
}

/// As in a chain of universal joints.
fn spatial(count: usize) -> Tree {
    chain(count, |index| if index % 2 == 0 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] }, |_| 1.0)
}

/// A chain whose last rod is a thousand times as heavy as the first.
fn heavy_tip(count: usize) -> Tree {
    let mass = |index: usize| 1000_f64.powf(index as f64 / (count - 1) as f64);
    chain(count, |index| if index % 2 == 0 { [0.0, 0.6, 0.8] } else { [0.6, 0.8, 0.0] }, mass)
}

/// The error of the accelerations found with `method` on `tree`, for the worst of a few states.
fn error(method: Method, tree: &Tree, judge: &Tree) -> f64 {
    let mut random = Random::new(7);
    let errors = (0..5).map(|_| {
        let dof = tree.dof();
        let (q, v, tau) = (random.vector(dof, 0.5), random.vector(dof, 1.0), random.vector(dof, 1.0));
        let [exact_q, exact_v, exact_tau] = [&q, &v, &tau].map(|values| exact(values));
        let expected: Vec<DoubleDouble> = forward_dynamics(Method::Recursion, judge, &exact_q, &exact_v, &exact_tau);
        let expected = rounded(expected);
        let found = forward_dynamics(method, tree, &q, &v, &tau);
        let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let off = |(x, y): (&f64, &f64)| if x.is_nan() { f64::INFINITY } else { (x - y).abs() };
        found.iter().zip(&expected).map(off).fold(0.0, f64::max) / size
    });
    errors.fold(0.0, f64::max)
}

#[test]
fn accelerations_of_a_hundred_joints_have_twelve_digits() {
    for (name, tree) in [("planar", planar(100)), ("spatial", spatial(100))] {
        let found = error(Method::Recursion, &tree, &tree);
        println!("{name}: {found:.1e}");
        assert!(found <= 1e-12, "{name}: {found:.1e}");
    }
}

/// Why long chains never take the explicit mass matrix.
#[test]
fn the_explicit_mass_matrix_of_a_hundred_joints_costs_digits() {
    for (name, tree) in [("planar", planar(100)), ("spatial", spatial(100))] {
        let (recursion, explicit) =
            (error(Method::Recursion, &tree, &tree), error(Method::Factorisation, &tree, &tree));
        println!("{name}: recursion {recursion:.1e}, explicit {explicit:.1e}");
        assert!(explicit > 100.0 * recursion, "{name}: recursion {recursion:.1e}, explicit {explicit:.1e}");
    }
}

/// Why the recursion takes the inertias as they are: base parameters pile them up near the ground, and what a body adds
/// to its parent is subtracted there again.
#[test]
fn base_parameters_in_the_recursion_cost_digits() {
    let tree = heavy_tip(40);
    let (plain, regrouped) = (
        error(Method::Recursion, &tree, &tree),
        error(Method::Recursion, &base_parameters(&tree, Vanishing::TensorYy), &tree),
    );
    println!("plain {plain:.1e}, base parameters {regrouped:.1e}");
    assert!(plain <= 1e-12 && regrouped > 10.0 * plain, "plain {plain:.1e}, base parameters {regrouped:.1e}");
}
