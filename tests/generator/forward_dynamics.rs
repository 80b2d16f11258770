//! Which of the two ways to accelerations the generator takes.

use redysim_codegen::functions::{MethodChoice, trace};
use redysim_codegen::source_file;
use redysim_model::denoc::{
    EliminationOrder, Method, Untraced, forward_dynamics, forward_dynamics_by_factorisation, integrate, neutral,
};
use redysim_model::{Function, Model, Tree};
use std::fmt::Write;

const BY_RECURSION: &str = "By the O(n) recursion over articulated bodies (ABA)";
const BY_FACTORISATION: &str = "By the factorisation M = U D Uᵀ of the generalised inertia matrix (CRBA)";

/// Rods in the plane, `arms` chains of `links` each.
fn rods(arms: usize, links: usize) -> Model {
    let mut text = String::from("name = \"rods\"\ngravity = [0.0, -9.81, 0.0]\n");
    for (arm, link) in (0..arms).flat_map(|arm| (0..links).map(move |link| (arm, link))) {
        let parent = if link == 0 { "base".to_string() } else { format!("rod_{arm}_{}", link - 1) };
        write!(
            text,
            "[[link]]\nname = \"rod_{arm}_{link}\"\nparent = \"{parent}\"\njoint = \"revolute\"\ndh = {{ a = 0.5 }}\n\
             mass = 1.0\ncom = [0.25, 0.0, 0.0]\ninertia = {{ zz = 0.02 }}\n"
        )
        .unwrap();
    }
    Model::from_toml(text, "rods.toml").unwrap_or_else(|faults| panic!("{faults}")).model
}

fn choice(model: &Model) -> MethodChoice {
    let functions = trace(&Tree::new(model)).expect("no pass changes a value");
    let forward = functions.iter().find(|function| function.function == Function::ForwardDynamics);
    forward.and_then(|function| function.method).expect("forward dynamics states its method")
}

#[test]
fn a_few_joints_go_by_the_factorisation_since_it_is_cheaper() {
    let choice = choice(&rods(1, 3));
    assert_eq!(choice.used.method, Method::Factorisation);
    let other = choice.other.expect("the recursion was considered");
    assert!(other.method == Method::Recursion && choice.used.flops <= other.flops);
    assert!(choice.to_string().starts_with(BY_FACTORISATION));
    assert!(source_file(&rods(1, 3), "Rods").unwrap().contains(BY_FACTORISATION));
}

#[test]
fn chains_longer_than_25_joints_go_by_the_recursion_whatever_the_count() {
    for arms in [1, 2] {
        let choice = choice(&rods(arms, 26));
        assert_eq!((choice.used.method, choice.other), (Method::Recursion, None));
        assert!(choice.to_string().starts_with(BY_RECURSION));
    }
}

#[test]
fn many_short_arms_do_not_count_as_a_long_chain() {
    assert_eq!(choice(&rods(14, 2)).used.method, Method::Factorisation);
}

#[test]
fn both_ways_agree() {
    let tree = Tree::new(&rods(2, 4));
    let [q, v, tau] =
        [0.3_f64, 0.7, 1.1].map(|rate| (0..8).map(|i| (rate * f64::from(i + 1)).sin()).collect::<Vec<_>>());
    let recursion = forward_dynamics(Method::Recursion, &tree, &Untraced, &q, &v, &tau);
    let explicit = forward_dynamics(Method::Factorisation, &tree, &Untraced, &q, &v, &tau);
    for (a, b) in recursion.iter().zip(&explicit) {
        assert!((a - b).abs() <= 1e-10 * (1.0 + a.abs()), "{a} {b}");
    }
}

fn tree_of(name: &str) -> Tree {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Tree::new(&Model::load(path).expect("a valid model").model)
}

#[test]
fn the_order_of_elimination_does_not_matter() {
    for name in ["kr5_floating", "quadruped", "pppr", "test/gantry", "parallel_gripper"] {
        let tree = tree_of(name);
        let numbers = |rate: f64| (0..tree.nv()).map(|i| (rate * (i + 1) as f64).sin()).collect::<Vec<f64>>();
        let [displacement, v, tau] = [0.3, 0.7, 1.1].map(numbers);
        let q = integrate(&tree, &neutral::<f64>(&tree), &displacement);
        let recursion = forward_dynamics(Method::Recursion, &tree, &Untraced, &q, &v, &tau);
        let size = recursion.iter().fold(0.0_f64, |size, a| size.max(a.abs()));
        let orders: Vec<EliminationOrder> = EliminationOrder::all_of(&tree).collect();
        assert_eq!(orders.len(), if name == "parallel_gripper" { 1 } else { 2 }, "{name}");
        for order in orders {
            let found = forward_dynamics_by_factorisation(order, [&tree; 2], &Untraced, &q, &v, &tau);
            for (a, b) in recursion.iter().zip(&found) {
                assert!((a - b).abs() <= 1e-11 * size, "{name}, {order:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn displacements_are_eliminated_first_where_that_is_cheaper() {
    let by = |name: &str| {
        let functions = trace(&tree_of(name)).expect("no pass changes a value");
        let forward = functions.iter().find(|function| function.function == Function::ForwardDynamics);
        forward.expect("it is selected by default").expressions.count()
    };
    // Of the twelve pivots, those of the displacements and of the last joint are numbers. One more division is that by
    // the square of the quaternion.
    assert_eq!(by("kr5_floating").divisions, 12 - 3 - 1 + 1);
}
