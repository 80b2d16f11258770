//! Accelerations where dynamics is ill-conditioned: the O(n) recursion keeps its digits where the explicit mass matrix
//! loses them.
//!
//! The judge is the same recursion in double-double; in the errors of both, what is measured is the largest error of an
//! acceleration against the largest acceleration.

use crate::common::chains::{Rod, Z, chain, oblique, universal};
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::random::Random;
use redysim_model::denoc::{Method, Untraced, forward_dynamics};
use redysim_model::joint::Vanishing;
use redysim_model::regroup::base_parameters;
use redysim_model::{Model, Tree};
use redysim_runtime::Real;

const METRE_LONG: Rod = Rod { axis: Z, mass: 1.0, length: 1.0 };

fn planar(count: usize) -> Tree {
    chain(count, |_| METRE_LONG)
}

fn spatial(count: usize) -> Tree {
    chain(count, |index| Rod { axis: universal(index), ..METRE_LONG })
}

/// A chain whose last rod is a thousand times as heavy as the first.
fn heavy_tip(count: usize) -> Tree {
    let mass = |index: usize| 1000_f64.powf(index as f64 / (count - 1) as f64);
    chain(count, |index| Rod { axis: oblique(index), mass: mass(index), ..METRE_LONG })
}

/// The error of the accelerations found with `method` on `tree` in the scalar `S`, for the worst of a few states.
fn error_in<S: Real>(method: Method, tree: &Tree, judge: &Tree) -> f64 {
    let mut random = Random::new(7);
    let errors = (0..5).map(|_| {
        let dof = tree.nv();
        // Numbers that `S` has, so that its error is that of the arithmetic alone.
        let mut values = |size| -> Vec<f64> {
            random.vector(dof, size).into_iter().map(|value| S::from_f64(value).to_f64()).collect()
        };
        let (q, v, tau) = (values(0.5), values(1.0), values(1.0));
        let [exact_q, exact_v, exact_tau] = [&q, &v, &tau].map(|values| exact(values));
        let expected: Vec<DoubleDouble> =
            forward_dynamics(Method::Recursion, judge, &Untraced, &exact_q, &exact_v, &exact_tau);
        let expected = rounded(expected);
        let [q, v, tau] = [q, v, tau].map(|values| values.into_iter().map(S::from_f64).collect::<Vec<S>>());
        let found = forward_dynamics(method, tree, &Untraced, &q, &v, &tau);
        let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let off = |(x, y): (&S, &f64)| if x.is_finite() { (x.to_f64() - y).abs() } else { f64::INFINITY };
        found.iter().zip(&expected).map(off).fold(0.0, Real::maximum) / size
    });
    errors.fold(0.0, Real::maximum)
}

fn error(method: Method, tree: &Tree, judge: &Tree) -> f64 {
    error_in::<f64>(method, tree, judge)
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

#[test]
fn accelerations_of_a_thousand_joints_have_eleven_digits() {
    for (name, tree) in [("planar", planar(1000)), ("spatial", spatial(1000))] {
        let found = error(Method::Recursion, &tree, &tree);
        println!("{name}: {found:.1e}");
        assert!(found <= 1e-11, "{name}: {found:.1e}");
    }
}

#[test]
fn single_precision_serves_a_hundred_joints_by_the_recursion_and_not_by_the_matrix() {
    for (name, tree) in [("planar", planar(100)), ("spatial", spatial(100))] {
        let (recursion, explicit) =
            (error_in::<f32>(Method::Recursion, &tree, &tree), error_in::<f32>(Method::Factorisation, &tree, &tree));
        println!("{name}: recursion {recursion:.1e}, explicit {explicit:.1e}");
        assert!(recursion <= 1e-4, "{name}: {recursion:.1e}");
        assert!(explicit >= 0.05, "{name}: the matrix leaves a digit at most, but its error is {explicit:.1e}");
    }
}

/// A bound of the recursion's error, and how many times as large that of the matrix is at least.
#[test]
fn bad_proportions_cost_the_recursion_fewer_digits_than_the_matrix() {
    let rods = |count, rod: &dyn Fn(usize) -> Rod| chain(count, |index| Rod { axis: oblique(index), ..rod(index) });
    let mass = |heavy: bool, mass: f64| Rod { mass: if heavy { mass } else { 1.0 }, ..METRE_LONG };
    let micrometre = rods(6, &|index| Rod { length: if index == 3 { 1e-6 } else { 1.0 }, ..METRE_LONG });
    let heavy_tip = rods(10, &|index| mass(index == 9, 1e6));
    let light_first = rods(10, &|index| mass(index % 2 == 1, 1e9));
    let heavy_first = rods(10, &|index| mass(index % 2 == 0, 1e9));
    let cases = [
        ("a link of a micrometre", micrometre, 1e-14, 3.0),
        // Here the recursion, too, subtracts nearly all of the tip's inertia at every joint. Arguments that are off by
        // their last digit change the accelerations by 5e-16 only, so that the loss is the method's.
        ("a tip a million times as heavy", heavy_tip, 1e-9, 10.0),
        ("masses that alternate by 1e9, the first light", light_first, 1e-14, 10.0),
        ("masses that alternate by 1e9, the first heavy", heavy_first, 1e-14, 10.0),
        ("KR5's hand of 8 g behind 16 kg", Tree::new(&kr5()), 1e-15, 1.0),
    ];
    for (name, tree, bound, times) in cases {
        let (recursion, explicit) =
            (error(Method::Recursion, &tree, &tree), error(Method::Factorisation, &tree, &tree));
        println!("{name}: recursion {recursion:.1e}, explicit {explicit:.1e}");
        assert!(recursion <= bound, "{name}: {recursion:.1e}");
        assert!(explicit >= times * recursion, "{name}: recursion {recursion:.1e}, explicit {explicit:.1e}");
    }
}

fn kr5() -> Model {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/kr5.toml");
    Model::load(path).expect("a good model").model
}
