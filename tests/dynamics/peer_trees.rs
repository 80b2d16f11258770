//! On random trees of joints of all kinds, with rotors, dampers and springs, Pinocchio and MuJoCo compute the same, component by component.
//!
//! What their numbers are, and where they come from: `tests/reference/README.md`.
#![cfg(feature = "generic")]

use crate::common::call;
use crate::common::comparison::Comparison;
use crate::common::dual::{Dual, moving};
use redysim::generic::{GenericMechanism, Link, Model};
use redysim::{
    ForwardDynamics, Frames, InverseDynamics, MassMatrix, MechanicalEnergy, PassiveForces, Scalar, Vector, Wrench,
    redysim,
};
use std::collections::BTreeMap;
use std::path::PathBuf;

macro_rules! tree {
    ($(#[$attribute:meta])* $tree:ident, $file:literal) => {
        redysim! {
            $(#[$attribute])*
            struct $tree(
                $file,
                functions = [
                    inverse_dynamics, forward_dynamics, mass_matrix, passive_forces, energy, frame_kinematics,
                    frame_jacobians, frame_bias, frame_forces,
                ]
            );
        }
    };
}

tree!(Tree07, "tests/reference/peer_trees/07.toml");
#[cfg(not(debug_assertions))]
tree!(Tree10, "tests/reference/peer_trees/10.toml");
#[cfg(not(debug_assertions))]
tree!(Tree18, "tests/reference/peer_trees/18.toml");
tree!(
    // Its gravity points up.
    #[allow(deprecated)]
    Tree21,
    "tests/reference/peer_trees/21.toml"
);
#[cfg(not(debug_assertions))]
tree!(Tree24, "tests/reference/peer_trees/24.toml");

/// The trees whose joints have one degree of freedom, and those with spherical, planar and free joints as well.
const ON_AXES: std::ops::RangeInclusive<usize> = 1..=20;
const IN_SPACE: std::ops::RangeInclusive<usize> = 21..=30;

/// A component is held to 1e-11 of itself, or of this part of the quantity's largest component on the tree: what
/// vanishes for one program is roundoff of the others, up to 1e-14 of the largest.
const SMALL: f64 = 1e-3;

fn file(tree: usize, extension: &str) -> PathBuf {
    format!("{}/tests/reference/peer_trees/{tree:02}.{extension}", env!("CARGO_MANIFEST_DIR")).into()
}

/// The numbers of each quantity at one state.
type State = BTreeMap<String, Vec<f64>>;

/// The states of a tree with what the other programs compute there. A line is the index of the state, the quantity, and
/// its numbers.
fn states(tree: usize) -> Vec<State> {
    let text = std::fs::read_to_string(file(tree, "csv")).expect("a table");
    let mut states = Vec::new();
    for line in text.lines() {
        let mut words = line.split(',');
        let index: usize = words.next().expect("an index").parse().expect("an index");
        let quantity = words.next().expect("a quantity").to_string();
        states.resize(states.len().max(index + 1), State::new());
        states[index].insert(quantity, words.map(|word| word.parse().expect("a number")).collect());
    }
    states
}

fn generic(tree: usize) -> GenericMechanism {
    GenericMechanism::new(Model::load(file(tree, "toml")).expect("a good model").model)
}

fn wrenches<S: Scalar, W: Vector<Wrench<S>>>(numbers: &[f64]) -> W {
    let part = |from: usize| [0, 1, 2].map(|axis| S::from_f64(numbers[from + axis]));
    W::from_fn(numbers.len() / 6, |frame| Wrench { force: part(6 * frame), moment: part(6 * frame + 3) })
}

fn sum(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + b).collect()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// What the other programs compute, by the functions of a mechanism.
///
/// Pinocchio has neither dampers nor springs, so that their forces are taken off, or given by the actuators.
fn computed<M>(mechanism: &M, state: &State) -> Vec<(&'static str, Vec<f64>)>
where
    M: InverseDynamics<f64>
        + ForwardDynamics<f64>
        + MassMatrix<f64>
        + PassiveForces<f64>
        + MechanicalEnergy<f64>
        + Frames<f64, Wrenches: Vector<Wrench<f64>>>
        + Frames<Dual<f64>, Wrenches: Vector<Wrench<Dual<f64>>>>,
{
    let [q, v, a, tau, wrench] = ["q", "v", "a", "tau", "wrenches"].map(|given| state[given].as_slice());
    let inverse = call::inverse_dynamics(mechanism, q, v, a);
    let passive = call::passive_forces(mechanism, q, v);
    let forward = |tau: &[f64]| call::forward_dynamics(mechanism, q, v, tau);
    let matrix = call::mass_matrix(mechanism, q);
    let upper: Vec<f64> = matrix.iter().enumerate().flat_map(|(i, row)| row[i..].to_vec()).collect();
    let [kinematics, jacobians, bias, external] = call::frames(mechanism, q, v, &wrenches(wrench));
    // J̇ along q̇ = N(q) v.
    let (rates, constant) = (call::coordinate_rates(mechanism, q, v), call::constants::<Dual<f64>>(v));
    let [_, moving_jacobians, _, _] = call::frames(mechanism, &moving(q, &rates), &constant, &wrenches(wrench));
    let energy = call::energy(mechanism, q, v);
    let driven = sum(tau, &passive);
    let without_passive = difference(&inverse, &passive);
    vec![
        ("pinocchio.rnea", without_passive.clone()),
        ("pinocchio.rnea_wrenches", difference(&without_passive, &external)),
        ("pinocchio.aba", forward(&driven)),
        ("pinocchio.aba_wrenches", forward(&sum(&driven, &external))),
        ("pinocchio.crba", upper.clone()),
        ("pinocchio.kinematics", kinematics),
        ("pinocchio.jacobians", jacobians),
        ("pinocchio.jacobian_rates", moving_jacobians.iter().map(|entry| entry.rate).collect()),
        ("pinocchio.bias", bias),
        ("mujoco.inverse", inverse),
        ("mujoco.passive", passive),
        ("mujoco.mass_matrix", upper),
        ("mujoco.forward", forward(tau)),
        ("mujoco.energy", vec![energy.potential, energy.kinetic]),
    ]
}

/// Holds what is `computed` at each state of a tree against the table of that tree. Nothing in the table is left out.
fn assert_agrees(tree: usize, sizes: [usize; 2], computed: impl Fn(&State) -> Vec<(&'static str, Vec<f64>)>) {
    let states = states(tree);
    let mut comparisons = BTreeMap::new();
    for state in &states {
        assert_eq!(["q", "v"].map(|given| state[given].len()), sizes, "tree {tree}");
        let computed = computed(state);
        assert_eq!(computed.len() + 5, state.len(), "tree {tree}: quantities");
        for (quantity, numbers) in computed {
            let comparison = comparisons
                .entry(quantity)
                .or_insert_with(|| Comparison::new(format!("tree {tree}: {quantity}")).with_floor(SMALL));
            comparison.add(&numbers, &state[quantity]);
        }
    }
    comparisons.values().for_each(|comparison| comparison.assert_within(1e-11));
}

#[test]
fn the_run_time_path_agrees_with_pinocchio_and_mujoco_on_random_trees() {
    for tree in ON_AXES.chain(IN_SPACE) {
        let mechanism = generic(tree);
        let sizes = [mechanism.tree().nq(), mechanism.tree().nv()];
        assert_agrees(tree, sizes, |state| computed(&mechanism, state));
    }
}

#[test]
fn compiled_functions_agree_with_pinocchio_and_mujoco_on_random_trees() {
    assert_agrees(7, [Tree07::NQ, Tree07::NV], |state| computed(&Tree07, state));
    assert_agrees(21, [Tree21::NQ, Tree21::NV], |state| computed(&Tree21, state));
    // Compiling a tree takes seconds.
    #[cfg(not(debug_assertions))]
    {
        assert_agrees(10, [Tree10::NQ, Tree10::NV], |state| computed(&Tree10, state));
        assert_agrees(18, [Tree18::NQ, Tree18::NV], |state| computed(&Tree18, state));
        assert_agrees(24, [Tree24::NQ, Tree24::NV], |state| computed(&Tree24, state));
    }
}

/// What is not there agrees with everything.
#[test]
fn the_random_trees_have_joints_of_all_kinds_with_rotors_dampers_and_springs() {
    let count = |trees: std::ops::RangeInclusive<usize>, is: fn(&Link) -> bool| -> usize {
        trees.map(|tree| generic(tree).model().links.iter().filter(|link| is(link)).count()).sum()
    };
    let is_driven = |link: &Link| link.physics.armature.values()[0] > 0.0;
    let is_damped = |link: &Link| link.physics.damping.values()[0] > 0.0;
    assert!(count(ON_AXES, |link| link.joint.name() == "revolute") > 50);
    assert!(count(ON_AXES, |link| link.joint.name() == "prismatic") > 30);
    assert!(count(ON_AXES, is_driven) > 30 && count(ON_AXES, is_damped) > 30);
    assert!(count(ON_AXES, |link| has_spring(link) && link.physics.rest.iter().any(|rest| *rest > 0.0)) > 10);
    assert!(count(IN_SPACE, |link| link.joint.name() == "spherical") > 10);
    assert!(count(IN_SPACE, |link| link.joint.name() == "planar") > 5);
    assert!(count(IN_SPACE, |link| link.joint.name() == "free") > 5);
    // On links that move.
    assert!(count(IN_SPACE, |link| link.joint.dof() > 1 && link.parent.is_some()) > 15);
    assert!(count(IN_SPACE, |link| link.joint.name() == "spherical" && has_spring(link)) > 3);
    assert!(count(IN_SPACE, |link| link.joint.name() == "spherical" && link.physics.armature.values()[0] > 0.0) > 5);
}

fn has_spring(link: &Link) -> bool {
    link.physics.stiffness.values()[0] > 0.0
}
