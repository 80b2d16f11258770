//! Hybrid dynamics: what it finds, with what it is given, are forces and accelerations of one motion.

use super::random_trees::models::{Joints, mimic_some, random_model};
use super::random_trees::state_in_space;
use crate::common::random::{Random, State};
use crate::common::styles::Style;
use crate::common::traced::traced;
use redysim::Real;
use redysim::generic::{GenericMechanism, Link, Model, PerVelocity};
use redysim::{HybridDynamics, HybridMotion, InverseDynamics, Mechanism, redysim};
use redysim_codegen::functions::trace;
use redysim_model::denoc::{Method, Untraced, hybrid_dynamics, integrate, inverse_dynamics, neutral};
use redysim_model::{Function, Tree};

redysim! { pub struct Floating("models/kr5_floating.toml", functions = [hybrid_dynamics, inverse_dynamics, mass_matrix]); }

const TREES: u64 = if cfg!(debug_assertions) { 1 } else { 60 };

/// Forces from accelerations that were found with M⁻¹: some roundings times the condition of the passive joints' part
/// of M, which on ordinary trees of ten joints is below 1e4.
const TOLERANCE: f64 = 1e-11;

/// The largest difference of two vectors as a share of the largest component.
fn error(found: &[f64], expected: &[f64]) -> f64 {
    let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum) / size
}

/// Inverse dynamics at the accelerations of `motion` gives its forces, and of each velocity it has what `u` gave.
fn assert_is_a_motion(what: &str, motion: &HybridMotion<Vec<f64>>, u: &[f64], actuated: &[bool], forces: &[f64]) {
    for (i, &actuated) in actuated.iter().enumerate() {
        let kept = if actuated { motion.a[i] } else { motion.tau[i] };
        assert_eq!(kept, u[i], "{what}: what is given of velocity {i}");
    }
    let error = error(forces, &motion.tau);
    assert!(error < TOLERANCE, "{what}: {error:.1e}\n{forces:?}\n{:?}", motion.tau);
}

/// A random tree of which some joints have an actuator and some do not, with damping in some joints.
fn partly_actuated(random: &mut Random) -> Model {
    loop {
        let mut model = Style::Ordinary.model(random, 10);
        for link in &mut model.links {
            link.actuated = (random.below(2) == 0).into();
            if random.below(3) == 0 {
                (link.physics.damping, link.physics.armature) = (1.3.into(), 0.2.into());
            }
        }
        if Tree::new(&model).has_passive_joints() {
            return model;
        }
    }
}

/// A random tree with joints of every kind, of which some velocities have an actuator and some do not.
fn partly_actuated_joints(random: &mut Random) -> Model {
    loop {
        let mut model = random_model(random, Joints::InSeries, true, true);
        for link in &mut model.links {
            link.actuated = PerVelocity::Each((0..link.joint.dof()).map(|_| random.below(2) == 0).collect());
        }
        let mixed =
            |link: &Link| (1..link.joint.dof()).contains(&link.actuated_velocities().iter().filter(|x| **x).count());
        if model.links.iter().any(mixed) {
            return model;
        }
    }
}

/// The same, in which joints mimic others.
fn partly_actuated_with_mimics(random: &mut Random) -> Model {
    loop {
        let mut model = partly_actuated_joints(random);
        mimic_some(random, &mut model);
        if model.links.iter().any(|link| link.mimic.is_some()) && Tree::new(&model).has_passive_joints() {
            return model;
        }
    }
}

#[test]
fn both_methods_and_the_traced_expressions_find_a_motion_on_random_trees() {
    for seed in 0..3 * TREES {
        let mut random = Random::new(seed);
        let model = match seed / TREES {
            0 => partly_actuated(&mut random),
            1 => partly_actuated_joints(&mut random),
            _ => partly_actuated_with_mimics(&mut random),
        };
        let tree = Tree::new(&model);
        let actuated = tree.actuated();
        let [hybrid] = traced(&tree, &[Function::HybridDynamics]).try_into().expect("of this tree");
        let [q, v, u] = match seed < TREES {
            true => [3.0, 2.0, 10.0].map(|bound| random.vector(tree.nv(), bound)),
            false => {
                let State { q, v, a } = state_in_space(&mut random, &model);
                [q, v, a]
            }
        };
        let found = hybrid.expressions.evaluate(&[&q, &v, &u]);
        let (a, tau) = found.split_at(tree.nv());
        let by_expressions = HybridMotion { a: a.to_vec(), tau: tau.to_vec() };
        let by = |method| hybrid_dynamics(method, &tree, &Untraced, &q, &v, &u);
        let motions = [
            ("factorisation", by(Method::Factorisation)),
            ("recursion", by(Method::Recursion)),
            ("expressions", by_expressions),
        ];
        for (what, motion) in motions {
            let forces = inverse_dynamics(&tree, &Untraced, &q, &v, &motion.a);
            assert_is_a_motion(&format!("tree {seed}, {what}"), &motion, &u, &actuated, &forces);
        }
    }
}

