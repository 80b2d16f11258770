//! Passes over a tree with inertias that are given at run time.

use super::{axis_masses, frames, parallel_axes, units};
use crate::symbol::Symbol;
use crate::tracing::{traced_of, traced_on};
use redysim_model::denoc::evaluate;
use redysim_model::joint::Vanishing;
use redysim_model::parameter::{Parameter, ParameterIn};
use redysim_model::pseudo::PseudoInertia;
use redysim_model::regroup::base_parameters;
use redysim_model::{Function, Model, Tree};

fn robot() -> Tree {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/peers/kr5.toml");
    Tree::new(&Model::load(path).expect("a valid model").model)
}

/// The ten numbers of an inertia, in the order of argument 3.
fn numbers<S: Copy>(inertia: &PseudoInertia<S>) -> [S; 10] {
    let (h, s) = (inertia.moment, inertia.second);
    [inertia.mass, h[0], h[1], h[2], s.xx, s.yy, s.zz, s.xy, s.yz, s.xz]
}

#[test]
fn passes_over_trees_keep_joint_forces_where_an_inertia_is_given_at_run_time() {
    let plain = robot();
    let payload = plain.bodies.last().expect("six bodies").inertia;
    let expressions = traced_of([6, 6, 6, 10], |tracer, arguments| {
        let mut tree: Tree<Symbol> = plain.map(|value| value.value());
        let inertia = &mut tree.bodies.last_mut().expect("six bodies").inertia;
        let [mass, x, y, z, xx, yy, zz, xy, yz, xz] = *arguments[3] else { unreachable!("ten symbols") };
        (inertia.mass, inertia.moment.0) = (mass, [x, y, z]);
        let second = &mut inertia.second;
        (second.xx, second.yy, second.zz, second.xy, second.yz, second.xz) = (xx, yy, zz, xy, yz, xz);

        // Values given at run time count as the constant 0.7.
        let known = |tree: &Tree<Symbol>| tree.map(|symbol| symbol.number().unwrap_or(0.7));
        let cost = |tree: &Tree<Symbol>| traced_on(&known(tree), Function::InverseDynamics).price();
        let framed = frames::chosen(&tree, &cost, &|_| true);
        let regrouped = base_parameters(&framed, Vanishing::SecondMomentZz);
        let merged = parallel_axes::merged(&regrouped, &cost, &|_| true);
        let placed = axis_masses::placed(&merged, &cost, &|_| true);
        let described = units::chosen(&placed, &traced_on(&known(&placed), Function::InverseDynamics));
        assert!(cost(&described) < cost(&tree), "the passes gain nothing");
        assert!(described.bodies.last().expect("six bodies").inertia.number().is_none(), "the inertia is still given");

        evaluate(Function::InverseDynamics, &described, tracer, &arguments[..3])
    });

    let motion = [0.7, 1.3, -0.4].map(|x| (1..=6).map(|i| f64::sin(x * f64::from(i))).collect::<Vec<_>>());
    for factor in [1.0, 3.0, 0.2] {
        let given = numbers(&payload).map(|number| factor * number);
        let arguments: Vec<&[f64]> = motion.iter().map(Vec::as_slice).chain([given.as_slice()]).collect();
        let mut robot = plain.clone();
        robot.bodies.last_mut().expect("six bodies").inertia = payload.map(|number| factor * number);
        let expected = traced_on(&robot, Function::InverseDynamics).evaluate(&arguments[..3]);
        let largest = expected.iter().fold(0.0_f64, |largest, force| largest.max(force.abs()));
        for (found, expected) in expressions.evaluate(&arguments).iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-13 * largest, "{found} instead of {expected}");
        }
    }
}