#[test]
fn an_arm_on_a_free_base_moves_as_given_and_the_base_as_it_must() {
    let mut random = Random::new(7);
    let generic = GenericMechanism::new(Model::load("models/kr5_floating.toml").expect("a valid model").model);
    for _ in 0..20 {
        let [dv, v, u]: [[f64; 12]; 3] =
            [1.0, 2.0, 10.0].map(|bound| random.vector(12, bound).try_into().expect("twelve"));
        let start: Vec<f64> = integrate(generic.tree(), &neutral(generic.tree()), &dv);
        let q: [f64; 13] = start.clone().try_into().expect("thirteen");
        let HybridMotion { a, tau } = Floating::hybrid_dynamics(&q, &v, &u);
        let compiled = HybridMotion { a: a.to_vec(), tau: tau.to_vec() };
        let forces = Floating::inverse_dynamics(&q, &v, &a);
        assert_is_a_motion("compiled", &compiled, &u, &Floating::ACTUATED, &forces);
        let by_traits = generic.hybrid_dynamics(&start, &v.to_vec(), &u.to_vec());
        let forces = generic.inverse_dynamics(&start, &v.to_vec(), &by_traits.a);
        assert_is_a_motion("generic", &by_traits, &u, &Floating::ACTUATED, &forces);
        assert!(error(&compiled.a, &by_traits.a) < TOLERANCE && error(&compiled.tau, &by_traits.tau) < TOLERANCE);
    }
    assert_eq!((Floating.nv(), Floating::ACTUATED[5], Floating::ACTUATED[6]), (12, false, true));
}

/// A cart of 1 kg and a pole of 0.2 kg, 0.5 m from its hinge, with 0.01 kg m² about its centre of mass, in closed form:
/// with the angle θ from upright, θ̈ = (m l (g sin θ − ẍ cos θ))/(m l² + J), F = (M + m) ẍ + m l (θ̈ cos θ − θ̇² sin θ).
#[test]
fn the_force_on_a_cart_under_a_free_pole_is_that_of_the_closed_form() {
    let model = Model::load("models/cart_pole.toml").expect("a valid model").model;
    let tree = Tree::new(&model);
    let (theta, rate, along) = (0.4_f64, -1.7, 3.0);
    let (moment, inertia) = (0.2 * 0.5, 0.2 * 0.25 + 0.01);
    let angular = moment * (9.81 * theta.sin() - along * theta.cos()) / inertia;
    let force = 1.2 * along + moment * (angular * theta.cos() - rate * rate * theta.sin());
    for method in [Method::Factorisation, Method::Recursion] {
        let motion = hybrid_dynamics(method, &tree, &Untraced, &[0.3, theta], &[0.8, rate], &[along, 0.0]);
        assert!(error(&motion.a, &[along, angular]) < 1e-14, "{method:?}: {motion:?}");
        assert!(error(&motion.tau, &[force, 0.0]) < 1e-14, "{method:?}: {motion:?}");
    }
}

#[test]
fn a_mechanism_has_hybrid_dynamics_if_some_joints_have_an_actuator_and_some_do_not() {
    let model = |name: &str| Model::load(format!("models/{name}.toml")).expect("a valid model").model;
    for (name, expected) in [("kr5_floating", true), ("kr5", false), ("fourbar", false)] {
        let functions = trace(&Tree::new(&model(name))).expect("no pass changes a value");
        let has = functions.iter().any(|traced| traced.function == Function::HybridDynamics);
        assert_eq!(has, expected, "{name}");
    }
    let text = std::fs::read_to_string("models/kr5.toml").expect("a model");
    let faults =
        Model::from_toml_with(text, "kr5.toml", "functions = ['hybrid_dynamics']").expect_err("no such function");
    assert!(faults.to_string().contains("needs joints with an actuator and joints without one"), "{faults}");
}
